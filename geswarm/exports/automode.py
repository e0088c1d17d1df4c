"""A state machine as an AutoMoDe command line (`--fsm-config`), for what AutoMoDe can express.

Rules over AutoMoDe's own terms (`geswarm.automode`) become the machine that does the same; where
none does, the warnings say what differs. In the words of foraging it is less direct: AutoMoDe's
robots see the colour of the floor and carry nothing. The nest is white and the source black, as in
AutoMoDe's own foraging missions, all else grey. `HAS_OBJECT` is taken as false, and what needs it
true is left out. On each colour, the transitions of a state are drawn in random order until one
happens; the probabilities are those that come to the same as the rules. AutoMoDe looks at a state's
transitions from the second step in it on.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from geswarm.automode import format_controller, from_rules
from geswarm.exports.counterparts import CounterpartError, require_counterparts
from geswarm.rules.elements import format_probability
from geswarm.rules.findings import Finding, Place
from geswarm.rules.model import RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.state_machine import StateMachine, Transition
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_BEHAVIOURS = {"RANDOM_WALK": 0, "PHOTOTAXIS": 2, "ANTI-PHOTOTAXIS": 3}
_RANDOM_WALK_STEPS = 50  # longest turn of AutoMoDe's exploration, the middle of its range
_FLOORS = (
    (0, {"ON_NEST": False, "ON_SOURCE": True, "HAS_OBJECT": False}),
    (1, {"ON_NEST": False, "ON_SOURCE": False, "HAS_OBJECT": False}),
    (2, {"ON_NEST": True, "ON_SOURCE": False, "HAS_OBJECT": False}),
)
_ANY_FLOOR = 5
_OWN = {"EXPLORATION", "FLOOR", "CROWDED", "ALONE"}
"""Terms by which a vocabulary is known to be AutoMoDe's."""
_KNOWN = (*_BEHAVIOURS, *FORAGING.percepts, *FORAGING.state_names)


@dataclass(frozen=True)
class AutoMoDe:
    """A command line, and what of the rule set is not in it.

    Attributes:
        command: Begins with `--fsm-config`.
        warnings: What AutoMoDe cannot express, one sentence each.
    """

    command: str
    warnings: tuple[str, ...]


def to_automode(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> AutoMoDe:
    """Translate a rule set.

    Raises:
        RuleSetError: A name is not in the vocabulary, a probability is outside [0, 1], or there are
            more states or transitions than AutoMoDe has.
        CounterpartError: It mentions a term that has no counterpart.
    """
    if _OWN & (vocabulary.behaviour_names.keys() | vocabulary.percepts.keys()):
        return _of_own_terms(rule_set, vocabulary)
    require_counterparts(rule_set, "AutoMoDe", _KNOWN)
    if vocabulary.initial_behaviour not in _BEHAVIOURS:
        message = f"{vocabulary.initial_behaviour} has no counterpart in AutoMoDe"
        raise CounterpartError([Finding(Place(element="initial_behaviour"), message)])
    machine = StateMachine.of(rule_set, vocabulary)
    order = sorted(range(len(machine.states)), key=lambda at: (not machine.states[at].initial, at))
    words = ["--fsm-config", "--nstates", str(len(order))]
    for number, state in enumerate(order):
        words += _state_words(machine, order, number, state)
    return AutoMoDe(" ".join(words), tuple(dict.fromkeys(_warnings(machine))))


def _of_own_terms(rule_set: RuleSet, vocabulary: Vocabulary) -> AutoMoDe:
    """Rules that mention AutoMoDe's modules by name."""
    require_known_names(rule_set, vocabulary)
    expressed = from_rules(rule_set, vocabulary)
    warnings = tuple(f"not the same in {each}" for each in expressed.departures)
    return AutoMoDe(format_controller(expressed.machine), warnings)


def format_automode(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """The command line alone, on one line; errors as for `to_automode`."""
    return to_automode(rule_set, vocabulary).command + "\n"


def _state_words(
    machine: StateMachine, order: Sequence[int], number: int, state: int
) -> Iterator[str]:
    behaviour = _BEHAVIOURS[machine.states[state].behaviour.name]
    yield from (f"--s{number}", str(behaviour))
    if behaviour == 0:
        yield from (f"--rwm{number}", str(_RANDOM_WALK_STEPS))
    conditions = list(_conditions(machine, order, state))
    if conditions:
        yield from (f"--n{number}", str(len(conditions)))
    for at, (target, condition, p) in enumerate(conditions):
        others = [other for other in order if other != state]
        yield from (f"--n{number}x{at}", str(others.index(target)))
        yield from (f"--c{number}x{at}", str(condition))
        yield from (f"--p{number}x{at}", format_probability(float(f"{p:.6g}")))


def _conditions(
    machine: StateMachine, order: Sequence[int], state: int
) -> Iterator[tuple[int, int, float]]:
    """(target, condition, probability) of everything that can be expressed."""
    drawn: dict[int, dict[int, float]] = defaultdict(dict)
    for floor, percepts in _FLOORS:
        wanted: dict[int, float] = defaultdict(float)
        for transition in machine.transitions_from(state):
            if transition.target != state and transition.condition.holds(percepts):
                wanted[transition.target] += transition.probability
        for target, p in _drawn_in_random_order(wanted).items():
            drawn[target][floor] = p
    for target in sorted(drawn, key=order.index):
        floors = drawn[target]
        if len(floors) == len(_FLOORS) and len(set(floors.values())) == 1:
            yield target, _ANY_FLOOR, floors[0]
        else:
            yield from ((target, floor, floors[floor]) for floor in sorted(floors))


def _drawn_in_random_order(wanted: dict[int, float]) -> dict[int, float]:
    """Probabilities that come to the wanted ones if two conditions are drawn in random order.

    For two: p1 (1 - p2 / 2) = q1 and p2 (1 - p1 / 2) = q2. Alone a condition is itself; three
    occur only with internal states, which are reported.
    """
    if len(wanted) != 2:
        return dict(wanted)
    (one, q1), (other, q2) = wanted.items()
    lead = 2 - (q1 - q2)
    p2 = (lead - math.sqrt(max(0.0, lead * lead - 8 * q2))) / 2
    return {one: min(1.0, p2 + q1 - q2), other: min(1.0, max(0.0, p2))}


def _warnings(machine: StateMachine) -> Iterator[str]:
    for state in machine.states:
        for name, _ in state.internal:
            yield f"the internal state {name} is not kept: AutoMoDe has none"
    for transition in machine.transitions:
        yield from _transition_warnings(machine, transition)


def _transition_warnings(machine: StateMachine, transition: Transition) -> Iterator[str]:
    what = machine.describe(transition)
    if any(transition.condition.holds(percepts) for _, percepts in _FLOORS):
        if "HAS_OBJECT" in transition.condition.names:
            yield f"conjunction with HAS_OBJECT, which is taken as false: {what}"
    else:
        yield f"left out, because it needs HAS_OBJECT or a zone that cannot be: {what}"
        return
    if transition.source == transition.target:
        yield f"left out, because it is a self-loop: {what}"
    elif transition.effects:
        yield f"without its effect on internal states: {what}"
