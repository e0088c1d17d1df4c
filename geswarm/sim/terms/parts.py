"""What one kind of scenario is composed of, and what follows from it."""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from geswarm.rules.model import Term
from geswarm.rules.vocabulary import Vocabulary
from geswarm.sim.bodies import FOOT_BOT, Body
from geswarm.sim.kernels import draws
from geswarm.sim.kernels.single import F, I
from geswarm.sim.kernels.table import ROW_BEHAVIOURS
from geswarm.sim.terms.component import (
    SUM,
    Behaviour,
    Component,
    Effect,
    Measure,
    Percept,
    PlacesMeasure,
    Register,
    Sensor,
    Steering,
    Sum,
    SwarmMeasure,
    Update,
)
from geswarm.sim.terms.ground import Ground

CORE = ("x", "y", "cos", "sin", "behaviour", "state", "key_low", "key_high")
"""Fields that every robot has."""
REAL = ("x", "y", "cos", "sin", "push_x", "push_y", "to_light_x", "to_light_y", "brightness")
"""What is no whole number among what components may name without writing it."""
MOST_VALUES, MOST_CODES, MOST_STATE_BITS = 64, 65_536, 8


class PartsError(ValueError):
    """The components do not fit together."""


@dataclass(frozen=True, eq=False)
class Parts:
    """The components of a kind of scenario, in the order in which they are numbered.

    Attributes:
        name: What it is called.
        vocabulary: What rules may mention; each of it has its part here.
        percepts: What rules call the readings.
        sensors: Their readings make up the code of a situation, the first one counting least; those
            that read registers come last.
        behaviours: Numbered as the vocabulary numbers them.
        first: The behaviour at the start.
        ground: The form of the arena.
        body: The kind of robot.
        registers: Internal states; the first one has the lowest bits.
        sums: Sums over the other robots that are on offer.
        steering: Added to the target of every behaviour.
        effects: What happens in a step, in this order, after the decision and before the motion.
        measures: What is counted.

    Raises:
        PartsError: Two components have the same name or the same random numbers, or a limit is
            passed.
    """

    name: str
    vocabulary: Vocabulary
    percepts: tuple[Percept, ...]
    sensors: tuple[Sensor, ...]
    behaviours: tuple[Behaviour, ...]
    first: Behaviour
    ground: Ground
    body: Body = FOOT_BOT
    registers: tuple[Register, ...] = ()
    sums: tuple[Sum, ...] = ()
    steering: tuple[Steering, ...] = ()
    effects: tuple[Effect, ...] = ()
    measures: tuple[Measure | SwarmMeasure | PlacesMeasure, ...] = ()

    def __post_init__(self) -> None:
        self._check_names()
        self._check_limits()
        self._check_draws()

    def __deepcopy__(self, _: object) -> Parts:
        return self  # they never change, and kernels are kept by what they are made of

    @cached_property
    def needed_sums(self) -> tuple[Sum, ...]:
        """The sums that some component names."""
        named = {name.removeprefix(SUM) for each in self.components for name in each.needs}
        return tuple(one for one in self.sums if named & set(one.outputs))

    @cached_property
    def components(self) -> tuple[Component, ...]:
        """All but the sums, each once."""
        return tuple(dict.fromkeys(self._components()))

    def _components(self) -> Iterator[Component]:
        yield from (*self.sensors, *self.behaviours, *self.steering, *self.effects)
        for behaviour in self.behaviours:
            if behaviour.start:
                yield behaviour.start
            if behaviour.again:
                yield behaviour.again
            if behaviour.goes_on:
                yield behaviour.goes_on
        yield from (effect.then for effect in self.effects if effect.then)
        yield from self.counted

    @cached_property
    def updates(self) -> tuple[Update, ...]:
        """What writes fields."""
        return tuple(each for each in self.components if isinstance(each, Update))

    @cached_property
    def own_fields(self) -> dict[str, type]:
        """The fields of a robot that components write or sum up, with the kind of number."""
        fields: dict[str, type] = {}
        for one in self.needed_sums:
            kind: type = I if one.form == "count" else F
            fields.update(dict.fromkeys(one.outputs, kind))
        for each in self.updates:
            fields.update({name: kind for name, kind in each.writes.items() if not of_object(name)})
        for measure in self.counted:
            fields[measure.name] = I if measure.kind is int else F
        return fields

    @cached_property
    def counted(self) -> tuple[Measure | SwarmMeasure, ...]:
        """The measures that the kernel counts."""
        return tuple(each for each in self.measures if not isinstance(each, PlacesMeasure))

    @cached_property
    def of_places(self) -> dict[str, PlacesMeasure]:
        """The measures of where robots are, by name."""
        found = (each for each in self.measures if isinstance(each, PlacesMeasure))
        return {each.name: each for each in found}

    @cached_property
    def swarm_sums(self) -> dict[str, type]:
        """Sums over all robots that measures of the swarm name, with the kind of number."""
        counted = [each for each in self.measures if isinstance(each, SwarmMeasure)]
        names = {name for each in counted for name in each.needs if name.startswith(SUM)}
        real = {name for name in names if name.removeprefix(SUM) in REAL}
        return {
            name: F if name in real else self.own_fields.get(name.removeprefix(SUM), I)
            for name in sorted(names)
        }

    @cached_property
    def shifts(self) -> dict[str, int]:
        """Where each register's bits begin in a robot's state."""
        shifts, shift = {}, 0
        for register in sorted(self.registers, key=lambda each: each.word.counts):
            shifts[register.name] = shift
            shift += register.bits
        return shifts

    @cached_property
    def counter(self) -> Register | None:
        """The register that counts; its bits are above those of all others."""
        return next((each for each in self.registers if each.word.counts), None)

    @cached_property
    def percepts_by_name(self) -> dict[str, Percept]:
        """By the word that rules write."""
        return {each.word.name: each for each in self.percepts}

    @cached_property
    def kinds(self) -> dict[str, int]:
        """Position of each behaviour by the word that rules write."""
        return {each.word.name: at for at, each in enumerate(self.behaviours)}

    @cached_property
    def plain_behaviours(self) -> tuple[Term, ...]:
        """The behaviours without arguments: the first instances of every rule set."""
        return tuple(Term(each.word.name) for each in self.behaviours if not each.arguments)

    @property
    def most_instances(self) -> int:
        """How many instances of behaviours a rule set can have."""
        return ROW_BEHAVIOURS if self.arguments else len(self.behaviours)

    @cached_property
    def first_instance(self) -> int:
        """Number of the behaviour at the start."""
        return self.plain_behaviours.index(Term(self.first.word.name))

    def mask(self, register: Register) -> int:
        """A register's bits in a robot's state."""
        return ((1 << register.bits) - 1) << self.shifts[register.name]

    @cached_property
    def first_state(self) -> int:
        """Registers at the start."""
        return sum(each.initially << self.shifts[each.name] for each in self.registers)

    @cached_property
    def lasting(self) -> int:
        """Mask of the registers that survive a step."""
        return sum(self.mask(each) for each in self.registers if not each.momentary)

    @cached_property
    def momentary_state(self) -> int:
        """What momentary registers fall back to."""
        return self.first_state & ~self.lasting

    @cached_property
    def states(self) -> int:
        """Combinations of bits of registers."""
        return 1 << sum(each.bits for each in self.registers)

    @cached_property
    def codes(self) -> int:
        """Combinations of readings."""
        return math.prod(each.values for each in self.sensors)

    @cached_property
    def sensed_codes(self) -> int:
        """Combinations of readings of what is not a register; those sensors come first."""
        seen = [each.seen_by for each in self.registers]
        return math.prod(each.values for each in self.sensors if each not in seen)

    @cached_property
    def drawn_sensors(self) -> tuple[Sensor, ...]:
        """The sensors on which percepts depend by chance."""
        drawn = {each.sensor for each in self.percepts if each.word.chance}
        return tuple(each for each in self.sensors if each in drawn)

    @cached_property
    def arguments(self) -> int:
        """The most arguments that a behaviour has."""
        return max(len(each.arguments) for each in self.behaviours)

    def purpose(self, component: Component, name: str) -> int:
        """What tells the random bits `name` of a component from all others."""
        known = getattr(draws, name.upper(), None)
        return known if known is not None else zlib.crc32(f"{component.name}/{name}".encode())

    def _check_names(self) -> None:
        names: dict[str, Component] = {}
        for each in (*self.components, *self.sums):
            other = names.setdefault(each.name, each)
            if other is not each:
                raise PartsError(
                    f"{self.name}: {each.name} ({each.place}): the name is taken ({other.place})"
                )
        for group in (self.percepts, self.behaviours, self.registers):
            words = [part.word.name for part in group]
            if twice := sorted({word for word in words if words.count(word) > 1}):
                raise PartsError(f"{self.name}: {', '.join(twice)}: expected one of each name")

    def _check_limits(self) -> None:
        for each in self.sensors:
            if not 1 < each.values <= MOST_VALUES:
                expected = f"from 2 to {MOST_VALUES} values"
                raise PartsError(
                    f"{each.name} ({each.place}): expected {expected}, got {each.values}"
                )
        if self.codes > MOST_CODES:
            raise PartsError(
                f"{self.name}: expected at most {MOST_CODES} combinations of readings, "
                f"got {self.codes}"
            )
        flags = sum(each.bits for each in self.registers if not each.word.counts)
        if flags > MOST_STATE_BITS:
            raise PartsError(
                f"{self.name}: expected registers of at most {MOST_STATE_BITS} bits, got {flags}"
            )
        for number, counter in enumerate(one for one in self.registers if one.word.counts):
            counted = tuple(range(counter.values))
            if number or counter.word.values != counted or counter.values > 8:
                raise PartsError(
                    f"{self.name}: {counter.word.name}: expected one counter, of whole numbers "
                    "from 0 to at most 7"
                )

    def _check_draws(self) -> None:
        taken: dict[int, str] = {}
        for each in self.components:
            names = each.draws if isinstance(each, Update) else ()
            if isinstance(each, Sensor) and each.fails:
                names = (each.fails,)
            for name in names:
                drawn = f"{each.name}/{name}"
                other = taken.setdefault(self.purpose(each, name), drawn)
                if other != drawn:
                    raise PartsError(
                        f"{self.name}: {drawn} ({each.place}) would draw the same random numbers "
                        f"as {other}: give one of them another name"
                    )


def of_object(name: str) -> bool:
    """Whether an effect writes the object's place and not a field of the robot."""
    return name in ("object_x", "object_y")
