"""Control tables against plain enumeration, and the two ways to them against each other."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import FORAGING, ControlTable, Rule, RuleSet, Space, StateChange
from geswarm.sim import load_scenario, parts_of
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.kernels.table import MOST_CLASSES, ROW_BEHAVIOURS
from tests.sim.terms.scenarios import SENSING
from tests.strategies import any_probabilities, plain_rule_sets

PARTS = parts_of(load_scenario("paper"))
misses = st.sampled_from([0.0, 0.08, 1.0])


def drawn(tables, number, code, behaviour, state):
    """Probability of each (behaviour, state, restart) that a table draws."""
    first_code, first_row, _ = tables.begins[number]
    row = first_row + ROW_BEHAVIOURS * int(tables.classes[first_code + code]) + behaviour
    first_slot, bits = divmod(int(tables.rows[row]), 8)
    found = np.zeros((3, 4, 2))
    for slot in range(first_slot, first_slot + (1 << bits)):
        share = int(tables.thresholds[slot]) / 2**32
        for outcome, p in zip(
            tables.outcomes[2 * slot :][:2].tolist(), (share, 1 - share), strict=True
        ):
            after = state & ~(outcome >> 6 & 255) | outcome >> 14 & 255
            found[outcome >> 1 & 31, after, outcome & 1] += p / (1 << bits)
    return found


@given(st.lists(plain_rule_sets(probabilities=any_probabilities), min_size=1, max_size=3), misses)
@settings(max_examples=30, deadline=None)
def test_outcomes_have_the_probabilities_of_the_rules(rule_sets, zone_miss):
    tables = compile_controllers(rule_sets, [zone_miss, 0.0, 0.0], PARTS).tables
    for number, rule_set in enumerate(rule_sets):
        plain = ControlTable.compile(rule_set)  # held against enumeration in tests/rules
        for want, carried, zones, behaviour in itertools.product(
            (0, 1), (0, 1), range(3), range(3)
        ):
            noticed, missed = (
                plain.probabilities[plain.space.situation(4 * carried + z, behaviour, want)]
                for z in (zones, 0)
            )
            expected = ((1 - zone_miss) * noticed + zone_miss * missed).reshape(3, 4, 2)
            found = drawn(tables, number, zones + 4 * carried + 8 * want, behaviour, want)
            np.testing.assert_allclose(found, expected, atol=2.0**-22)
            assert not np.any((found > 0) & (expected == 0))


@given(st.lists(plain_rule_sets(probabilities=any_probabilities), min_size=1, max_size=4), misses)
@settings(max_examples=100, deadline=None)
def test_rules_and_their_dense_table_draw_alike(rule_sets, zone_miss):
    """To the last bit: published results were drawn from the dense one."""
    fails = [zone_miss, 0.0, 0.0]
    by_rules = compile_controllers(rule_sets, fails, PARTS).tables
    dense = [ControlTable.compile(each) for each in rule_sets]
    by_table = compile_controllers(dense, fails, PARTS).tables
    for number, code, behaviour in itertools.product(range(len(rule_sets)), range(16), range(3)):
        state = code >> 3
        rows = []
        for tables in (by_rules, by_table):
            first_code, first_row, _ = tables.begins[number]
            row = first_row + ROW_BEHAVIOURS * int(tables.classes[first_code + code]) + behaviour
            slot, bits = divmod(int(tables.rows[row]), 8)
            outcomes = tables.outcomes[2 * slot :][: 2 << bits].astype(np.int64)
            after = state & ~(outcomes >> 6 & 255) | outcomes >> 14 & 255
            thresholds = tables.thresholds[slot:][: 1 << bits]
            rows.append((thresholds.tolist(), after.tolist(), (outcomes & 63).tolist()))
        assert rows[0] == rows[1]


def test_a_table_does_not_depend_on_what_else_is_compiled():
    rule_sets = [
        RuleSet((Rule(actions=(StateChange(p, "WANT_OBJECT", False),)),)) for p in (0.1, 1)
    ]
    both = compile_controllers(rule_sets, [0.08, 0, 0], PARTS).tables
    alone = compile_controllers(rule_sets[1:], [0.08, 0, 0], PARTS).tables
    for code, behaviour in itertools.product(range(16), range(3)):
        one, other = drawn(both, 1, code, behaviour, 1), drawn(alone, 0, code, behaviour, 1)
        assert np.array_equal(one, other)


def test_rules_may_be_many():
    rule = Rule(actions=(StateChange(0.01, "WANT_OBJECT", False),))
    rule_sets = [RuleSet(), RuleSet((rule,) * 100)]
    tables = compile_controllers(rule_sets, [0.0, 0.0, 0.0], PARTS).tables
    assert drawn(tables, 1, 8, 2, 1)[2, 1, 0] == pytest.approx(0.99**100, abs=1e-6)


def test_names_of_the_vocabulary_are_the_components():
    names = [each.name.replace("_", "-").upper() for each in PARTS.behaviours]
    assert [entry.name.replace("_", "-") for entry in FORAGING.behaviours] == names
    assert PARTS.behaviours.index(PARTS.first) == FORAGING.behaviour_index["RANDOM_WALK"]
    assert [each.name.upper() for each in PARTS.registers] == list(FORAGING.state_index)
    assert PARTS.first_state == Space.of(FORAGING).initial_states
    assert PARTS.lasting == Space.of(FORAGING).kept[-1]
    assert [bool(each.start) for each in PARTS.behaviours] == [
        entry.restarts for entry in FORAGING.behaviours
    ]


def test_more_classes_than_there_is_room_for_are_refused():
    """Rules that are too many to be told apart make a class of each code."""
    scenario = SENSING.with_changes(behaviours=("STOP",), registers=("WANT_OBJECT", "DROP_OBJECT"))
    parts = parts_of(scenario)
    assert parts.codes > MOST_CLASSES
    rule = Rule(actions=(StateChange(0.01, "WANT_OBJECT", False),))
    fails = [0.0] * len(parts.sensors)
    with pytest.raises(ValueError, match=r"rule set 0: .* too large: .* 1024 classes"):
        compile_controllers([RuleSet((rule,) * 100)], fails, parts)
