"""What a machine does in a step, exactly: the distribution over what follows.

From ARGoS3-AutoMoDe, `AutoMoDeFiniteStateMachine::ControlStep`: the behaviour acts first; then the
conditions of the state are looked at in an order that is drawn anew in each step, each drawn on its
own, and the first true one decides where the robot is in the next step. In the first step in a
state nothing is looked at. The order comes from a generator that is never seeded; over a run that
makes no difference to what is stated here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from typing import TypeAlias

from geswarm.automode.machine import Machine
from geswarm.automode.modules import Condition

Chance: TypeAlias = float | Fraction


@dataclass(frozen=True)
class Situation:
    """Where a robot is in its machine.

    Attributes:
        state: Index of the state whose behaviour it executes in this step.
        first: Whether this is the first step there.
    """

    state: int
    first: bool


START = Situation(0, True)
"""Of every robot in the first step of a run."""


def next_situations(
    machine: Machine, here: Situation, chance: Callable[[Condition], Chance]
) -> dict[Situation, Chance]:
    """The distribution over situations in the next step; exact if the chances are fractions.

    Args:
        machine: What the robot runs.
        here: Where it is.
        chance: The probability that a condition is true in this step, from what the robot senses:
            `lambda condition: condition.chance("black", 3)`.
    """
    transitions = () if here.first else machine.states[here.state].transitions
    chances = [(each.target, chance(each.condition)) for each in transitions]
    taken = first_true(chances, permutations(range(len(chances))))
    stays = 1 - sum(taken.values(), start=Fraction(0))
    found = {Situation(target, True): p for target, p in taken.items()}
    return found | ({Situation(here.state, False): stays} if stays > 0 else {})


def first_true(
    chances: Sequence[tuple[int, Chance]], orders: Iterable[Sequence[int]]
) -> dict[int, Chance]:
    """How probable it is that each target's condition is the first true one.

    Args:
        chances: Target and probability of each condition.
        orders: In which they may be looked at, each as probable as the others.

    Returns:
        By target, without those that are never reached; what remains to 1 is that none is true.
    """
    taken: dict[int, Chance] = defaultdict(Fraction)
    equally = list(orders)
    for order in equally:
        left: Chance = Fraction(1, len(equally))
        for at in order:
            target, p = chances[at]
            taken[target] += left * p
            left *= 1 - p
    return {target: p for target, p in taken.items() if p}
