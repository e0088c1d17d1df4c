from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.rules import EditError, RuleSet, Term, apply_edit, format_text, load_preset, parse_text
from geswarm.rules.as_json import rule_set_to_json
from geswarm.rules.edits import EDITS

EVO8 = load_preset("evo8")


def edited(**edit):
    return apply_edit(EVO8, edit)


def test_a_probability_is_set():
    element = {"p": 0.5, "behaviour": "RANDOM_WALK"}
    rules = edited(do="set", rule=0, part="actions", at=0, element=element).rules
    assert rules[0].actions[0].p == 0.5
    assert rules[1:] == EVO8.rules[1:]


def test_elements_are_added_and_removed():
    added = edited(
        do="add", rule=0, part="preconditions", at=0, element={"name": "ON_SOURCE", "holds": False}
    )
    assert added.rules[0].preconditions[0].percept == Term("ON_SOURCE")
    undone = apply_edit(added, {"do": "remove", "rule": 0, "part": "preconditions", "at": 0})
    assert undone == EVO8
    assert edited(do="add", rule=0, part="behaviours", at=1, element="RANDOM_WALK").rules[
        0
    ].behaviours == (Term("PHOTOTAXIS"), Term("RANDOM_WALK"))


def test_rules_are_added_removed_moved_duplicated_and_switched_off():
    r1, r2, r3, r4 = EVO8.rules
    assert edited(do="move_rule", rule=0, to=3).rules == (r2, r3, r4, r1)
    assert edited(do="move_rule", rule=3, to=0).rules == (r4, r1, r2, r3)
    assert edited(do="duplicate_rule", rule=1).rules == (r1, r2, r2, r3, r4)
    assert edited(do="remove_rule", rule=2).rules == (r1, r2, r4)
    assert not edited(do="set_enabled", rule=0, enabled=False).rules[0].enabled
    rule = rule_set_to_json(EVO8)["rules"][3]
    assert edited(do="add_rule", at=0, rule=rule).rules == (r4, r1, r2, r3, r4)
    assert edited(do="set_comment", rule=0, comment="why\n").rules[0].comment == "why"
    assert edited(do="set_name", name=" My\nrules ").name == "My rules"


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        ({}, "unknown edit"),
        ({"do": ["x"]}, "unknown edit"),
        ({"do": "remove_rule", "rule": 4}, "there is no rule 5; expected 1 to 4"),
        ({"do": "remove_rule", "rule": True}, "there is no rule"),
        ({"do": "set_enabled", "rule": 0, "enabled": 1}, "true or false"),
        ({"do": "set_comment", "rule": 0, "comment": "x" * 20_000}, "at most 10000"),
        ({"do": "add", "rule": 0, "part": "wheels", "at": 0}, "unknown part"),
        ({"do": "remove", "rule": 0, "part": "actions", "at": 1}, "there is no element 2"),
        (
            {
                "do": "set",
                "rule": 0,
                "part": "actions",
                "at": 0,
                "element": {"p": 2, "behaviour": "X"},
            },
            "unknown behaviour",
        ),
        (
            {"do": "set", "rule": 0, "part": "behaviours", "at": 0, "element": 7},
            "expected a behaviour",
        ),
    ],
)
def test_impossible_edits_are_refused_with_a_reason(edit, message):
    with pytest.raises(EditError, match=message):
        apply_edit(EVO8, edit)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 9) | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
)


@given(
    st.fixed_dictionaries(
        {"do": st.sampled_from(list(EDITS))},
        optional={
            key: json_values | st.sampled_from(["preconditions", "behaviours", "actions"])
            for key in ("rule", "at", "to", "part", "element", "enabled", "comment", "name", "text")
        },
    )
)
def test_any_message_gives_a_rule_set_or_an_edit_error(edit):
    try:
        assert isinstance(apply_edit(EVO8, edit), RuleSet)
    except EditError as error:
        assert str(error)


def test_pasted_rules_are_inserted_in_order():
    text = """name "ignored"
# why
rule off if ON_NEST == true do p = 0.25, RANDOM_WALK
rule do p = 1, PHOTOTAXIS"""
    pasted = parse_text(text).rules
    assert edited(do="paste_rules", at=1, text=text) == replace(
        EVO8, rules=(EVO8.rules[0], *pasted, *EVO8.rules[1:])
    )
    assert pasted[0].comment == "why"
    everything = apply_edit(RuleSet(), {"do": "paste_rules", "at": 0, "text": format_text(EVO8)})
    assert everything.rules == EVO8.rules


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        ({"at": 5, "text": "rule do p = 1, PHOTOTAXIS"}, "no place for rule 6; expected 1 to 5"),
        ({"at": 0, "text": 7}, "text must be a text of at most 200000 characters"),
        ({"at": 0, "text": "#" * 200_001}, "text must be a text of at most 200000 characters"),
        ({"at": 0, "text": " "}, "expected at least one rule"),
        ({"at": 0, "text": 'name "x"'}, "expected at least one rule"),
        ({"at": 0, "text": "rule do p = 1, PHOTOTAXIS " * 1000}, "expected at most 1000 rules"),
    ],
)
def test_impossible_pastes_are_refused_with_a_reason(edit, message):
    with pytest.raises(EditError, match=message):
        edited(do="paste_rules", **edit)


def test_every_error_in_a_pasted_text_is_listed_with_its_line():
    with pytest.raises(EditError) as error:
        edited(do="paste_rules", at=0, text="rule if ON_NST == true\n  do p = 2, PHOTOTAXIS")
    assert str(error.value).split("\n") == [
        "line 1: rule 1, precondition 1: unknown precondition 'ON_NST'; did you mean ON_NEST?",
        "line 2: rule 1, action 1: probability must be between 0 and 1, got 2.0",
    ]
