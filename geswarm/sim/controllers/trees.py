"""Behaviour trees as AutoMoDe's Maple runs them (Kuckling et al. 2018), as control tables.

A tree is asked in every step, and what it answers depends on what its nodes with a star remember.
An instance is what it remembers after a step and the behaviour that it executed there, found from
the start on; a behaviour starts afresh where another one was executed before.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
import numpy.typing as npt

from geswarm.automode import Ticked, Tree, tick
from geswarm.rules.model import Term
from geswarm.sim.controllers.machines import (
    ControllerError,
    chance_of,
    perceived,
    require_offered,
)
from geswarm.sim.kernels.table import ROW_BEHAVIOURS
from geswarm.sim.terms.parts import Parts

_AT_REST = Term("STOP")
"""Where no behaviour is executed."""
_START = Ticked(None, ())


@dataclass(frozen=True)
class _Known:
    """What a tree can come to.

    Attributes:
        found: Each pair of memory and executed behaviour, the start first.
        follows: For each of them, and each code, the probability of each that can follow.
    """

    found: tuple[Ticked, ...]
    follows: tuple[tuple[Mapping[int, float], ...], ...]


def instances_of(tree: Tree, parts: Parts) -> tuple[Term, ...]:
    """The behaviours of a tree's instances, that of the start where robots begin.

    Raises:
        ControllerError: A behaviour is not on offer, or there are too many instances.
    """
    known = _known(tree, parts)
    terms = [each.executed.term if each.executed else _AT_REST for each in known.found]
    require_offered(terms, parts)
    terms += [_AT_REST] * max(0, parts.first_instance + 1 - len(terms))
    first = parts.first_instance
    terms[0], terms[first] = terms[first], terms[0]
    return tuple(terms)


def outcomes_of(tree: Tree, parts: Parts, number: int) -> npt.NDArray[np.float64]:
    """Outcome distributions of each code and instance, see `kernels.tabulate`.

    Args:
        tree: What to tabulate.
        parts: What the scenario is composed of.
        number: How many instances there are to be room for.

    Returns:
        Shape (codes, number, 2 * number * states of the registers).
    """
    known, first = _known(tree, parts), parts.first_instance
    order = list(range(max(len(known.found), first + 1)))
    order[0], order[first] = order[first], order[0]
    table = np.zeros((parts.codes, number, number, parts.states, 2))
    for at, by_code in enumerate(known.follows):
        for code, follows in enumerate(by_code):
            for to, share in follows.items():
                afresh = known.found[to].executed != known.found[at].executed
                table[code, order[at], order[to], 0, int(afresh)] += share
    return table.reshape(parts.codes, number, -1)


@lru_cache(maxsize=64)
def _known(tree: Tree, parts: Parts) -> _Known:
    numbers = {_START: 0}
    follows: list[tuple[Mapping[int, float], ...]] = []
    senses = [perceived(parts, code) for code in range(parts.codes)]
    while len(follows) < len(numbers):
        here = list(numbers)[len(follows)]
        by_sense: dict[tuple[str, int], Mapping[int, float]] = {}
        for sense in dict.fromkeys(senses):
            then = tick(tree, here.memory, partial(chance_of, *sense))
            for each in then:
                numbers.setdefault(each, len(numbers))
            by_sense[sense] = {numbers[each]: float(p) for each, p in then.items()}
        if len(numbers) > ROW_BEHAVIOURS:
            raise ControllerError(
                f"expected a tree that comes to at most {ROW_BEHAVIOURS} different pairs of "
                "memory and behaviour, found more"
            )
        follows.append(tuple(by_sense[sense] for sense in senses))
    return _Known(tuple(numbers), tuple(follows))
