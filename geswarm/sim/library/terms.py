"""The terms that modules declare: those of GESwarm, and those of a file beside a scenario."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from types import ModuleType
from typing import TypeAlias

from geswarm.sim import terms
from geswarm.sim.bodies import BODIES, Body
from geswarm.sim.terms.component import (
    Behaviour,
    CellMeasure,
    Measure,
    Percept,
    PlacesMeasure,
    Register,
    Sum,
    SwarmMeasure,
)

AnyMeasure: TypeAlias = Measure | SwarmMeasure | CellMeasure | PlacesMeasure


@dataclass(frozen=True)
class Terms:
    """Terms by the names that scenario files offer them under.

    Attributes:
        percepts: By the word that rules write.
        behaviours: Likewise; where two have the same word, the one with arguments has them in its
            name: `RANDOM_WALK(shortest, longest)`.
        registers: By the word that rules write.
        measures: By the function's name.
        sums: Sums over the other robots.
    """

    percepts: dict[str, Percept] = field(default_factory=dict)
    behaviours: dict[str, Behaviour] = field(default_factory=dict)
    registers: dict[str, Register] = field(default_factory=dict)
    measures: dict[str, AnyMeasure] = field(default_factory=dict)
    sums: tuple[Sum, ...] = ()

    @classmethod
    def of(cls, modules: Iterable[ModuleType]) -> Terms:
        """All that is declared in some modules."""
        found = list(dict.fromkeys(each for module in modules for each in _declared(module)))
        return cls(
            percepts={each.word.name: each for each in found if isinstance(each, Percept)},
            behaviours=_by_name([each for each in found if isinstance(each, Behaviour)]),
            registers={each.word.name: each for each in found if isinstance(each, Register)},
            measures={each.name: each for each in found if isinstance(each, AnyMeasure)},
            sums=tuple(each for each in found if isinstance(each, Sum)),
        )


def _declared(module: ModuleType) -> list[object]:
    kinds = Percept | Behaviour | Register | Sum | AnyMeasure
    return [each for each in vars(module).values() if isinstance(each, kinds)]


def _by_name(behaviours: list[Behaviour]) -> dict[str, Behaviour]:
    words = [each.word.name for each in behaviours]
    named = {}
    for each in behaviours:
        arguments = ", ".join(each.arguments)
        distinct = bool(arguments) and words.count(each.word.name) > 1
        named[f"{each.word.name}({arguments})" if distinct else each.word.name] = each
    return named


def _built_in(body: Body) -> Terms:
    names = [f"{terms.__name__}.{each.name}" for each in pkgutil.iter_modules(terms.__path__)]
    modules = [import_module(name) for name in names]
    return Terms.of(each for each in modules if getattr(each, "BODY", body) is body)


BUILT_IN: Mapping[str, Terms] = {name: _built_in(body) for name, body in BODIES.items()}
"""By body, those of the modules in `geswarm.sim.terms` that are for it (`BODY`) or for any;
`ON_<AREA>`, `FLOOR` and measures such as `on_<area>` are made for each arena."""
