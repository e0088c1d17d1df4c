"""What rules over AutoMoDe's terms do in a step, exactly, for given chances of preconditions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from geswarm.automode.modules import CONDITIONS, NEIGHBOUR_COUNTS, Condition
from geswarm.rules.model import (
    COMPARISONS,
    Action,
    BehaviourChange,
    Precondition,
    Rule,
    StateChange,
    Term,
)

REGISTER = "STATE"
"""The internal state that holds the machine's."""
_COUNTS = {CONDITIONS[number].term: number for number in NEIGHBOUR_COUNTS}
"""Numbers of the neighbour counts, by the names that rules have for them."""


@dataclass(frozen=True)
class Doing:
    """What rules change of a robot.

    Attributes:
        behaviour: What it executes.
        state: The value of STATE, empty if there is none.
    """

    behaviour: Term
    state: str = ""


def neighbour_count(precondition: Precondition) -> Condition | None:
    """The condition that a precondition on neighbours is true by; None for any other one.

    Raises:
        ValueError: AutoMoDe has none with these arguments.
    """
    term = precondition.percept
    if term.name not in _COUNTS:
        return None
    number = _COUNTS[term.name]
    if precondition.value is not (precondition.comparison == "=="):  # one is the other one inverted
        (number,) = NEIGHBOUR_COUNTS - {number}
    return Condition(number, *map(float, term.arguments))


def after_rules(
    rules: tuple[Rule, ...], before: Doing, chance: Callable[[Precondition], float]
) -> Mapping[Doing, float]:
    """The distribution over what a robot does after all rules.

    Args:
        rules: In order; each is active by chance, each of its actions is drawn on its own.
        before: What it did; rules see STATE as it was then.
        chance: The probability that a precondition on floor or neighbours holds, drawn for each
            rule on its own.
    """
    found: Mapping[Doing, float] = {before: 1.0}
    for rule in rules:
        active = 1.0
        for each in rule.preconditions:
            active *= float(_holds(each, before)) if each.percept.name == REGISTER else chance(each)
        if active:
            found = _mixed(found, rule, active)
    return found


def _holds(precondition: Precondition, before: Doing) -> bool:
    return COMPARISONS[precondition.comparison](before.state, precondition.value)


def _mixed(found: Mapping[Doing, float], rule: Rule, active: float) -> Mapping[Doing, float]:
    """A rule that is active with a probability, where its behaviours are executed."""
    mixed: dict[Doing, float] = defaultdict(float)
    for doing, p in found.items():
        if rule.behaviours and doing.behaviour not in rule.behaviours:
            mixed[doing] += p
            continue
        mixed[doing] += p * (1.0 - active)
        for then, share in _acted(doing, rule.actions):
            mixed[then] += p * active * share
    return {doing: p for doing, p in mixed.items() if p}


def _acted(doing: Doing, actions: tuple[Action, ...]) -> Iterator[tuple[Doing, float]]:
    if not actions:
        yield doing, 1.0
        return
    action, later = actions[0], actions[1:]
    for then, p in ((_done(doing, action), action.p), (doing, 1.0 - action.p)):
        if p:
            yield from ((each, p * share) for each, share in _acted(then, later))


def _done(doing: Doing, action: Action) -> Doing:
    if isinstance(action, BehaviourChange):
        return Doing(action.behaviour, doing.state)
    assert isinstance(action, StateChange)
    return Doing(doing.behaviour, str(action.value))
