"""Terms with arguments, compared readings, counters, colours: a vocabulary that has them all."""

from collections import defaultdict
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import (
    BehaviourChange,
    ControlTable,
    Precondition,
    Rule,
    RuleSet,
    RuleSetError,
    StateChange,
    StateMachine,
    Term,
    check,
    describe_rule,
    first_difference,
    format_json,
    format_text,
    format_yaml,
    parse_json,
    parse_text,
    parse_yaml,
    same_behaviour,
    simplify,
)
from geswarm.rules.arguments import Choice, Number, Whole
from geswarm.rules.declarations import BehaviourName, InternalStateName, PreconditionName, Reading
from geswarm.rules.vocabulary import Vocabulary

COLOURS = ("red", "green", "blue")
GATHERING = Vocabulary(
    name="gathering",
    readings=(
        Reading("neighbours", tuple(range(8))),
        Reading("floor", ("grey", "black", "white")),
    ),
    preconditions=(
        PreconditionName(
            "IS_CLOSE_TO",
            "close to at least {k} robots",
            "close to fewer than {k} robots",
            "neighbours",
            (Whole("k", 1, 7, "robots"),),
            truth=lambda near, k: near >= k,
        ),
        PreconditionName(
            "NEIGHBOURS", "with {comparison} {value} neighbours", reading="neighbours"
        ),
        PreconditionName("FLOOR", "on {value}", "on a floor that is not {value}", "floor"),
        PreconditionName("SEES_OBSTACLE", "seeing an obstacle", "seeing no obstacle"),
    ),
    behaviours=(
        BehaviourName("RANDOM_WALK", "walking at random", "start walking at random", restarts=True),
        BehaviourName("STOP", "standing still", "stop"),
        BehaviourName(
            "ATTRACTION",
            "going to others with gain {gain}",
            "go to others with gain {gain}",
            arguments=(Number("gain", 1, 5, 0.5),),
        ),
        BehaviourName(
            "FOLLOW_COLOR", "going to {c}", "go to {c}", arguments=(Choice("c", COLOURS),)
        ),
    ),
    internal_states=(
        InternalStateName("LED", "light up {value}", values=("off", "red"), initially="off"),
        InternalStateName(
            "HUNGER", "set HUNGER to {value}", values=(0, 1, 2), initially=0, readable=True
        ),
        InternalStateName("SIGNAL", "signal", "be silent", momentary=True),
    ),
    probabilities=(0.1, 1.0),
    initial_behaviour="RANDOM_WALK",
)
TEXT = """
name "All of it"

# Together
rule
  if IS_CLOSE_TO(3) == true and NEIGHBOURS < 6 and FLOOR != white
  while RANDOM_WALK or ATTRACTION(2.5)
  do p = 0.5, FOLLOW_COLOR(red)
  do p = 1, LED = red
  do p = 0.1, HUNGER += 2

rule
  if HUNGER >= 2
  do p = 1, STOP
  do p = 1, HUNGER -= 1
"""
EXAMPLE = parse_text(TEXT, vocabulary=GATHERING)

conditions = st.one_of(
    st.builds(
        Precondition, st.integers(1, 7).map(lambda k: Term("IS_CLOSE_TO", (k,))), st.booleans()
    ),
    st.builds(
        Precondition,
        st.just(Term("NEIGHBOURS")),
        st.integers(0, 7),
        st.sampled_from(["==", "!=", ">=", "<=", ">", "<"]),
    ),
    st.builds(
        Precondition,
        st.just(Term("FLOOR")),
        st.sampled_from(["grey", "black", "white"]),
        st.sampled_from(["==", "!="]),
    ),
    st.builds(Precondition, st.just(Term("SEES_OBSTACLE")), st.booleans()),
    st.builds(
        Precondition, st.just(Term("HUNGER")), st.integers(0, 2), st.sampled_from([">=", "=="])
    ),
)
behaviours = st.one_of(
    st.sampled_from([Term("RANDOM_WALK"), Term("STOP")]),
    st.sampled_from([1, 2.5, 5]).map(lambda gain: Term("ATTRACTION", (gain,))),
    st.sampled_from(COLOURS).map(lambda colour: Term("FOLLOW_COLOR", (colour,))),
)
probabilities = st.sampled_from([0.1, 0.5, 1.0])
actions = st.one_of(
    st.builds(BehaviourChange, probabilities, behaviours),
    st.builds(StateChange, probabilities, st.just("LED"), st.sampled_from(["off", "red"])),
    st.builds(
        StateChange,
        probabilities,
        st.just("HUNGER"),
        st.integers(0, 2),
        st.sampled_from(["=", "+=", "-="]),
    ),
    st.builds(StateChange, probabilities, st.just("SIGNAL"), st.booleans()),
)
rules = st.builds(
    Rule,
    st.lists(conditions, max_size=2).map(tuple),
    st.lists(behaviours, max_size=2).map(tuple),
    st.lists(actions, min_size=1, max_size=2).map(tuple),
)
rule_sets = st.builds(RuleSet, st.lists(rules, min_size=1, max_size=3).map(tuple))


