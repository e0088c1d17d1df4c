"""The library of terms as data: what each is called, takes and means, and where it is defined."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from geswarm.rules.arguments import Argument, Choice, Number, Whole
from geswarm.rules.declarations import InternalStateName
from geswarm.rules.model import COMPARISONS, OPERATIONS, Value, format_value
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.sim.library.terms import BUILT_IN, AnyMeasure
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms import automode
from geswarm.sim.terms.component import (
    Behaviour,
    Component,
    Percept,
    Register,
)

_PACKAGE = Path(__file__).parents[3]
_OF_THE_PAPER = {
    **dict.fromkeys(FORAGING.percepts, "paper, section 3.1.1"),
    **dict.fromkeys(FORAGING.behaviour_names, "paper, section 3.1.1"),
    **dict.fromkeys(FORAGING.state_names, "paper, section 3.1.1"),
}
_EACH, _ALL = "made for each area of the arena", "made of the areas of the arena"
_MADE = {
    "areas": ("Whether the robot is on the area of that name; fails with `zone_miss`.", _EACH),
    "floor_colour": ("The colour below the robot.", "made of the colours of the arena"),
    "on": ("Robots on the area of that name, summed up over all steps.", _EACH),
    "larger_group": ("Robots on the fullest area, summed up over all steps.", _ALL),
    "max_group": ("Robots on the fullest area at the end.", _ALL),
}
"""What components without a function are, and what they are made of."""


@dataclass(frozen=True)
class Entry:
    """A term.

    Attributes:
        name: As scenario files offer it.
        kind: "precondition", "behaviour", "register" or "measure".
        arguments: What rules write in parentheses.
        words: Phrases for it; what is in braces is filled in.
        values: What it can be compared with or set to.
        signs: How rules compare or change it.
        unit: Of a measure.
        about: What it does, in a sentence; may be empty.
        source: Where it is defined: file and line, or a section of the paper.
        body: The robots that it is for; empty if it is for all.
    """

    name: str
    kind: str
    arguments: tuple[Argument, ...] = ()
    words: tuple[str, ...] = ()
    values: tuple[Value, ...] = ()
    signs: tuple[str, ...] = ()
    unit: str = ""
    about: str = ""
    source: str = ""
    body: str = ""

    @property
    def written(self) -> str:
        """As rules write it: `IS_CLOSE_TO(k)`."""
        names = ", ".join(each.name for each in self.arguments)
        return f"{self.name}({names})" if names and "(" not in self.name else self.name

    def document(self) -> dict[str, Any]:
        """As JSON values."""
        own = {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in vars(self).items()
        }
        own["operations" if self.kind == "register" else "comparisons"] = own.pop("signs")
        return {**own, "arguments": [_argument(each) for each in self.arguments]}


def _argument(argument: Argument) -> dict[str, Any]:
    """An argument as JSON values: its range, or its options."""
    found: dict[str, Any] = {"name": argument.name, "unit": argument.unit}
    if isinstance(argument, Choice):
        return {**found, "kind": "choice", "options": list(argument.options)}
    if isinstance(argument, Number):
        step = {"step": argument.step, "logarithmic": argument.logarithmic}
        return {**found, "kind": "number", "low": argument.low, "high": argument.high, **step}
    assert isinstance(argument, Whole)
    return {**found, "kind": "whole", "low": argument.low, "high": argument.high}


def catalogue(scenario: Scenario | None = None) -> list[Entry]:
    """The terms that a scenario offers, or the whole library.

    Raises:
        PartsError: The scenario offers what there is not; files are checked when they are loaded.
    """
    return list(_library() if scenario is None else _offered(scenario))


def _offered(scenario: Scenario) -> Iterator[Entry]:
    parts = parts_of(scenario)
    yield from (_percept(each, parts.vocabulary) for each in parts.percepts)
    behaviours = zip(scenario.behaviours, parts.behaviours, strict=True)
    yield from (_behaviour(name, each) for name, each in behaviours)
    yield from (_register(each) for each in parts.registers)
    yield from (_measure(each) for each in parts.measures)


def _library() -> Iterator[Entry]:
    truths: tuple[Value, ...] = (True, False)
    for name, words, values, made in (
        ("ON_<AREA>", ("on {area}", "not on {area}"), truths, "areas"),
        ("FLOOR", ("on {value}", "on a floor that is not {value}"), (), "floor_colour"),
    ):
        equal = ("==", "!=")
        yield Entry(name, "precondition", (), words, values, equal, "", *_MADE[made])
    yield from _of_bodies("percepts", lambda _, each: _percept(each, None))
    yield from _of_bodies("behaviours", _behaviour)
    yield from _of_bodies("registers", lambda _, each: _register(each))
    yield from _registers_to_declare()
    yield from _of_bodies("measures", lambda _, each: _measure(each))
    for name, unit, made in (
        ("on_<area>", "robot-steps", "on"),
        ("larger_group", "robot-steps", "larger_group"),
        ("max_group", "robots", "max_group"),
    ):
        about, source = _MADE[made]
        yield Entry(name, "measure", unit=unit, about=about, source=source)


def _of_bodies(kind: str, entry: Callable[[str, Any], Entry]) -> Iterator[Entry]:
    """The terms of a kind, each once, with the body that it is for."""
    lists = {body: getattr(terms, kind) for body, terms in BUILT_IN.items()}
    told: list[object] = []
    for body, terms in lists.items():
        for name, each in terms.items():
            if each in told:
                continue
            told.append(each)
            for_all = all(each in others.values() for others in lists.values())
            yield replace(entry(name, each), body="" if for_all else body)


def _registers_to_declare() -> Iterator[Entry]:
    """Registers to which the scenario gives name and values."""
    for name, values, about in (
        ("<NAME>", (False, True), "True or false, false at the start."),
        ("<NAME>(<ONE>, <OTHER>)", (), "One of some names, the first one at the start."),
        ("<NAME>(0..<HIGH>)", tuple(range(8)), "A counter from 0 to at most 7, 0 at the start."),
    ):
        signs = OPERATIONS if len(values) > 2 else OPERATIONS[:1]
        declared = "declared by the scenario"
        yield Entry(name, "register", values=values, signs=signs, about=about, source=declared)


def _percept(percept: Percept, vocabulary: Vocabulary | None) -> Entry:
    word = percept.word
    if vocabulary is not None:
        values, signs = vocabulary.values_of(word.name), vocabulary.comparisons_of(word.name)
    else:
        readings = range(percept.sensor.values)
        values = (False, True) if word.truth or word.chance else tuple(map(percept.value, readings))
        counts = not isinstance(values[0], bool | str)
        signs = tuple(COMPARISONS) if counts else ("==", "!=")
    return Entry(
        name=word.name,
        kind="precondition",
        arguments=word.arguments,
        words=(word.holds,) if len(signs) > 2 else tuple(filter(None, (word.holds, word.fails))),
        values=values,
        signs=signs,
        about=_about(percept.sensor),
        source=_source(word.name, percept.sensor),
    )


def _behaviour(name: str, behaviour: Behaviour) -> Entry:
    word = behaviour.word
    return Entry(
        name=name,
        kind="behaviour",
        arguments=word.arguments,
        words=(word.doing, word.start),
        about=behaviour.about,
        source=_source(name, behaviour),
    )


def _register(register: Register) -> Entry:
    word = register.word
    counts = word.counts
    return Entry(
        name=word.name,
        kind="register",
        words=tuple(filter(None, (word.on, word.off))),
        values=word.values,
        signs=OPERATIONS if counts else OPERATIONS[:1],
        about=_states(word),
        source=_source(word.name, register.seen_by),
    )


def _states(word: InternalStateName) -> str:
    """What a register is at the start, and for how long."""
    momentary = "; again after every step" if word.momentary else ""
    return f"At the start {format_value(word.initially)}{momentary}."


def _measure(measure: AnyMeasure) -> Entry:
    return Entry(
        name=measure.name,
        kind="measure",
        unit=measure.unit,
        about=_about(measure),
        source=_source(measure.name, measure),
    )


def _about(component: Component) -> str:
    return component.about if component.function else _made(component)[0]


def _made(component: Component) -> tuple[str, str]:
    kinds = (component.name, component.name.partition("_")[0])
    return next((_MADE[kind] for kind in kinds if kind in _MADE), ("", "declared by the scenario"))


def _source(name: str, component: Component | None) -> str:
    """Where a term comes from; a file of GESwarm's is named from its package on."""
    if name in _OF_THE_PAPER and (component is None or component.module != automode.__name__):
        return _OF_THE_PAPER[name]
    if component is None:
        return "declared by the scenario"
    if component.function is None:
        return _made(component)[1]
    return component.place.removeprefix(f"{_PACKAGE}/")
