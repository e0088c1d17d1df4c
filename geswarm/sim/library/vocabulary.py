"""The library of terms: from the names that a scenario offers to what it is composed of."""

from __future__ import annotations

import difflib
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

from geswarm.rules.declarations import PreconditionName, Reading
from geswarm.rules.model import Value
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.sim.arena.geometry import overlap
from geswarm.sim.arena.model import Arena, HalfPlane, Plain
from geswarm.sim.assembly.kernel import source_of
from geswarm.sim.assembly.source import Layout
from geswarm.sim.bodies import Body
from geswarm.sim.controllers.encoding import numbers_by_name
from geswarm.sim.library.own_terms import load_own_terms
from geswarm.sim.library.terms import BUILT_IN, AnyMeasure, Terms
from geswarm.sim.library.vetting import own_components, require_measures, require_sound
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms import avoidance, objects
from geswarm.sim.terms.component import (
    Behaviour,
    Component,
    Effect,
    Measure,
    Percept,
    PlacesMeasure,
    Register,
    Sensor,
    SwarmMeasure,
)
from geswarm.sim.terms.declare import register
from geswarm.sim.terms.ground import Ground
from geswarm.sim.terms.parts import Parts, PartsError

_Term = TypeVar("_Term")


@dataclass(frozen=True)
class Design:
    """What of a scenario decides which kernel it needs and what rules may mention.

    Attributes:
        preconditions: Names.
        behaviours: Names.
        registers: Names, or declarations such as `MODE(red, green)` and `HUNGER(0..5)`.
        initial_behaviour: Name.
        probabilities: Of p, that grammar and editor offer.
        measures: Names.
        ground: The form of the arena.
        body: The kind of robot.
        colours: Of the floor.
        apart: Pairs of areas that do not overlap.
        objects: Whether there are any.
        terms: The Python file with own terms.
        version: Of that file, so that an edited one is loaded anew.
    """

    preconditions: tuple[str, ...]
    behaviours: tuple[str, ...]
    registers: tuple[str, ...]
    initial_behaviour: str
    probabilities: tuple[float, ...]
    measures: tuple[str, ...]
    ground: Ground
    body: Body
    colours: tuple[str, ...]
    apart: tuple[tuple[str, str], ...]
    objects: bool
    terms: Path | None = None
    version: str = ""

    @classmethod
    def of(cls, scenario: Scenario, version: str) -> Design:
        """The design of a scenario; `version` is that of its own terms."""
        return cls(
            preconditions=scenario.preconditions,
            behaviours=scenario.behaviours,
            registers=scenario.registers,
            initial_behaviour=scenario.initial_behaviour,
            probabilities=scenario.probabilities,
            measures=scenario.measures,
            ground=Ground.of(scenario.arena),
            body=scenario.robot,
            colours=scenario.arena.colours,
            apart=tuple(_areas_apart(scenario.arena)),
            objects=scenario.objects > 0,
            terms=scenario.terms,
            version=version,
        )

    @property
    def areas(self) -> tuple[str, ...]:
        """Named parts of the floor."""
        return self.ground.areas


def _areas_apart(arena: Arena) -> Iterator[tuple[str, str]]:
    """Pairs of areas that do not overlap."""
    for one, other in itertools.combinations(arena.areas, 2):
        pairs = itertools.product(arena.area(one), arena.area(other))
        if all(_is_beside(*pair) or not overlap(*pair) for pair in pairs):
            yield one, other


def _is_beside(one: Plain, other: Plain) -> bool:
    """Whether two half-planes share a border at most."""
    places: dict[str, float] = {
        each.side: each.at for each in (one, other) if isinstance(each, HalfPlane)
    }
    return any(
        places.get(low, math.inf) <= places.get(high, -math.inf)
        for low, high in (("south", "north"), ("west", "east"))
    )


class TermError(PartsError):
    """A scenario offers a term that there is not, or that does not fit; `term` is its name."""

    def __init__(self, message: str, term: str = "") -> None:
        super().__init__(message)
        self.term = term


def parts_of(scenario: Scenario) -> Parts:
    """What a scenario is composed of; the same object for scenarios of the same design.

    Raises:
        TermError: A term is not known, or does not fit the scenario.
        PartsError: The components do not fit together.
    """
    return _parts_of(scenario, load_own_terms(scenario.terms).version)


@lru_cache(maxsize=256)
def _parts_of(scenario: Scenario, version: str) -> Parts:
    parts = _parts(Design.of(scenario, version))
    if own := load_own_terms(scenario.terms).module:
        _, names = source_of(parts, Layout())
        numbers_by_name(scenario, names, parts)  # what components name shows in the source
        _require_sound(parts, own)
    for each in parts.of_places.values():
        require_measures(each, scenario.arena)
    return parts


