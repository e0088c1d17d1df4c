"""Control tables of rule sets for drawing by one random number, many in one call."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.automode import Machine, Tree
from geswarm.rules.control_table import ControlTable
from geswarm.rules.model import RuleSet, Term
from geswarm.rules.names import require_known_names
from geswarm.rules.space import Space
from geswarm.sim.assembly.records import GROUP
from geswarm.sim.compiled import compile_tables
from geswarm.sim.controllers import machines, trees
from geswarm.sim.controllers.machines import ControllerError
from geswarm.sim.controllers.program import Instances, encode, encoded
from geswarm.sim.controllers.spaces import percepts_of_codes
from geswarm.sim.kernels.table import (
    MOST_CLASSES,
    MOST_OUTCOMES,
    MOST_RULES,
    ROOM,
    ROW_BEHAVIOURS,
    ByChance,
    Encoded,
    Tables,
)
from geswarm.sim.terms.parts import MOST_STATE_BITS, Parts

Controller: TypeAlias = RuleSet | ControlTable | Machine | Tree

_of_thread = threading.local()


class Controllers(NamedTuple):
    """Control tables, and the behaviours that they number.

    Attributes:
        tables: Of all rule sets, one after the other.
        kinds: int32, for each instance of a behaviour its position in the vocabulary.
        arguments: float32, shape (instances, most arguments).
        first_instances: int64, shape (tables,), where the instances of each begin.
        parts: What the scenario is composed of.
    """

    tables: Tables
    kinds: npt.NDArray[np.int32]
    arguments: npt.NDArray[np.float32]
    first_instances: npt.NDArray[np.int64]
    parts: Parts

    def for_lanes(self, numbers: npt.NDArray[np.int64]) -> tuple[Any, ...]:
        """What a kernel takes for deciding by the tables of these numbers, one for each lane."""
        group = np.zeros(1, dtype=GROUP)
        group["codes"][0, : len(numbers)] = self.tables.begins[numbers, 0]
        group["rows"][0, : len(numbers)] = self.tables.begins[numbers, 1]
        group["instances"][0, : len(numbers)] = self.first_instances[numbers]
        instances = (self.kinds, self.arguments) if self.parts.arguments else ()
        return (group[0], *self.tables[:4], *instances)


def compile_controllers(
    controllers: Sequence[Controller], fails: Sequence[float], parts: Parts
) -> Controllers:
    """Control tables for drawing by one random number.

    Args:
        controllers: Rule sets, or what they have been compiled to.
        fails: With which probability each sensor reads 0 instead of what it should.
        parts: What the scenario is composed of.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        ValueError: A table is for another vocabulary, or a rule set is beyond a limit.
    """
    short = [
        each
        for each in controllers
        if isinstance(each, RuleSet) and len(each.rules) <= _most_rules(parts)
    ]
    for each in controllers:
        if isinstance(each, RuleSet):
            require_known_names(each, parts.vocabulary)
    automata = [each for each in controllers if isinstance(each, Machine | Tree)]
    if automata:
        instances, tables = _of_automata(automata, len(controllers), fails, parts)
    elif len(short) == len(controllers):
        instances = [Instances.of(each, parts) for each in short]
        tables = _compiled(*encode(short, instances, fails, parts), None, parts)
    else:
        instances = [Instances.of(RuleSet(), parts)] * len(controllers)
        known = [each for each in controllers if not isinstance(each, Machine | Tree)]
        dense = _dense([_exact(each, parts) for each in known], parts)
        tables = _compiled(_nothing_but(instances, fails, parts), None, dense, parts)
    sizes = [len(own.terms) for own in instances]
    return Controllers(
        tables,
        kinds=np.array([kind for own in instances for kind in own.kinds], dtype=np.int32),
        arguments=np.concatenate(
            [np.zeros((0, parts.arguments), np.float32), *(own.arguments for own in instances)]
        ),
        first_instances=np.cumsum([0, *sizes])[:-1],
        parts=parts,
    )


def require_runnable(named: Mapping[str, Controller], parts: Parts) -> None:
    """Check machines and trees before anything is compiled.

    Raises:
        ControllerError: One of them cannot run with these parts; says which, and why.
    """
    for name, each in named.items():
        if isinstance(each, Machine | Tree):
            try:
                _instances_of(each, parts)
            except ControllerError as error:
                raise ControllerError(f"{name}: {error}") from error


def no_controllers(parts: Parts) -> Controllers:
    """What stands for one table where no step is going to be run."""
    return Controllers(
        _empty(1, parts.codes),
        kinds=np.zeros(1, dtype=np.int32),
        arguments=np.zeros((1, parts.arguments), np.float32),
        first_instances=np.zeros(1, dtype=np.int64),
        parts=parts,
    )


def _of_automata(
    given: Sequence[Machine | Tree], number: int, fails: Sequence[float], parts: Parts
) -> tuple[list[Instances], Tables]:
    """Behaviours and tables of state machines and behaviour trees."""
    if len(given) < number:
        raise ValueError("expected either controllers of AutoMoDe or rule sets, got both")
    instances = [Instances(_instances_of(each, parts), parts) for each in given]
    most = max(len(own.terms) for own in instances)
    dense = np.stack([_outcomes_of(each, parts, most) for each in given])
    padded = [
        Instances((*own.terms, *own.terms[:1] * (most - len(own.terms))), parts)
        for own in instances
    ]
    return padded, _compiled(_nothing_but(padded, fails, parts), None, dense, parts)


def _instances_of(given: Machine | Tree, parts: Parts) -> tuple[Term, ...]:
    if isinstance(given, Machine):
        return machines.instances_of(given, parts)
    return trees.instances_of(given, parts)


def _outcomes_of(given: Machine | Tree, parts: Parts, number: int) -> npt.NDArray[np.float64]:
    if isinstance(given, Machine):
        return machines.outcomes_of(given, parts, number)
    return trees.outcomes_of(given, parts, number)


def _exact(controller: RuleSet | ControlTable, parts: Parts) -> ControlTable:
    """The exact table of a rule set that is too long for the kernel."""
    if parts.arguments or parts.counter is not None:
        what = f"{len(controller.rules)} rules" if isinstance(controller, RuleSet) else "a table"
        raise ValueError(
            f"expected rule sets of at most {_most_rules(parts)} rules where behaviours "
            f"have arguments or there are counters, got {what}"
        )
    if isinstance(controller, ControlTable):
        return controller
    return ControlTable.compile(controller, parts.vocabulary)


def _nothing_but(instances: Sequence[Instances], fails: Sequence[float], parts: Parts) -> Encoded:
    """No rules: the tables are known."""
    number = len(instances)
    return encoded(
        parts, fails, rule_ends=[0] * number, behaviours=[], action_ends=[], targets=[],
        instances=[len(own.terms) for own in instances],
        restarting=[own.restarting for own in instances],
        changes=np.zeros((0, 5), np.int64), chances=np.zeros(0),
        accepted=np.zeros((0, len(parts.sensors)), np.uint64),
    )  # fmt: skip


def _most_rules(parts: Parts) -> int:
    """Up to so many rules the kernel can keep apart; longer ones go by way of the dense table."""
    cells = sum((sensor.values - 1).bit_length() for sensor in parts.drawn_sensors)
    return MOST_RULES - MOST_STATE_BITS - cells


def _dense(tables: Sequence[ControlTable], parts: Parts) -> npt.NDArray[np.float64]:
    """Outcome distributions of each code and behaviour, shape (tables, codes, behaviours, -1)."""
    for number, table in enumerate(tables):
        known = table.space.vocabulary
        if known is not parts.vocabulary:
            raise ValueError(
                f"tables[{number}]: expected the vocabulary of {parts.name}, got one with "
                f"{', '.join(known.behaviour_index)}"
            )
        space = table.space
        if len(space.behaviours) != len(parts.behaviours) or space.states != parts.states:
            raise ValueError(
                f"tables[{number}]: expected one over all that {parts.name} can tell apart, got "
                "one over less: give the rule set itself"
            )
    return np.stack([table.probabilities[_situations(table.space, parts)] for table in tables])


def _situations(space: Space, parts: Parts) -> npt.NDArray[np.int64]:
    """For each code and behaviour the situation that it stands for."""
    rest = np.arange(parts.codes)
    state = np.full(parts.codes, parts.momentary_state)
    for sensor in parts.sensors:
        rest, reading = np.divmod(rest, sensor.values)
        for register in parts.registers:
            if register.seen_by is sensor:
                state |= reading << parts.shifts[register.name]
    sensed = np.arange(parts.codes) % parts.sensed_codes
    percepts = np.empty(parts.codes, dtype=np.int64)
    for each in np.unique(state):
        which = state == each
        percepts[which] = percepts_of_codes(parts, space, int(each))[sensed[which]]
    behaviours = len(parts.behaviours)
    rows = (percepts[:, None] * behaviours + np.arange(behaviours)) * parts.states
    return np.asarray(rows + state[:, None], dtype=np.int64)


def _compiled(
    encoded: Encoded,
    by_chance: ByChance | None,
    dense: npt.NDArray[np.float64] | None,
    parts: Parts,
) -> Tables:
    """Run the kernel, with more room until all tables are there."""
    number = len(encoded.rule_ends)
    tables = _empty(number, parts.codes)
    room = _room()
    done = compile_tables(encoded, by_chance, dense, room, tables, 0)
    while 0 <= done < number:
        tables = tables._replace(
            **{
                name: np.concatenate([each, np.empty_like(each)])
                for name, each in tables._asdict().items()
                if name in ("rows", "thresholds", "outcomes")
            }
        )
        done = compile_tables(encoded, by_chance, dense, room, tables, done)
    if done < 0:
        raise ValueError(
            f"rule set {-1 - done}: its control table is too large: expected at most {MOST_RULES} "
            f"rules, {MOST_CLASSES} classes of situations and {MOST_OUTCOMES} outcomes of one"
        )
    return tables


def _empty(number: int, codes: int) -> Tables:
    """Room for so many tables, if they are not larger than most."""
    return Tables(
        classes=np.empty(number * codes, dtype=np.uint16),
        rows=np.empty(number * min(codes, 64) * ROW_BEHAVIOURS, dtype=np.uint32),
        thresholds=np.empty(number * 256, dtype=np.uint32),
        outcomes=np.empty(number * 512, dtype=np.uint32),
        begins=np.zeros((number + 1, 3), dtype=np.int64),
    )


def _room() -> np.void:
    """Working space of this thread, kept: to ask for it takes longer than to make some tables."""
    if not hasattr(_of_thread, "room"):
        _of_thread.room = np.zeros(1, dtype=ROOM)[0]
    room: np.void = _of_thread.room
    return room
