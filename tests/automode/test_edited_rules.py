"""Rules of a machine, edited at random: what is written back does the same, or it is told."""

from collections import defaultdict
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.automode import START, from_rules, next_situations, read_machines, to_rules
from geswarm.automode.drawing import REGISTER, Doing, after_rules, neighbour_count
from geswarm.automode.modules import FLOORS
from geswarm.rules import RuleSetError, parse_text
from geswarm.rules.model import (
    COMPARISONS,
    BehaviourChange,
    Precondition,
    Rule,
    StateChange,
    Term,
)
from tests.automode.machines import AAC, behaviours, machines, vocabulary

STEPS = 5
BY_HAND = (
    "rule if STATE == enter0 do p = 1, EXPLORATION(5) do p = 1, STATE = in0 "
    "rule if STATE == in0 and FLOOR == black do p = 0.5, STATE = {} "
    "rule if STATE == enter1 do p = 1, STOP do p = 1, STATE = in1"
)


def by_rules(rules, initial, readings):
    """How probable each sequence of behaviours is."""
    ways = {((), Doing(*initial)): 1.0}
    for floor, heard in readings:

        def chance(precondition, floor=floor, heard=heard):
            count = neighbour_count(precondition)
            if count is None:
                return float(COMPARISONS[precondition.comparison](floor, precondition.value))
            return count.chance(floor, heard)

        found = defaultdict(float)
        for (path, doing), p in ways.items():
            for then, share in after_rules(rules, doing, chance).items():
                found[(*path, str(then.behaviour)), then] += p * share
        ways = found
    return sequences(ways)


def by_machine(machine, readings):
    """The same of a machine: it acts, and then looks where to go."""
    ways = {((), START): 1.0}
    for floor, heard in readings:
        found = defaultdict(float)
        for (path, here), p in ways.items():
            acts = str(machine.states[here.state].behaviour.term)
            for then, share in next_situations(
                machine, here, lambda each, f=floor, n=heard: each.chance(f, n)
            ).items():
                found[(*path, acts), then] += p * float(share)
        ways = found
    return sequences(ways)


def sequences(ways):
    found = defaultdict(float)
    for (path, _), p in ways.items():
        found[path] += p
    return found


def with_action(rule, at, action):
    actions = list(rule.actions)
    actions[at] = action
    return replace(rule, actions=tuple(actions))


def edits(rule_set, values):
    """One rule with one piece that is another one, or that is taken out or added."""
    values = st.sampled_from(values)
    changes = [
        values.map(lambda value: StateChange(0.5, REGISTER, value)),
        st.sampled_from([0.25, 1.0]).flatmap(
            lambda p: values.map(lambda value: StateChange(p, REGISTER, value))
        ),
        behaviours.map(lambda each: BehaviourChange(1.0, each.term)),
    ]
    actions = st.one_of(*changes)

    def edited(rule):
        at = st.integers(0, len(rule.actions) - 1)
        return st.one_of(
            st.tuples(at, actions).map(lambda found: with_action(rule, *found)),
            actions.map(lambda each: replace(rule, actions=(*rule.actions, each))),
            values.map(
                lambda value: replace(
                    rule,
                    preconditions=(Precondition(Term(REGISTER), value), *rule.preconditions[1:]),
                )
            ),
            st.just(Rule()),
        )

    rules = rule_set.rules
    return st.integers(0, len(rules) - 1).flatmap(
        lambda at: edited(rules[at]).map(
            lambda rule: replace(rule_set, rules=(*rules[:at], rule, *rules[at + 1 :]), comment="")
        )
    )


@settings(max_examples=150)
@given(st.data())
def test_what_is_written_back_does_the_same(data):
    machine = data.draw(st.one_of(st.just(*read_machines(AAC)), machines(most=3)))
    conversion = to_rules(machine)
    values = conversion.values or ("enter0", "in0")
    words = vocabulary(values)
    rule_set = data.draw(edits(conversion.rule_set, values))
    try:
        found = from_rules(rule_set, words)
    except RuleSetError:
        return
    if found.departures:
        return
    reading = st.tuples(st.sampled_from(FLOORS), st.integers(0, 6))
    readings = data.draw(st.lists(reading, min_size=STEPS, max_size=STEPS))
    initial = (Term(words.initial_behaviour), values[0])
    wanted = by_rules(rule_set.active_rules, initial, readings)
    given_back = by_machine(found.machine, readings)
    for path in wanted.keys() | given_back.keys():
        assert wanted[path] == pytest.approx(given_back[path], abs=1e-9)


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ("enter1", None),
        ("in0", None),
        ("in1", "got in1"),
        ("enter0", "got enter0"),
    ],
)
def test_a_state_is_entered_where_its_behaviour_starts(value, problem):
    words = vocabulary(("enter0", "in0", "enter1", "in1"))
    rule_set = parse_text(BY_HAND.format(value), "", words)
    if problem is None:
        assert from_rules(rule_set, words).departures == ()
        return
    with pytest.raises(RuleSetError, match=problem):
        from_rules(rule_set, words)


def test_state_that_is_only_read_is_state():
    words = vocabulary(("enter0", "in0"))
    with pytest.raises(RuleSetError, match="expected enter0 to start one behaviour"):
        from_rules(parse_text("rule if STATE == enter0 do p = 1, STOP", "", words), words)
