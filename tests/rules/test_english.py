import pytest
from hypothesis import given

from geswarm.rules import (
    BehaviourChange,
    Precondition,
    Rule,
    StateChange,
    describe,
    describe_rule,
    load_preset,
    parse_text,
)
from tests.strategies import documented_rule_sets


def test_evo8():
    assert describe(load_preset("evo8")) == [
        "While going to the light, start walking at random with probability 0.05 per step "
        "(about every 2.0 s).",
        "When in the nest, while walking at random or going away from the light, go to the light "
        "and drop the object.",
        "When holding an object, while walking at random or going to the light, go away from the "
        "light with probability 0.1 per step (about every 1.0 s).",
        "When in the nest and holding an object, while walking at random or going to the light, "
        "go to the light, then go away from the light with probability 0.001 per step "
        "(about every 100 s).",
    ]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rule do p = 1, PHOTOTAXIS", "At any time, go to the light."),
        ("rule", "At any time, do nothing."),
        ("rule off do p = 1, RANDOM_WALK", "(switched off) At any time, start walking at random."),
        (
            "rule if ON_NEST == true and HAS_OBJECT == false and ON_NEST == false "
            "do p = 1, PHOTOTAXIS",
            "Never, because a robot cannot be in the nest and outside the nest at once: "
            "go to the light.",
        ),
        (
            "rule if ON_NEST == true and ON_NEST == true while PHOTOTAXIS or PHOTOTAXIS "
            "do p = 0, WANT_OBJECT = false",
            "When in the nest, while going to the light, stop picking up objects with probability "
            "0 (never).",
        ),
        (
            "rule if ON_NEST == false and ON_SOURCE == false and HAS_OBJECT == true "
            "do p = 1, PHOTOTAXIS do p = 0.5, WANT_OBJECT = true do p = 1, DROP_OBJECT = false",
            "When outside the nest, away from the source and holding an object, go to the light, "
            "and start picking up objects with probability 0.5 per step (about every 0.2 s), "
            "and keep the object after all.",
        ),
        (
            "rule do p = 1e-9, PHOTOTAXIS",
            "At any time, go to the light with probability 1e-09 per step (practically never).",
        ),
    ],
)
def test_sentences(text, sentence):
    assert describe(parse_text(text)) == [sentence]


def test_unknown_names_are_quoted():
    rule = Rule(
        (Precondition("ON_NST", True),),
        ("WALK",),
        (BehaviourChange(1.0, "RUN"), StateChange(1.0, "WANT", False)),
    )
    assert describe_rule(rule) == (
        "When 'ON_NST' is true, while doing 'WALK', start 'RUN' and set 'WANT' to false."
    )


@given(documented_rule_sets)
def test_any_rule_is_one_sentence(rule_set):
    sentences = describe(rule_set)
    assert len(sentences) == len(rule_set.rules)
    for rule, sentence in zip(rule_set.rules, sentences, strict=True):
        assert sentence.startswith("(switched off) ") != rule.enabled
        assert sentence.endswith(".")
        assert "\n" not in sentence
