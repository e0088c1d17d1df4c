"""Where rules do something else than the machine that they stand for, in outcome distributions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from geswarm.automode.machine import Machine
from geswarm.automode.modules import FLOORS
from geswarm.automode.steps import Situation, next_situations

_MOST_NEIGHBOURS = 64
"""The most that are tried: far more than any xi tells apart."""
_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Departure:
    """Where the rules do something else than the machine.

    Attributes:
        state: Of the machine.
        floor: One of FLOORS.
        neighbours: Robots that are heard, where the difference is greatest.
        machine: What the machine does: probability of each next state, the same one for staying.
        rules: What the rules do.
    """

    state: int
    floor: str
    neighbours: int
    machine: Mapping[int, float]
    rules: Mapping[int, float]

    @property
    def distance(self) -> float:
        """Total variation distance: in what share of such steps the two differ."""
        states = self.machine.keys() | self.rules.keys()
        return sum(abs(self.machine.get(k, 0.0) - self.rules.get(k, 0.0)) for k in states) / 2

    def __str__(self) -> str:
        return (
            f"state {self.state}, {self.floor} floor, {self.neighbours} neighbours: "
            f"AutoMoDe {_told(self.machine)}; rules {_told(self.rules)}"
        )


def _told(shares: Mapping[int, float]) -> str:
    return ", ".join(f"{p:.4g} to {state}" for state, p in sorted(shares.items()) if p > _TOLERANCE)


def departures_of(
    machine: Machine, number: int, rules: Callable[[str, int], Mapping[int, float]]
) -> Iterator[Departure]:
    """The greatest difference on each floor, if there is one.

    Args:
        machine: The machine.
        number: Of the state.
        rules: What rules do there on a floor with a number of neighbours: probability of each next
            state, the same one for staying.
    """
    for floor in FLOORS:
        found = max(
            (_departure(machine, number, rules, floor, n) for n in range(_MOST_NEIGHBOURS)),
            key=lambda each: each.distance,
        )
        if found.distance > _TOLERANCE:
            yield found


def _departure(
    machine: Machine,
    number: int,
    rules: Callable[[str, int], Mapping[int, float]],
    floor: str,
    neighbours: int,
) -> Departure:
    """What machine and rules do in a state, for one reading."""
    here = Situation(number, False)
    exact = next_situations(machine, here, lambda each: each.chance(floor, neighbours))
    does = {situation.state: float(p) for situation, p in exact.items()}
    return Departure(number, floor, neighbours, does, rules(floor, neighbours))
