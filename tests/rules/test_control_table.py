import itertools

import numpy as np
import pytest
from hypothesis import given, settings

from geswarm.rules import (
    FORAGING,
    BehaviourChange,
    ControlTable,
    Rule,
    RuleSet,
    RuleSetError,
    Space,
    StateChange,
    load_preset,
)
from tests.rules.oracle import outcomes
from tests.strategies import any_probabilities, plain_rule_sets

SPACE = Space.of(FORAGING)


def situations():
    for bits, behaviour, state in itertools.product(
        range(SPACE.percepts), FORAGING.behaviour_index, range(SPACE.states)
    ):
        percepts = {
            name: bool(bits >> bit & 1) for name, bit in FORAGING.precondition_index.items()
        }
        states = {name for name, bit in FORAGING.state_index.items() if state >> bit & 1}
        row = SPACE.situation(bits, FORAGING.behaviour_index[behaviour], state)
        yield row, percepts, behaviour, states


def expected_row(rule_set, percepts, behaviour, states):
    row = np.zeros(SPACE.outcomes)
    for (after, true_states, restarted), p in outcomes(
        rule_set, percepts, behaviour, states
    ).items():
        bits = sum(1 << FORAGING.state_index[name] for name in true_states)
        row[SPACE.outcome(FORAGING.behaviour_index[after], bits, restarted)] = float(p)
    return row


def assert_equals_oracle(rule_set):
    table = ControlTable.compile(rule_set)
    assert table.probabilities.shape == (SPACE.situations, SPACE.outcomes)
    for row, percepts, behaviour, states in situations():
        expected = expected_row(rule_set, percepts, behaviour, states)
        np.testing.assert_allclose(table.probabilities[row], expected, atol=1e-14)


@pytest.mark.parametrize("name", ["hand-coded", "evo8"])
def test_presets_equal_the_oracle(name):
    assert_equals_oracle(load_preset(name))


@settings(max_examples=25, deadline=None)
@given(plain_rule_sets(probabilities=any_probabilities))
def test_any_rule_set_equals_the_oracle(rule_set):
    assert_equals_oracle(rule_set)


def test_hand_coded_robot_in_the_nest_drops_its_object():
    table = ControlTable.compile(load_preset("hand-coded"))
    in_nest_with_object = 0b101
    row = SPACE.situation(in_nest_with_object, FORAGING.behaviour_index["ANTI-PHOTOTAXIS"], 0b01)
    walking_and_dropping = SPACE.outcome(
        FORAGING.behaviour_index["RANDOM_WALK"], 0b11, restart=True
    )
    assert table.probabilities[row, walking_and_dropping] == 1.0


def test_a_switched_off_rule_does_nothing():
    rule = Rule(actions=(BehaviourChange(1.0, "PHOTOTAXIS"),), enabled=False)
    with_it, without = ControlTable.compile(RuleSet((rule,))), ControlTable.compile(RuleSet())
    np.testing.assert_array_equal(with_it.probabilities, without.probabilities)


def test_unknown_names_are_refused_with_their_place():
    rules = (
        Rule(actions=(BehaviourChange(0.5, "FOTOTAXIS"), StateChange(1.5, "WANT_OBJECT", True))),
    )
    with pytest.raises(RuleSetError) as error:
        ControlTable.compile(RuleSet(rules))
    assert str(error.value).split("\n") == [
        "rule 1, action 1: unknown behaviour 'FOTOTAXIS'; did you mean PHOTOTAXIS?",
        "rule 1, action 2: probability must be between 0 and 1, got 1.5",
    ]
