"""Conditions on percepts as short Boolean expressions, minimised exactly (Quine-McCluskey)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

Literals: TypeAlias = tuple[tuple[str, bool], ...]
"""Percepts that must be true or false, all of them."""


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
    words = [name if value else f"not {name}" for name, value in in_order]
    return " and ".join(words) or "always"


@dataclass(frozen=True, order=True)
class _Cube:
    """A conjunction: the bits of `care` have the values of `value`, the others are free."""

    care: int
    value: int

    def covers(self, point: int) -> bool:
        return point & self.care == self.value

    def merged(self, other: _Cube) -> _Cube | None:
        """The cube that both halves make, if they differ in exactly one bit."""
        differing = self.value ^ other.value
        if self.care != other.care or differing.bit_count() != 1:
            return None
        return _Cube(self.care & ~differing, self.value & ~differing)


def minimise(holds: Collection[int], free: Collection[int], names: tuple[str, ...]) -> Condition:
    """The shortest condition that holds at some points and, apart from free ones, nowhere else.

    Fewest terms first, then fewest literals, then fewest negations, then a fixed order, so that the
    same question always has the same answer.

    Args:
        holds: Points where it must hold; bit i of a point is the value of `names[i]`.
        free: Points where it may hold or not.
        names: The percepts.
    """
    points = sorted(set(holds))
    primes = _prime_implicants({*holds, *free}, (1 << len(names)) - 1)
    useful = [prime for prime in primes if any(map(prime.covers, points))]
    for size in range(len(points) + 1):
        covers = [
            chosen
            for chosen in combinations(useful, size)
            if all(any(cube.covers(point) for cube in chosen) for point in points)
        ]
        if covers:
            best = min(covers, key=_length)
            break
    return Condition(tuple(_literals(cube, names) for cube in best))


def _prime_implicants(points: Iterable[int], every: int) -> list[_Cube]:
    """Cubes inside the points that no larger such cube contains, in a fixed order."""
    current = {_Cube(every, point) for point in points}
    primes: set[_Cube] = set()
    while current:
        larger, absorbed = set(), set()
        for one, other in combinations(sorted(current), 2):
            if merged := one.merged(other):
                larger.add(merged)
                absorbed |= {one, other}
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