@lru_cache(maxsize=64)
def _require_sound(parts: Parts, module: str) -> None:
    for component in own_components(parts, module):
        require_sound(component, parts)


def vocabulary_of(scenario: Scenario) -> Vocabulary:
    """What the rules of a scenario may mention; errors as for `parts_of`."""
    return parts_of(scenario).vocabulary


@lru_cache(maxsize=64)
def _parts(design: Design) -> Parts:
    own = load_own_terms(design.terms).terms
    registers = tuple(registers_of(design, own))
    percepts = tuple(percepts_of(design, own))
    behaviours = tuple(behaviours_of(design, own))
    seen = [
        Percept(each.word.as_percept(), each.seen_by, _value_of(each))
        for each in registers
        if each.word.readable and each.seen_by
    ]
    sensors = dict.fromkeys(each.sensor for each in percepts)
    sensors |= dict.fromkeys(each.seen_by for each in registers if each.seen_by)
    measures = tuple(measures_of(design, own))
    vocabulary = _vocabulary(design, percepts, behaviours, registers)
    plain = {each.word.name: each for each in behaviours if not each.arguments}
    first = plain.get(design.initial_behaviour)
    if first is None:
        raise TermError(
            f"initial_behaviour: expected one on offer that has no arguments, got "
            f"{design.initial_behaviour}; on offer are {', '.join(design.behaviours)}",
            design.initial_behaviour,
        )
    return Parts(
        name=vocabulary.name or "scenario",
        vocabulary=vocabulary,
        percepts=(*percepts, *seen),
        sensors=tuple(sensors),
        behaviours=behaviours,
        first=first,
        ground=design.ground,
        body=design.body,
        registers=registers,
        sums=() if design.body.is_inert else (*BUILT_IN[design.body.name].sums, *own.sums),
        steering=() if design.body.is_inert else (avoidance.avoid,),
        effects=tuple(dict.fromkeys(_effects(design, measures))),
        measures=measures,
    )


def _value_of(register: Register) -> Callable[[int], Value]:
    return lambda reading: register.word.values[min(reading, register.values - 1)]


def _pick(
    kind: str,
    name: str,
    known: Mapping[str, _Term],
    own: Mapping[str, _Term],
    more: Iterable[str] = (),
) -> _Term:
    """A term by its name.

    Raises:
        TermError: It is not known.
    """
    if name in own and name in known:
        taken = own[name]
        where = f" ({taken.place})" if isinstance(taken, Component) else ""
        raise TermError(f"{kind} {name}{where}: the name is taken by GESwarm's own", name)
    found = own.get(name) or known.get(name)
    if found is None:
        names = [*known, *own, *more]
        folded = {each.casefold(): each for each in names}
        near = difflib.get_close_matches(name.casefold(), folded, n=1)
        hint = f"did you mean {folded[near[0]]}?" if near else f"known are {', '.join(names)}"
        raise TermError(f"unknown {kind} {name}; {hint}", name)
    return found


def behaviours_of(design: Design, own: Terms) -> Iterator[Behaviour]:
    """The behaviours on offer; raises TermError at one that is not known."""
    known = BUILT_IN[design.body.name].behaviours
    for name in design.behaviours:
        yield _pick("behaviour", name, known, own.behaviours)


def percepts_of(design: Design, own: Terms) -> Iterator[Percept]:
    """The percepts on offer; raises TermError at one that is not known."""
    known = BUILT_IN[design.body.name].percepts
    made = {} if design.body.is_inert else dict(_made_percepts(design))
    for name in design.preconditions:
        yield made.get(name) or _pick("precondition", name, known, own.percepts, made)


def _made_percepts(design: Design) -> Iterator[tuple[str, Percept]]:
    """`ON_<AREA>` for each area, `FLOOR` for the colours."""
    if design.areas:
        given = tuple(f"in_{area}" for area in design.areas)
        areas = Sensor(None, called="areas", given=given, values=2 ** len(given), fails="zone_miss")
        for bit, area in enumerate(design.areas):
            name = f"ON_{area.upper()}"
            word = FORAGING.percepts.get(name) or PreconditionName(
                name, f"on {area}", f"not on {area}"
            )
            yield name, Percept(word, areas, _bit(bit))
    if len(design.colours) > 1:
        floor = Sensor(None, called="floor_colour", given=("floor",), values=len(design.colours))
        word = PreconditionName("FLOOR", "on {value}", "on a floor that is not {value}", "floor")
        yield "FLOOR", Percept(word, floor, design.colours.__getitem__)


def _bit(at: int) -> Callable[[int], Value]:
    return lambda reading: bool(reading >> at & 1)


def registers_of(design: Design, own: Terms) -> Iterator[Register]:
    """The internal states on offer; raises TermError at one that is not known."""
    known = BUILT_IN[design.body.name].registers
    for declared in design.registers:
        name, _, values = declared.partition("(")
        if values or (name not in known and name not in own.registers):
            yield _declared(name.strip(), values.rstrip(") "), declared)
        else:
            yield _pick("register", name, known, own.registers)