@pytest.mark.parametrize(
    ("write", "read"),
    [(format_text, parse_text), (format_yaml, parse_yaml), (format_json, parse_json)],
)
@given(rule_set=rule_sets)
@settings(deadline=None, max_examples=30)
def test_every_form_carries_arguments(write, read, rule_set):
    assert read(write(rule_set), vocabulary=GATHERING) == rule_set


def test_text_is_written_as_it_is_read():
    assert format_text(EXAMPLE).strip() == TEXT.strip()


def test_rules_in_words():
    assert describe_rule(EXAMPLE.rules[0], GATHERING) == (
        "When close to at least 3 robots, with less than 6 neighbours and on a floor that is not "
        "white, while walking at random or going to others with gain 2.5, go to red with "
        "probability 0.5 per step (about every 0.2 s), and light up red, and add 2 to HUNGER with "
        "probability 0.1 per step (about every 1.0 s)."
    )
    assert describe_rule(EXAMPLE.rules[1], GATHERING) == (
        "When with HUNGER at least 2, stop and take 1 from HUNGER."
    )


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("if IS_CLOSE_TO == true", "expected IS_CLOSE_TO(k), got IS_CLOSE_TO"),
        ("if IS_CLOSE_TO(9) == true", "k: expected a whole number from 1 to 7 robots, got 9"),
        ("if IS_CLOSE_TO(1, 2) == true", "expected IS_CLOSE_TO(k), got IS_CLOSE_TO(1, 2)"),
        ("if IS_CLOSE_TO(2) >= true", "expected == or != after IS_CLOSE_TO, got '>='"),
        ("if NEIGHBOURS >= 8", "expected a whole number from 0 to 7, got 8"),
        ("if NEIGHBOURS == true", "expected a whole number from 0 to 7, got True"),
        ("if FLOOR == red", "expected grey or black or white, got 'red'"),
        ("if LED == red", "unknown precondition 'LED'"),
        ("while STOP(1)", "expected no arguments, got STOP(1)"),
        ("while ATTRACTION(7)", "gain: expected a number from 1 to 5, got 7"),
        ("while FOLLOW_COLOR(pink)", "c: expected red or green or blue, got 'pink'"),
        ("do p = 1, LED = pink", "expected off or red, got 'pink'"),
        ("do p = 1, LED += 1", "expected = after LED, got '+='"),
        ("do p = 1, HUNGER += 9", "expected a whole number from 0 to 2, got 9"),
        ("do p = 1, HUNGER", "HUNGER is an internal state: write HUNGER = 2 or = 1 or = 0"),
    ],
)
def test_what_is_wrong_is_named(line, message):
    with pytest.raises(RuleSetError) as caught:
        parse_text(
            f"rule {line} {'' if line.startswith('do') else 'do p = 1, STOP'}", "", GATHERING
        )
    (finding,) = caught.value.findings
    assert message in finding.message


