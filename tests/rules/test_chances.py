"""Preconditions that hold by chance: exact in every form of a rule set."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import (
    FORAGING,
    ControlTable,
    Precondition,
    RuleSet,
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
from geswarm.rules.arguments import Number, Whole
from geswarm.rules.declarations import PreconditionName, Reading
from geswarm.rules.reachability import Trace
from geswarm.rules.vocabulary import Vocabulary
from tests import strategies
from tests.rules.oracle import outcomes

HEARD = Reading("heard", tuple(range(5)))


def crowded(heard, xi, eta):
    return 1 / (1 + np.exp(eta * (xi - heard)))


MEETING = Vocabulary(
    (
        *FORAGING.preconditions,
        PreconditionName("HEARD", "hearing {comparison} {value} robots", reading="heard"),
        PreconditionName(
            "CROWDED",
            "with many robots near (xi {xi}, eta {eta})",
            "with few robots near (xi {xi}, eta {eta})",
            "heard",
            (Whole("xi", 1, 4), Number("eta", 0, 20, 0.5)),
            chance=crowded,
        ),
    ),
    FORAGING.behaviours,
    FORAGING.internal_states,
    FORAGING.probabilities,
    FORAGING.initial_behaviour,
    FORAGING.apart,
    FORAGING.objects,
    (HEARD,),
    name="meeting",
)


def rules_of(text):
    return parse_text(text, vocabulary=MEETING)


counts = st.builds(
    lambda xi, eta, value: Precondition(Term("CROWDED", (xi, eta)), value),
    st.integers(1, 4),
    st.sampled_from([0, 0.5, 2.5, 20]),
    st.booleans(),
)
rules = st.builds(
    lambda rule, drawn: replace(rule, preconditions=(*rule.preconditions, *drawn)),
    strategies.rules(st.sampled_from([0.1, 0.75, 1.0])),
    st.lists(counts, max_size=2),
)
rule_sets = st.builds(RuleSet, st.lists(rules, min_size=1, max_size=3).map(tuple))


def percepts_of(rule_set, heard, sensed):
    """As the oracle takes them: a Fraction for the chance that a percept is true."""
    percepts = dict(zip(FORAGING.precondition_index, sensed, strict=True))
    for rule in rule_set.rules:
        for entry in rule.preconditions:
            if entry.percept.arguments:
                chance = crowded(heard, *entry.percept.arguments)
                percepts[str(entry.percept)] = Fraction(float(chance))
    return percepts


def row_of(table, heard, sensed, behaviour, want):
    """{(behaviour, true states, restart): probability} of one situation, from a table."""
    space = table.space
    values = dict(zip(FORAGING.precondition_index, sensed, strict=True)) | {"heard": heard}
    state = space.state_values.index((want, False))
    row = table.probabilities[
        space.situation(space.percept(values), space.behaviours.index(Term(behaviour)), state)
    ]
    found = {}
    for outcome in np.flatnonzero(row).tolist():
        after, states, restart = space.describe_outcome(outcome)
        true = frozenset(
            entry.name
            for entry, value in zip(space.internal_states, space.state_values[states], strict=True)
            if value
        )
        found[space.behaviours[after].name, true, restart] = row[outcome]
    return found


@settings(max_examples=60, deadline=None)
@given(rule_sets, st.integers(0, 4), st.tuples(*[st.booleans()] * 3), st.booleans(), st.data())
def test_tables_equal_the_oracle(rule_set, heard, sensed, want, data):
    table = ControlTable.compile(rule_set, MEETING)
    started = [str(each) for each in table.space.behaviours]
    behaviour = data.draw(st.sampled_from(started))
    found = row_of(table, heard, sensed, behaviour, want)
    percepts = percepts_of(rule_set, heard, sensed)
    wanted = outcomes(rule_set, percepts, behaviour, {"WANT_OBJECT"} if want else set())
    for outcome in found.keys() | wanted.keys():
        assert found.get(outcome, 0) == pytest.approx(float(wanted.get(outcome, 0)), abs=1e-14)


def said_probability(entry, percepts, space):
    """What a transition says of a percept number; None if it only says between what it lies."""
    if not entry.chances.varies:
        return entry.probability
    for drawn in space.drawn:
        for said in (drawn.precondition, drawn.opposite):
            name = str(said.percept) if said.value else f"not {said.percept}"
            if name == entry.chances.of:
                return entry.chances.factor * space.chance(said)[percepts]
    return None


@settings(max_examples=30, deadline=None)
@given(rule_sets)
def test_machines_say_how_probable_each_transition_is(rule_set):
    machine, trace = StateMachine.of(rule_set, MEETING), Trace.of(rule_set, MEETING)
    space = machine.space
    columns = [state.column for state in machine.states]
    for percepts, column in np.argwhere(trace.reachable).tolist():
        found = np.zeros(len(columns))
        for outcome, p in enumerate(trace.decided[percepts, column].tolist()):
            after, states, _ = space.describe_outcome(outcome)
            if p:
                found[columns.index(after * space.states + space.kept[states])] += p
        truths = map(bool, space.truths[percepts])
        sensed = dict(zip([atom.name for atom in space.atoms], truths, strict=True))
        source = columns.index(column)
        for target in set(range(len(columns))) - {source}:
            entries = [
                entry
                for entry in machine.between.get((source, target), ())
                if entry.condition.holds(sensed)
            ]
            said = [said_probability(entry, percepts, space) for entry in entries]
            if None in said:
                assert found[target] >= sum(e.chances.least for e in entries) - 1e-11
                assert found[target] <= sum(e.chances.most for e in entries) + 1e-11
            else:
                assert sum(said) == pytest.approx(found[target], abs=1e-10)


SOME = """
rule
  if CROWDED(2, 1.5) == false
  while PHOTOTAXIS
  do p = 1, RANDOM_WALK