def _declared(name: str, values: str, declared: str) -> Register:
    """A register of which the scenario gives name and values; rules may read it."""
    kinds: tuple[Value, ...] = (False, True)
    if ".." in values:
        low, _, high = values.partition("..")
        if low.strip() != "0" or not high.strip().isdigit() or not 0 < int(high) <= 7:
            raise TermError(f"{declared}: expected a counter such as {name}(0..7)", declared)
        kinds = tuple(range(int(high) + 1))
    elif values:
        kinds = tuple(dict.fromkeys(part.strip() for part in values.split(",")))
        if len(kinds) < 2 or not all(str(kind).isidentifier() for kind in kinds):
            raise TermError(
                f"{declared}: expected at least two names such as {name}(red, green)", declared
            )
    if not name.replace("-", "_").isidentifier():
        raise TermError(f"{declared}: expected a name of letters, digits and _", declared)
    return register(name, kinds)


def measures_of(design: Design, own: Terms) -> Iterator[AnyMeasure]:
    """What is counted; raises TermError at one that is not known, or counts what there is not."""
    made: dict[str, AnyMeasure] = {
        f"on_{area}": Measure(None, called=f"on_{area}", given=(f"in_{area}",), unit="robot-steps")
        for area in design.areas
    }
    if design.areas:
        sums = tuple(f"sum_in_{area}" for area in design.areas)
        made["larger_group"] = SwarmMeasure(
            None, called="larger_group", given=sums, unit="robot-steps"
        )
        made["max_group"] = SwarmMeasure(
            None, called="max_group", given=sums, at="end", unit="robots"
        )
    known = BUILT_IN[design.body.name].measures
    for name in design.measures:
        found = made.get(name) or _pick("measure", name, known, own.measures, made)
        of_objects = isinstance(found, Measure) and found.at in (objects.drop, objects.pick_up)
        if of_objects and not design.objects:
            raise TermError(f"{name} counts objects, but the scenario has none", name)
        if name in known and (missing := _areas_of(found) - set(design.areas)):
            listed = " and ".join(sorted(missing))
            raise TermError(f"{name} is about {listed}, but there is no area of that name", name)
        yield found


def _effects(design: Design, measures: Iterable[AnyMeasure]) -> Iterator[Effect]:
    """What happens to objects if there are any, and what measures count."""
    if design.objects:
        yield from (objects.drop, objects.pick_up)
    for each in measures:
        if isinstance(each, Measure) and isinstance(each.at, Effect):
            yield from filter(None, (each.at.after, each.at))


def _areas_of(measure: AnyMeasure) -> set[str]:
    """The areas that a measure and what it counts name."""
    if isinstance(measure, PlacesMeasure):
        return set(measure.areas)
    at = measure.at
    named = [measure, at, at.after] if isinstance(at, Effect) else [measure]
    needs = (name for each in named if each for name in each.needs)
    return {name.removeprefix("in_") for name in needs if name.startswith("in_")}


def _vocabulary(
    design: Design,
    percepts: tuple[Percept, ...],
    behaviours: tuple[Behaviour, ...],
    registers: tuple[Register, ...],
) -> Vocabulary:
    """What rules may mention; foraging's own if it comes to the same."""
    readings = {
        each.word.reading: Reading(
            each.word.reading, tuple(each.value(reading) for reading in range(each.sensor.values))
        )
        for each in percepts
        if each.word.reading
    }
    apart = tuple(
        (f"ON_{one.upper()}", f"ON_{other.upper()}")
        for one, other in design.apart
        if {f"ON_{one.upper()}", f"ON_{other.upper()}"} <= set(design.preconditions)
    )
    held = any(each.word.name == "HAS_OBJECT" for each in percepts)
    found = Vocabulary(
        preconditions=tuple(each.word for each in percepts),
        behaviours=tuple(each.word for each in behaviours),
        internal_states=tuple(each.word for each in registers),
        probabilities=design.probabilities,
        initial_behaviour=design.initial_behaviour,
        apart=apart,
        objects=FORAGING.objects if design.objects and held else None,
        readings=tuple(readings.values()),
        name="foraging",
    )
    needed = [each.word.name for each in (objects.WANT_OBJECT, objects.DROP_OBJECT)]
    if design.objects and not set(needed) <= {each.word.name for each in registers}:
        raise TermError(
            f"registers: objects need {' and '.join(needed)}, got "
            f"{', '.join(design.registers) or 'none'}"
        )
    same = all(getattr(found, f.name) == getattr(FORAGING, f.name) for f in fields(Vocabulary))
    return FORAGING if same else replace(found, name="")
