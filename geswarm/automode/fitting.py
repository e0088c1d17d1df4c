"""Probabilities of conditions that come to wanted ones if they are looked at in random order."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from geswarm.automode.machine import Transition
from geswarm.automode.modules import FIXED, FLOORS, Condition

_ROUNDS = 50
_DIGITS = 12


def solved(wanted: Mapping[int, float]) -> dict[int, float]:
    """For up to three targets, the probability of the condition that leads to each.

    For two: p1 (1 - p2 / 2) = q1 and p2 (1 - p1 / 2) = q2. For three numerically;
    beyond, the wanted ones themselves.

    Args:
        wanted: Probability that each target is taken.
    """
    targets, q = list(wanted), list(wanted.values())
    if len(q) == 2:
        lead = 2 - (q[0] - q[1])
        p = (lead - math.sqrt(max(0.0, lead * lead - 8 * q[1]))) / 2
        q = [p + q[0] - q[1], p]
    elif len(q) == 3:
        q = _of_three(q)
    return {target: min(1.0, max(0.0, p)) for target, p in zip(targets, q, strict=True)}


def _of_three(q: Sequence[float]) -> list[float]:
    """Each is true and the first of those that are, with p times its share of the orders."""
    from scipy.optimize import root  # 0.4 s, which every start would wait for

    def first(p: Sequence[float], at: int) -> float:
        """How often a true one is the first of those that are."""
        one, other = (p[k] for k in range(3) if k != at)
        return 1 - (one + other) / 2 + one * other / 3

    p = list(q)
    for _ in range(_ROUNDS):  # near it; the rest would take long where all are nearly certain
        for at in range(3):
            p[at] = min(1.0, q[at] / first(p, at))

    def missed(tried: npt.NDArray[np.float64], /) -> list[float]:
        chances = tried.tolist()
        return [chances[at] * first(chances, at) - q[at] for at in range(3)]

    found = root(missed, p, tol=1e-15)
    return [float(each) for each in found.x]


def ways_to_say(chances: Mapping[str, Mapping[int, float]]) -> list[tuple[Transition, ...]]:
    """Transitions for these chances: one for each floor, or one for any and others that add to it.

    Args:
        chances: Of each target, for each of FLOORS.
    """
    targets = sorted({target for each in chances.values() for target in each})
    by_target = {
        target: [_short(chances[floor].get(target, 0.0)) for floor in FLOORS] for target in targets
    }
    apart = tuple(each for target, p in by_target.items() for each in _apart(target, p))
    together = tuple(each for target, p in by_target.items() for each in _together(target, p))
    return [apart, together] if len(together) < len(apart) else [apart]


def _short(p: float) -> float:
    return float(f"{p:.{_DIGITS}g}")


def _apart(target: int, p: Sequence[float]) -> Iterator[Transition]:
    """One transition for each floor; for any, if all floors are alike."""
    if len(set(p)) == 1:
        yield Transition(target, Condition(FIXED, p[0]))
    else:
        yield from (Transition(target, Condition(at, each)) for at, each in enumerate(p) if each)


def _together(target: int, p: Sequence[float]) -> Iterator[Transition]:
    """The least chance for any floor, and on some what is left of theirs: exact if alone."""
    least = min(p)
    if not 0.0 < least < 1.0:
        yield from _apart(target, p)
        return
    yield Transition(target, Condition(FIXED, least))
    for at, each in enumerate(p):
        if more := _short(1.0 - (1.0 - each) / (1.0 - least)):
            yield Transition(target, Condition(at, more))
