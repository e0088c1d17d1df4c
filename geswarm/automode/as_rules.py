"""Machines as rule sets that make robots do exactly the same; or else, what differs.

A robot with rules decides and acts in the same step, a machine acts and then decides for the next
one. So the rules keep the machine's state in the internal state STATE, which they read as it was
when the step began: `enter2` in the first step in state 2, `in2` in all others. A rule for each
`enter` starts the behaviour; rules for each `in` draw what comes next. The last rule that does
something counts, which is how the probabilities are worked out.

A neighbour count is a precondition that is true by chance, drawn for each rule on its own:
`CROWDED(xi, eta) == true`, `ALONE(xi, eta) == true`. Where a state has several of them and their
order matters, that is drawn a step ahead: `in2a`, `in2b`. Where STATE would have more than
MOST_VALUES it is not, and what differs is told.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from geswarm.automode.choices import Choice, choices_of, orders_of, outcome
from geswarm.automode.departures import Departure, departures_of
from geswarm.automode.drawing import REGISTER
from geswarm.automode.machine import Machine
from geswarm.automode.machine_text import format_machine
from geswarm.automode.modules import Condition
from geswarm.rules.model import (
    Action,
    BehaviourChange,
    Precondition,
    Rule,
    RuleSet,
    StateChange,
    Term,
)

MOST_VALUES = 16
"""Of STATE: control tables grow with their third power."""
COMMENT = "AutoMoDe: "
"""What stands before the machine's text in the comment of its rule set."""
_EXPLORATION = 0
_AT_REST = Term("STOP")


@dataclass(frozen=True)
class Conversion:
    """What became of a machine.

    Attributes:
        rule_set: The rules.
        values: What STATE can be, the first at the start; empty if the rules need none.
        departures: Where they do something else, the greatest difference for each state and floor.
    """

    rule_set: RuleSet
    values: tuple[str, ...]
    departures: tuple[Departure, ...]

    @property
    def exact(self) -> bool:
        """Whether they make robots do exactly the same."""
        return not self.departures

    @property
    def register(self) -> str:
        """How a scenario declares STATE: `STATE(enter0, in0, enter1, in1)`; empty for none."""
        return f"{REGISTER}({', '.join(self.values)})" if self.values else ""


@dataclass(frozen=True)
class _Inside:
    """A value of STATE that stands for a later step in a state.

    Attributes:
        value: `in2`, or `in2a` for one of several orders of the neighbour counts.
        choices: What is drawn there.
    """

    value: str
    choices: tuple[Choice, ...]


def to_rules(machine: Machine, name: str = "", scenario: str = "") -> Conversion:
    """Write a machine as rules.

    Args:
        machine: What to write.
        name: What the rule set is called.
        scenario: In whose words it is written.
    """
    insides = _insides(machine)
    rules: list[Rule] = []
    for number, ways in enumerate(insides):
        rules.append(_entering(machine, number, [each.value for each in ways]))
        rules += (rule for way in ways for rule in _staying(ways, way))
    comment = f"{COMMENT}{format_machine(machine)}"
    rule_set = RuleSet(tuple(rules), name, comment, scenario=scenario)
    departures = (
        departure
        for number, ways in enumerate(insides)
        for departure in departures_of(machine, number, _does(number, ways))
    )
    values = _values(insides) if len(machine.states) > 1 else ()
    return Conversion(rule_set, values, tuple(departures))


def _does(number: int, ways: Sequence[_Inside]) -> Callable[[str, int], Mapping[int, float]]:
    """What the rules do in a state: each of its values of STATE is as probable as the others."""

    def does(floor: str, neighbours: int) -> Mapping[int, float]:
        shares: dict[int, float] = defaultdict(float)
        for way in ways:
            for state, p in outcome(way.choices, number, floor, neighbours).items():
                shares[state] += p / len(ways)
        return shares

    return does


def _values(insides: Sequence[Sequence[_Inside]]) -> tuple[str, ...]:
    return tuple(
        value
        for number, ways in enumerate(insides)
        for value in (f"enter{number}", *(each.value for each in ways))
    )


def _insides(machine: Machine) -> list[list[_Inside]]:
    """For each state, what STATE can be there; one value each if there would be too many."""
    orders = [orders_of(state) for state in machine.states]
    if sum(1 + len(each) for each in orders) > MOST_VALUES:
        orders = [each[:1] for each in orders]
    return [
        [
            _Inside(
                f"in{number}{_letter(at) if len(ways) > 1 else ''}",
                tuple(choices_of(state, order)),
            )
            for at, order in enumerate(ways)
        ]
        for number, (state, ways) in enumerate(zip(machine.states, orders, strict=True))
    ]


def _letter(at: int) -> str:
    return chr(ord("a") + at)


def _entering(machine: Machine, number: int, values: Sequence[str]) -> Rule:
    """The rule that starts the behaviour of a state."""
    behaviour = machine.states[number].behaviour
    start = BehaviourChange(1.0, behaviour.term)
    comment = f"State {number}: {behaviour}"
    if len(machine.states) == 1:
        return Rule(actions=(start,), comment=comment)
    actions: tuple[Action, ...] = (start, *_any_of(values))
    if _begins_afresh(machine, number):  # which rules do where it was another behaviour before
        actions = (BehaviourChange(1.0, _AT_REST), *actions)
    return Rule((_at(f"enter{number}"),), (), actions, comment)


def _begins_afresh(machine: Machine, number: int) -> bool:
    """Whether a state can be entered from one with the same exploration, which then begins anew."""
    behaviour = machine.states[number].behaviour
    return behaviour.number == _EXPLORATION and any(
        each.target == number and state.behaviour == behaviour
        for state in machine.states
        for each in state.transitions
    )


def _staying(ways: Sequence[_Inside], here: _Inside) -> Iterator[Rule]:
    """The rules for a value of STATE: the order of the next step, then what comes next."""
    if len(ways) > 1:
        yield Rule((_at(here.value),), (), _any_of([each.value for each in ways]))
    yield from (_drawing(here.value, choice) for choice in here.choices)


def _any_of(values: Sequence[str]) -> tuple[Action, ...]:
    """STATE becomes one of some values, each as probable as the others."""
    return tuple(StateChange(1.0 / k, REGISTER, value) for k, value in enumerate(values, start=1))


def _drawing(value: str, choice: Choice) -> Rule:
    """Draw the next state: each action is drawn on its own and the last one that happens counts."""
    preconditions = [_at(value)]
    if choice.floor:
        preconditions.append(Precondition(Term("FLOOR"), choice.floor))
    if choice.condition:
        preconditions.append(Precondition(_term(choice.condition), True))
    actions: list[Action] = []
    later = 0.0
    for target, share in sorted(choice.shares.items(), reverse=True):
        p = min(1.0, share / (1.0 - later)) if later < 1.0 else 1.0
        actions.insert(0, StateChange(p, REGISTER, f"enter{target}"))
        later += share
    if choice.condition:  # then the state is left for certain, and rounding must not keep it
        actions[0] = StateChange(1.0, REGISTER, f"enter{min(choice.shares)}")
    return Rule(tuple(preconditions), (), tuple(actions))


def _at(value: str) -> Precondition:
    return Precondition(Term(REGISTER), value)


def _term(condition: Condition) -> Term:
    """`CROWDED(3, 2.5)`; of xi, AutoMoDe keeps the whole number alone."""
    assert condition.w is not None
    return Term(condition.module.term, (int(condition.p), float(condition.w)))
