"""Findings: each is true, and nothing that has no effect goes without one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import RuleSet, check, load_preset, parse_text
from tests.rules.oracle import differs, without_pieces
from tests.strategies import plain_rule_sets, rules


def found(text):
    return [f"{finding.severity}: {finding}" for finding in check(parse_text(text))]


WORKING = "rule if ON_NEST == true do p = 1, DROP_OBJECT = true "
BUSY = WORKING + (
    "rule while RANDOM_WALK do p = 0.1, PHOTOTAXIS "
    "rule while PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS "
    "rule while ANTI-PHOTOTAXIS do p = 0.1, RANDOM_WALK "
)


def test_a_sound_rule_set_has_no_findings():
    assert found(BUSY) == []


@pytest.mark.parametrize(
    ("text", "finding"),
    [
        (
            "rule if ON_NEST == true and ON_NEST == false do p = 1, PHOTOTAXIS",
            "warning: rule 5, precondition 2: contradicts precondition 1 (ON_NEST == true): "
            "this rule never fires",
        ),
        (
            "rule if ON_NEST == true and HAS_OBJECT == true and ON_SOURCE == true "
            "do p = 1, PHOTOTAXIS",
            "warning: rule 5, precondition 3: ON_SOURCE and ON_NEST are never true together: "
            "this rule never fires",
        ),
        ("rule", "warning: rule 5, actions: no action: this rule does nothing"),
        (
            "rule do p = 0, PHOTOTAXIS",
            "warning: rule 5, action 1: p = 0: this action never happens",
        ),
        (
            "rule do p = 0.1, WANT_OBJECT = true",
            "hint: rule 5: no effect: WANT_OBJECT is already true whenever it fires",
        ),
        (
            "rule while PHOTOTAXIS do p = 0.1, RANDOM_WALK do p = 1, WANT_OBJECT = true",
            "hint: rule 5, action 2: no effect: WANT_OBJECT is already true whenever this rule "
            "fires",
        ),
        (
            "rule if HAS_OBJECT == true do p = 1, DROP_OBJECT = false "
            "do p = 0.1, DROP_OBJECT = true do p = 1, DROP_OBJECT = true",
            "hint: rule 5, action 1: no effect: action 3 overrides it",
        ),
        (
            "rule if HAS_OBJECT == false do p = 0.5, DROP_OBJECT = true",
            "hint: rule 5: no effect: there is no object to drop whenever it fires",
        ),
        (
            "rule if HAS_OBJECT == false while PHOTOTAXIS do p = 0.5, RANDOM_WALK "
            "do p = 0.5, DROP_OBJECT = true",
            "hint: rule 5, action 2: no effect: there is no object to drop whenever this rule "
            "fires",
        ),
        (
            "rule while PHOTOTAXIS or PHOTOTAXIS do p = 0.5, RANDOM_WALK",
            "hint: rule 5, behaviour 2: no effect: the same as behaviour 1",
        ),
        (
            "rule if HAS_OBJECT == true and HAS_OBJECT == true do p = 0.5, RANDOM_WALK",
            "hint: rule 5, precondition 2: no effect: the same as precondition 1",
        ),
        (
            "rule while PHOTOTAXIS or RANDOM_WALK or ANTI-PHOTOTAXIS do p = 0.5, PHOTOTAXIS",
            "hint: rule 5, behaviours: no effect: the robots do the same if the rule holds for "
            "any behaviour",
        ),
        (
            "rule if ON_NEST == true do p = 1, DROP_OBJECT = true",
            "hint: rule 5: no effect: rule 1 makes it superfluous",
        ),
        (
            "rule do p = 1, PHOTOTAXIS do p = 1, ANTI-PHOTOTAXIS "
            "rule while RANDOM_WALK do p = 1, PHOTOTAXIS",
            "warning: rule 6, behaviours: the behaviour is never RANDOM_WALK when this rule's turn "
            "comes: this rule never fires",
        ),
        (
            "rule if ON_SOURCE == true do p = 1, PHOTOTAXIS "
            "rule if ON_SOURCE == true while RANDOM_WALK do p = 1, DROP_OBJECT = true",
            "warning: rule 6, behaviours: the behaviour is never RANDOM_WALK when this rule's turn "
            "comes with ON_SOURCE == true: this rule never fires",
        ),
        (
            "rule if ON_SOURCE == true while RANDOM_WALK do p = 1, PHOTOTAXIS "
            "rule if ON_SOURCE == true "
            "while RANDOM_WALK or ANTI-PHOTOTAXIS do p = 1, DROP_OBJECT = true "
            "do p = 1, RANDOM_WALK rule do p = 0.1, ANTI-PHOTOTAXIS",
            "hint: rule 6, behaviour 1: no effect: the behaviour is never RANDOM_WALK when this "
            "rule's turn comes with ON_SOURCE == true",
        ),
    ],
)
def test_each_kind_of_finding_with_place_and_reason(text, finding):
    assert finding in found(BUSY + text)


def test_a_rule_that_a_later_one_overrides():
    text = "rule if ON_NEST == true do p = 0.1, DROP_OBJECT = true " + BUSY
    assert found(text) == [
        "hint: rule 1: no effect: rule 2 overrides all that it changes",
    ]


def test_an_action_that_a_later_rule_overrides():
    text = (
        "rule if ON_NEST == true while PHOTOTAXIS do p=0.1, DROP_OBJECT=true do p=0.1, RANDOM_WALK "
    )
    assert found(text + BUSY) == ["hint: rule 1, action 1: no effect: rule 2 overrides it"]


def test_actions_that_undo_one_another():
    text = "rule do p = 1, DROP_OBJECT = true do p = 1, DROP_OBJECT = false " + BUSY
    assert found(text) == ["hint: rule 1: no effect: its actions undo one another"]


def test_objects_never_picked_up_or_dropped_and_behaviours_never_entered():
    assert found(
        "rule do p = 1, WANT_OBJECT = false rule if HAS_OBJECT == true do p = 1, DROP_OBJECT = true"
    ) == [
        "warning: rule 2, precondition 1: no robot ever holds an object: this rule never fires",
        "hint: no robot ever changes to PHOTOTAXIS",
        "hint: no robot ever changes to ANTI-PHOTOTAXIS",
        "warning: objects are never picked up: WANT_OBJECT is false from the first step on",
    ]
    assert found("rule if HAS_OBJECT == false do p = 1, DROP_OBJECT = true")[-1] == (
        "warning: objects are never dropped: DROP_OBJECT is never set while one is held"
    )


def test_nothing_switched_on():
    message = "warning: there is no rule that is switched on: robots only walk"
    assert found("rule off do p = 1, PHOTOTAXIS") == [message]


def test_numbers_count_the_rules_that_are_switched_off():
    assert found("rule off " + BUSY + "rule off rule") == [
        "warning: rule 7, actions: no action: this rule does nothing"
    ]


def test_errors_come_alone():
    rule_set = load_preset("evo8")
    rule = rule_set.rules[0]
    broken = RuleSet((*rule_set.rules, type(rule)(behaviours=("FOTOTAXIS",))))
    assert [str(finding) for finding in check(broken)] == [
        "rule 5, behaviour 1: unknown behaviour 'FOTOTAXIS'; did you mean PHOTOTAXIS?"
    ]


def test_the_papers_rule_sets_have_nothing_worse_than_hints():
    evo8, hand = ([str(each) for each in check(load_preset(n))] for n in ("evo8", "hand-coded"))
    assert "rule 4, action 1: no effect: the behaviour is already PHOTOTAXIS whenever this rule " \
        "fires" in evo8  # fmt: skip
    assert "rule 2, action 2: no effect: WANT_OBJECT is already true whenever this rule fires" \
        in hand  # fmt: skip
    for name in ("evo8", "hand-coded"):
        assert {finding.severity for finding in check(load_preset(name))} == {"hint"}


redundant_rule_sets = st.one_of(
    plain_rule_sets(max_rules=4),
    plain_rule_sets(max_rules=2).map(lambda each: RuleSet(each.rules * 2)),
    st.builds(
        lambda preset, rule, at: RuleSet((*preset.rules[:at], rule, *preset.rules[at:])),
        st.sampled_from([load_preset("evo8"), load_preset("hand-coded")]),
        rules(enabled=st.booleans()),
        st.integers(0, 4),
    ),
)


@settings(max_examples=30, deadline=None)
@given(redundant_rule_sets)
def test_exactly_the_pieces_without_effect_get_a_finding(rule_set):
    findings = [finding for finding in check(rule_set) if finding.place.rule]
    places = {(finding.place.rule, finding.place.element) for finding in findings}
    assert len(places) == len(findings)
    idle_rules = {
        finding.place.rule
        for finding in findings
        if finding.place.element == "" or "never fires" in finding.message
    }
    for number, element, without in without_pieces(rule_set):
        idle = not differs(rule_set, without)
        kind, _, index = element.partition(" ")
        if element == "":
            assert idle == (number in idle_rules)
        elif number in idle_rules:
            continue  # the rule's finding covers its pieces
        elif kind == "behaviour" and (number, "behaviours") in places:
            continue
        elif idle:
            rule = rule_set.rules[number - 1]
            copies = [
                (number, f"{kind} {other}")
                for other, each in enumerate(getattr(rule, f"{kind}s"), start=1)
                if each == getattr(rule, f"{kind}s")[int(index) - 1]
            ] if index else [(number, element)]  # fmt: skip
            assert places & set(copies)
        elif kind != "behaviours":
            assert (number, element) not in places
