"""What comes after a step in a state, as a sequence of choices of which the last made counts.

Neighbour counts are true by chance, and their chance depends on how many robots are heard. So their
order is fixed here: given that one is true and all before it are false, nothing depends on those
behind it, and what comes next has constant probabilities, whatever else is looked at before or
after it in random order. A choice for the last of them, then one for the last but one, and so on to
the first, come to exactly what the machine does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

from geswarm.automode.machine import State, Transition
from geswarm.automode.modules import FLOORS, NEIGHBOUR_COUNTS, Condition
from geswarm.automode.steps import first_true

Order = tuple[int, ...]
"""In which a state's neighbour counts are looked at: positions among its transitions."""


@dataclass(frozen=True)
class Choice:
    """A draw of the next state.

    Attributes:
        floor: On which it is made; empty for any.
        condition: The neighbour count that must be true, or None.
        shares: Probability of each next state where it is made.
    """

    floor: str
    condition: Condition | None
    shares: Mapping[int, float]

    def chance(self, floor: str, neighbours: int) -> float:
        """The probability that it is made."""
        if self.floor not in ("", floor):
            return 0.0
        return self.condition.chance(floor, neighbours) if self.condition else 1.0


def orders_of(state: State) -> list[Order]:
    """The orders in which neighbour counts can come; one if their order makes no difference."""
    counts = _counts(state)
    targets = {each.target for each in state.transitions}
    return list(permutations(counts)) if len(targets) > 1 else [counts]


def _counts(state: State) -> Order:
    return tuple(
        at for at, each in enumerate(state.transitions) if each.condition.number in NEIGHBOUR_COUNTS
    )


def choices_of(state: State, order: Order) -> Iterator[Choice]:
    """The choices, given the order of the neighbour counts; the last one made counts."""
    yield from _by_floor(state, order, None)
    for holding in reversed(order):
        yield from _by_floor(state, order, holding)


def _by_floor(state: State, order: Order, holding: int | None) -> Iterator[Choice]:
    """The choices if a neighbour count is the first true one, or none is true."""
    condition = None if holding is None else state.transitions[holding].condition
    shares = {floor: _shares(state.transitions, floor, order, holding) for floor in FLOORS}
    if len({tuple(sorted(each.items())) for each in shares.values()}) == 1:
        shares = {"": shares[FLOORS[0]]}
    yield from (Choice(floor, condition, each) for floor, each in shares.items() if each)


def _shares(
    transitions: Sequence[Transition], floor: str, order: Order, holding: int | None
) -> dict[int, float]:
    """Probability of each next state; all other conditions come anywhere in the order."""
    chances = [
        (
            each.target,
            float(at == holding) if at in order else each.condition.chance(floor, 0),
        )
        for at, each in enumerate(transitions)
    ]
    agreeing = (
        whole
        for whole in permutations(range(len(transitions)))
        if tuple(at for at in whole if at in order) == order
    )
    return {target: float(p) for target, p in first_true(chances, agreeing).items()}


def outcome(choices: Sequence[Choice], state: int, floor: str, neighbours: int) -> dict[int, float]:
    """Probability of each state in the next step, as the choices make it; `state` is to stay."""
    found = {state: 1.0}
    for choice in choices:
        made = choice.chance(floor, neighbours)
        left = 1.0 - made * sum(choice.shares.values())
        found = {each: p * left for each, p in found.items()}
        for each, share in choice.shares.items():
            found[each] = found.get(each, 0.0) + made * share
    return found
