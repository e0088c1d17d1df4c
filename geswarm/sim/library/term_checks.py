"""What is wrong with the terms that a scenario offers, one by one and together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from geswarm.sim.arena.checks import Problem
from geswarm.sim.library import vocabulary as library
from geswarm.sim.library.own_terms import OwnTermsError, load_own_terms
from geswarm.sim.library.terms import Terms
from geswarm.sim.library.vocabulary import Design
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms.component import Behaviour, Component, Percept, Register
from geswarm.sim.terms.ground import GroundError
from geswarm.sim.terms.parts import PartsError

_OFFERED: Mapping[str, Callable[[Design, Terms], Iterator[Any]]] = {
    "preconditions": library.percepts_of,
    "behaviours": library.behaviours_of,
    "registers": library.registers_of,
    "measures": library.measures_of,
}
"""What each list of names becomes."""
_OF_LIGHTS = frozenset({"to_light_x", "to_light_y", "brightness"})
_OF_OBJECTS = frozenset({"carried", "object_near"})
"""What components name that need there to be a light, or objects."""


def term_problems(scenario: Scenario) -> Iterator[Problem]:
    """Everything wrong with the terms of a scenario that is right otherwise.

    Whether the terms fit together is checked once each is right by itself.
    """
    try:
        own = load_own_terms(scenario.terms)
    except OwnTermsError as error:
        yield ("terms",), str(error)
        return
    try:
        design = Design.of(scenario, own.version)
    except GroundError as error:
        yield ("outline", "patches", "obstacles"), str(error)
        return
    found = list(_one_by_one(design, own.terms)) or list(_offered_twice(design))
    yield from found or _together(scenario)


def _one_by_one(design: Design, own: Terms) -> Iterator[Problem]:
    for key, read in _OFFERED.items():
        for number, name in enumerate(getattr(design, key), start=1):
            item = f"{key} {number}"
            alone: dict[str, Any] = {key: (name,)}
            try:
                terms = list(read(replace(design, **alone), own))
            except PartsError as error:
                yield (item, key), str(error)
                continue
            needed = {need for term in terms for part in _parts(term) for need in part.needs}
            if needed & _OF_LIGHTS and not design.ground.lights:
                yield (item, key, "lights"), f"{name} needs a light, but the arena has none"
            if needed & _OF_OBJECTS and not design.objects:
                yield (item, key, "objects"), f"{name} needs objects, but the scenario has none"


def _offered_twice(design: Design) -> Iterator[Problem]:
    """Words that mean two things, such as a behaviour with arguments and without."""
    taken: dict[str, str] = {}
    for key in ("preconditions", "behaviours", "registers"):
        for at, name in enumerate(getattr(design, key), start=1):
            word = name.partition("(")[0]
            if word in taken:
                message = f"{name}: rules could not tell it from {taken[word]}"
                yield (f"{key} {at}", key), message
            taken.setdefault(word, name)


def _parts(term: Percept | Behaviour | Register | Component) -> Iterator[Component]:
    """The components behind a term."""
    if isinstance(term, Percept):
        yield term.sensor
    elif isinstance(term, Register):
        yield from [term.seen_by] if term.seen_by else []
    else:
        yield term
        if isinstance(term, Behaviour):
            yield from (part for part in (term.start, term.again) if part)


def _together(scenario: Scenario) -> Iterator[Problem]:
    try:
        library.parts_of(scenario)
    except library.TermError as error:
        first = error.term == scenario.initial_behaviour
        keys = ("initial_behaviour", "behaviours") if first else ("registers",)
        yield keys, str(error).removeprefix(f"{keys[0]}: ")
    except PartsError as error:
        own = scenario.terms is not None and str(scenario.terms) in str(error)
        where = ("terms",) if own else (*_OFFERED, "terms")
        yield where, str(error).removeprefix("scenario: ")