def enumerated(rule_set, sensed, behaviour, states):
    """{(behaviour, states, restarted): probability} of a step, draw by draw."""
    found = defaultdict(Fraction)
    before = {**sensed, **states}

    def holds(entry):
        value = before[GATHERING.percepts[entry.percept.name].reading or entry.percept.name]
        if entry.percept.name == "IS_CLOSE_TO":
            value = value >= entry.percept.arguments[0]
        ways = {
            "==": value == entry.value,
            "!=": value != entry.value,
            ">=": value is True
            or value is False
            or not isinstance(value, int)
            or value >= entry.value,
            "<=": not isinstance(value, int) or value <= entry.value,
            ">": not isinstance(value, int) or value > entry.value,
            "<": not isinstance(value, int) or value < entry.value,
        }
        return ways[entry.comparison]

    def go(todo, now, states, restarted, p):
        if not todo:
            found[now, tuple(states.items()), restarted] += p
            return
        action, *rest = todo
        if isinstance(action, Rule):
            active = all(map(holds, action.preconditions))
            active = active and (not action.behaviours or now in action.behaviours)
            go([*action.actions, *rest] if active else rest, now, states, restarted, p)
            return
        chance = Fraction(action.p)
        if chance < 1:
            go(rest, now, states, restarted, p * (1 - chance))
        if isinstance(action, BehaviourChange):
            fresh = action.behaviour.name == "RANDOM_WALK" if action.behaviour != now else restarted
            go(rest, action.behaviour, states, fresh, p * chance)
            return
        value = action.value
        if action.operation != "=":
            by = value if action.operation == "+=" else -value
            value = min(2, max(0, states[action.state] + by))
        go(rest, now, {**states, action.state: value}, restarted, p * chance)

    go(list(rule_set.rules), behaviour, states, False, Fraction(1))
    return found


@given(rule_set=rule_sets, data=st.data())
@settings(deadline=None, max_examples=30)
def test_the_control_table_is_exact(rule_set, data):
    table = ControlTable.compile(rule_set, GATHERING)
    space = table.space
    sensed = {
        "neighbours": data.draw(st.integers(0, 7)),
        "floor": data.draw(st.sampled_from(["grey", "black", "white"])),
        "SEES_OBSTACLE": data.draw(st.booleans()),
    }
    start = data.draw(st.integers(0, space.states - 1))
    names = [entry.name for entry in space.internal_states]
    states = dict(zip(names, space.state_values[space.kept[start]], strict=True))
    own = {"HUNGER": 0, **states}
    behaviour = data.draw(st.integers(0, len(space.behaviours) - 1))
    percepts = space.percept({**sensed, **own})
    row = table.probabilities[space.situation(percepts, behaviour, space.kept[start])]
    expected = np.zeros(space.outcomes)
    now = space.behaviours[behaviour]
    for (after, values, restarted), p in enumerated(
        rule_set, {**sensed, **own}, now, states
    ).items():
        number = space.state_values.index(tuple(value for _, value in values))
        expected[space.outcome(space.behaviours.index(after), number, restarted)] += float(p)
    np.testing.assert_allclose(row, expected, atol=1e-12)


@given(rule_sets)
@settings(deadline=None, max_examples=10)
def test_all_that_reads_control_tables_takes_any_vocabulary(rule_set):
    assert same_behaviour(rule_set, rule_set, GATHERING)
    shorter = simplify(rule_set, GATHERING)
    assert same_behaviour(rule_set, shorter.rule_set, GATHERING)
    assert all(finding.severity != "error" for finding in check(rule_set, GATHERING))
    machine = StateMachine.of(rule_set, GATHERING)
    assert sum(state.initial for state in machine.states) == 1
    for transition in machine.transitions:
        assert machine.describe(transition)


def test_the_difference_and_the_machine_speak_of_thresholds_and_counters():
    one = parse_text("rule if NEIGHBOURS >= 3 do p = 0.5, STOP", vocabulary=GATHERING)
    other = parse_text("rule if NEIGHBOURS >= 4 do p = 0.5, STOP", vocabulary=GATHERING)
    assert str(first_difference(one, other, GATHERING)) == (
        "when with at least 3 neighbours and with less than 4 neighbours, while walking at random: "
        "keep walking at random (p = 0.5), stop (p = 0.5) - against keep walking at random (p = 1)"
    )
    counting = parse_text(
        "rule if HUNGER < 2 do p = 0.1, HUNGER += 1 rule if HUNGER >= 2 do p = 1, STOP",
        vocabulary=GATHERING,
    )
    machine = StateMachine.of(counting, GATHERING)
    assert [state.label for state in machine.states] == [
        "RANDOM_WALK, HUNGER = 0",
        "RANDOM_WALK, HUNGER = 1",
        "RANDOM_WALK, HUNGER = 2",
        "STOP, HUNGER = 2",
    ]


def test_two_thresholds_can_contradict_each_other():
    rule_set = parse_text(
        "rule if NEIGHBOURS >= 5 and IS_CLOSE_TO(3) == false do p = 1, STOP", vocabulary=GATHERING
    )
    assert next(str(finding) for finding in check(rule_set, GATHERING)) == (
        "rule 1, precondition 2: IS_CLOSE_TO(3) == false and NEIGHBOURS >= 5 are never true "
        "together: this rule never fires"
    )
