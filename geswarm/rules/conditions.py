"""Conditions on percepts as short Boolean expressions.

Minimised exactly (Quine-McCluskey) where that can be done in a moment; else by enlarging each
conjunction as far as it goes and taking the most useful ones (as Espresso does).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

Literals: TypeAlias = tuple[tuple[str, bool], ...]
"""Percepts that must be true or false, all of them."""


_EXACTLY = 6
"""Up to so many names, all prime implicants are worked out."""
_MOST_TRIES = 20_000
"""Choices of conjunctions that are looked at."""
_OPPOSITES = {">=": "<", ">": "<=", "==": "!="}


@dataclass(frozen=True)
class Condition:
    """A disjunction of conjunctions of percepts.

    Attributes:
        terms: Any of them must hold; one without literals always holds, no term means never.
    """

    terms: tuple[Literals, ...]

    def holds(self, percepts: Mapping[str, bool]) -> bool:
        """Whether the condition holds for these percepts."""
        return any(all(percepts[name] == value for name, value in term) for term in self.terms)

    @property
    def names(self) -> set[str]:
        """The percepts that the condition looks at."""
        return {name for term in self.terms for name, _ in term}

    def __str__(self) -> str:
        if not self.terms:
            return "never"
        return " or ".join(map(_conjunction, self.terms))


def _conjunction(term: Literals) -> str:
    """What must be true comes first: it is what the eye looks for."""
    in_order = sorted(term, key=lambda literal: not literal[1])
    words = [name if value else _denied(name) for name, value in in_order]
    return " and ".join(words) or "always"


def _denied(name: str) -> str:
    """`not ON_NEST`, and `NEIGHBOURS < 3` for `NEIGHBOURS >= 3`."""
    for sign, opposite in _OPPOSITES.items():
        if f" {sign} " in name:
            return name.replace(sign, opposite)
    return f"not {name}"


@dataclass(frozen=True, order=True)
class _Cube:
    """A conjunction: the bits of `care` have the values of `value`, the others are free."""

    care: int
    value: int

    def covers(self, point: int) -> bool:
        return point & self.care == self.value


def minimise(holds: Collection[int], fails: Collection[int], names: tuple[str, ...]) -> Condition:
    """A short condition that holds at some points and not at others; elsewhere it may do either.

    Fewest terms first, then fewest literals, then fewest negations, then a fixed order, so that the
    same question always has the same answer. With many names or points, a few more may be found.

    Args:
        holds: Points where it must hold; bit i of a point is the value of `names[i]`.
        fails: Points where it must not.
        names: The percepts.
    """
    points, every = sorted(set(holds)), (1 << len(names)) - 1
    if len(names) <= _EXACTLY:
        primes = _prime_implicants(set(range(every + 1)).difference(fails), every)
    else:
        primes = sorted({_enlarged(point, fails, every) for point in points})
    useful = [prime for prime in primes if any(map(prime.covers, points))]
    best = _shortest_cover(useful, points) or _greedy_cover(useful, points)
    return Condition(tuple(_literals(cube, names) for cube in best))


def _shortest_cover(cubes: list[_Cube], points: list[int]) -> tuple[_Cube, ...] | None:
    """The shortest choice of cubes that covers all points; None if that would take too long."""
    if not points:
        return ()
    tries = 0
    for size in range(1, len(points) + 1):
        tries += math.comb(len(cubes), size)
        if tries > _MOST_TRIES:
            return None
        covers = [
            chosen
            for chosen in combinations(cubes, size)
            if all(any(cube.covers(point) for cube in chosen) for point in points)
        ]
        if covers:
            return min(covers, key=_length)
    return None


def _greedy_cover(cubes: list[_Cube], points: list[int]) -> tuple[_Cube, ...]:
    """The cube that covers most of what is left, again and again; then without idle ones."""
    chosen: list[_Cube] = []
    left = set(points)
    while left:
        best = max(cubes, key=lambda cube: (sum(map(cube.covers, left)), -cube.care.bit_count()))
        chosen.append(best)
        left = {point for point in left if not best.covers(point)}
    for cube in list(chosen):
        others = [other for other in chosen if other != cube]
        if all(any(other.covers(point) for other in others) for point in points):
            chosen = others
    return tuple(sorted(chosen))


def _enlarged(point: int, fails: Collection[int], every: int) -> _Cube:
    """The cube around a point that has as few literals as the points of `fails` allow."""
    care = every
    for bit in range(every.bit_length()):
        without = care & ~(1 << bit)
        if not any(other & without == point & without for other in fails):
            care = without
    return _Cube(care, point & care)


def _prime_implicants(points: Iterable[int], every: int) -> list[_Cube]:
    """Cubes inside the points that no larger such cube contains, in a fixed order."""
    current = {_Cube(every, point) for point in points}
    primes: set[_Cube] = set()
    while current:
        larger, absorbed = set(), set()
        for cube in current:
            for bit in range(every.bit_length()):
                other = _Cube(cube.care, cube.value ^ 1 << bit)
                if cube.care >> bit & 1 and other in current:
                    larger.add(_Cube(cube.care & ~(1 << bit), cube.value & ~(1 << bit)))
                    absorbed |= {cube, other}
        primes |= current - absorbed
        current = larger
    return sorted(primes)


def _length(cubes: tuple[_Cube, ...]) -> tuple[int, int, tuple[_Cube, ...]]:
    literals = sum(cube.care.bit_count() for cube in cubes)
    negations = sum((cube.care & ~cube.value).bit_count() for cube in cubes)
    return literals, negations, cubes


def _literals(cube: _Cube, names: tuple[str, ...]) -> Literals:
    return tuple(
        (name, bool(cube.value >> bit & 1))
        for bit, name in enumerate(names)
        if cube.care >> bit & 1
    )