rule
  if CROWDED(2, 1.5) == true
  while RANDOM_WALK
  do p = 0.5, PHOTOTAXIS
"""


def test_what_people_read():
    rule_set = rules_of(SOME)
    assert describe_rule(rule_set.rules[1], MEETING) == (
        "When with many robots near (xi 2, eta 1.5), while walking at random, go to the light "
        "with probability 0.5 per step (about every 0.2 s)."
    )
    machine = StateMachine.of(rule_set, MEETING)
    assert [machine.describe(each) for each in machine.transitions] == [
        "PHOTOTAXIS to RANDOM_WALK always: p = 0.0248375 to 0.929986, by chance",
        "RANDOM_WALK to PHOTOTAXIS always: p = 0.5 times the chance of CROWDED(2, 1.5)",
    ]
    assert not any("precondition" in str(each) for each in check(rule_set, MEETING))
    for write, read in (
        (format_text, parse_text), (format_yaml, parse_yaml), (format_json, parse_json),
    ):  # fmt: skip
        assert read(write(rule_set), vocabulary=MEETING) == rule_set


def test_what_is_equal():
    one = rules_of(SOME)
    other = rules_of(
        """
        rule
          if CROWDED(2, 1.5) != true
          while PHOTOTAXIS
          do p = 1, RANDOM_WALK
        rule
          if CROWDED(2, 1.5) != false
          while RANDOM_WALK
          do p = 0.5, PHOTOTAXIS
        """
    )
    assert same_behaviour(one, other, MEETING)
    steeper = rules_of(SOME.replace("1.5", "2"))
    difference = first_difference(one, steeper, MEETING)
    assert difference.situation == (
        "when not holding an object, with many robots near (xi 2, eta 1.5) by a chance of "
        "0.0474259 and with many robots near (xi 2, eta 2) by a chance of 0.0179862, while going "
        "to the light, with WANT_OBJECT true"
    )
    c = 0.0474259
    assert max(difference.first.values()) == pytest.approx((1 - c) * (1 - c / 2), abs=1e-6)


def test_each_precondition_is_drawn_on_its_own():
    twice = rules_of(
        """
        rule
          if CROWDED(2, 1.5) == true and CROWDED(2, 1.5) == true
          do p = 1, PHOTOTAXIS
        rule
          if CROWDED(2, 1.5) == true and CROWDED(2, 1.5) == false
          do p = 1, ANTI-PHOTOTAXIS
        """
    )
    assert not [each for each in check(twice, MEETING) if each.place.rule]
    assert simplify(twice, MEETING).removed == ()
    found = row_of(ControlTable.compile(twice, MEETING), 3, (False,) * 3, "PHOTOTAXIS", True)
    c = crowded(3, 2, 1.5)
    assert sum(p for key, p in found.items() if key[0] == "ANTI-PHOTOTAXIS") == pytest.approx(
        c * (1 - c)
    )


def test_a_chance_is_from_0_to_1():
    *others, word = MEETING.preconditions
    wrong = replace(MEETING, preconditions=(*others, replace(word, chance=max)))
    with pytest.raises(ValueError, match=r"CROWDED\(2, 1.5\): expected a chance from 0 to 1"):
        ControlTable.compile(rules_of(SOME), wrong)
