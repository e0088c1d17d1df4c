from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import (
    Rule,
    RuleSet,
    Simplification,
    first_difference,
    load_preset,
    parse_text,
    same_behaviour,
    simplify,
)
from tests.rules import oracle
from tests.rules.oracle import differs, without_pieces
from tests.rules.test_diagnosis import redundant_rule_sets
from tests.strategies import documented_rule_sets, plain_rule_sets


def length(rule_set):
    return sum(
        1 + len(rule.preconditions) + len(rule.behaviours) + len(rule.actions)
        for rule in rule_set.rules
    )


@settings(max_examples=30, deadline=None)
@given(redundant_rule_sets)
def test_what_is_left_behaves_the_same_and_nothing_more_can_go(rule_set):
    simplified = simplify(rule_set).rule_set
    assert not differs(rule_set, simplified)
    assert not differs(simplified, rule_set)
    assert length(simplified) <= length(rule_set)
    assert simplify(simplified) == Simplification(simplified, ())
    for _, _, shorter in without_pieces(simplified):
        assert differs(simplified, shorter)


@settings(max_examples=30, deadline=None)
@given(documented_rule_sets)
def test_names_comments_and_rules_switched_off_stay(rule_set):
    simplified = simplify(rule_set).rule_set
    assert replace(simplified, rules=()) == replace(rule_set, rules=())
    assert [rule for rule in simplified.rules if not rule.enabled] == [
        rule for rule in rule_set.rules if not rule.enabled
    ]
    comments = [rule.comment for rule in rule_set.rules]
    remaining = iter(comments)
    assert all(rule.comment in remaining for rule in simplified.rules)


def test_what_was_removed_is_listed_with_the_original_numbers():
    simplified = simplify(
        parse_text(
            "rule while PHOTOTAXIS do p = 0.5, RANDOM_WALK do p = 1, RANDOM_WALK "
            "rule off do p = 1, PHOTOTAXIS "
            "rule while PHOTOTAXIS or PHOTOTAXIS do p = 1, ANTI-PHOTOTAXIS "
            "rule if ON_NEST == true and ON_SOURCE == false while RANDOM_WALK or RANDOM_WALK "
            "do p = 0.5, PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS"
        )
    )
    assert simplified.removed == (
        "rule 1: action p = 0.5, RANDOM_WALK",
        "rule 3",
        "rule 4: precondition ON_SOURCE == false",
        "rule 4: behaviour RANDOM_WALK",
    )
    expected = parse_text(
        "rule while PHOTOTAXIS do p = 1, RANDOM_WALK "
        "rule off do p = 1, PHOTOTAXIS "
        "rule if ON_NEST == true while RANDOM_WALK do p = 0.5, PHOTOTAXIS "
        "do p = 0.1, ANTI-PHOTOTAXIS"
    )
    assert simplified.rule_set == expected


def test_evo8_in_its_shortest_form():
    simplified = simplify(load_preset("evo8"))
    assert simplified.removed == (
        "rule 3: behaviour RANDOM_WALK",
        "rule 3: behaviour PHOTOTAXIS",
        "rule 4: behaviour RANDOM_WALK",
        "rule 4: behaviour PHOTOTAXIS",
        "rule 4: action p = 1, PHOTOTAXIS",
    )
    assert simplified.rule_set.name == "EVO 8"


def test_a_rule_set_without_any_effect_becomes_empty():
    rule = Rule(actions=parse_text("rule do p = 1, RANDOM_WALK").rules[0].actions)
    assert simplify(RuleSet((rule, rule))).rule_set == RuleSet()
    assert simplify(RuleSet()).removed == ()


@settings(max_examples=40, deadline=None)
@given(plain_rule_sets(max_rules=2), plain_rule_sets(max_rules=2))
def test_same_behaviour_is_what_the_oracle_says_and_symmetric(a, b):
    assert same_behaviour(a, b) == (not differs(a, b)) == same_behaviour(b, a)
    assert same_behaviour(a, a)


@settings(max_examples=40, deadline=None)
@given(plain_rule_sets(max_rules=2), st.sampled_from(["evo8", "hand-coded"]))
def test_the_first_difference_is_one(a, name):
    b = load_preset(name)
    difference, turned = first_difference(a, b), first_difference(b, a)
    if difference is None:
        assert not differs(a, b)
        return
    assert (turned.situation, turned.first) == (difference.situation, difference.second)
    for decisions in (difference.first, difference.second):
        assert sum(decisions.values()) == pytest.approx(1)


def test_the_first_difference_in_words():
    one = parse_text("rule if ON_NEST == true do p = 0.25, PHOTOTAXIS do p = 1, DROP_OBJECT = true")
    two = parse_text("rule if ON_NEST == true do p = 0.1, PHOTOTAXIS do p = 1, DROP_OBJECT = true")
    assert str(first_difference(one, two)) == (
        "when in the nest and not holding an object, while walking at random, with WANT_OBJECT "
        "true: keep walking at random (p = 0.75), go to the light (p = 0.25) - against keep "
        "walking at random (p = 0.9), go to the light (p = 0.1)"
    )


def test_dropping_what_is_not_held_is_no_difference():
    """Design, section 2: DROP_OBJECT is false again after the step, carried object or not."""
    nest = "rule if ON_NEST == true {} do p = 0.5, DROP_OBJECT = true"
    anywhere, holding = (parse_text(nest.format(more)) for more in ("", "and HAS_OBJECT == true"))
    empty = parse_text(nest.format("and HAS_OBJECT == false"))
    assert same_behaviour(anywhere, holding)
    assert same_behaviour(empty, RuleSet())
    assert simplify(anywhere) == Simplification(anywhere, ())
    assert simplify(holding).removed == ("rule 1: precondition HAS_OBJECT == true",)
    assert simplify(empty).rule_set == RuleSet()
    difference = first_difference(anywhere, RuleSet())
    assert difference.situation.startswith("when in the nest and holding an object")
    assert difference.first == {
        "keep walking at random": 0.5,
        "keep walking at random and drop the object": 0.5,
    }


@settings(max_examples=15, deadline=None)
@given(plain_rule_sets(max_rules=2), plain_rule_sets(max_rules=2))
def test_same_behaviour_is_the_same_effects_drawn_one_by_one(a, b):
    for other in (b, simplify(a).rule_set):
        same = all(
            oracle.effects(a, *each) == pytest.approx(oracle.effects(other, *each), abs=1e-12)
            for each in oracle.reachable(a)
        )
        assert same_behaviour(a, other) == same


def test_a_restarted_walk_is_a_difference():
    walk = parse_text("rule do p = 1, PHOTOTAXIS do p = 1, RANDOM_WALK")
    assert first_difference(walk, RuleSet()).first == {"start walking at random afresh": 1.0}
    assert first_difference(walk, RuleSet()).second == {"keep walking at random": 1.0}
