"""Rule sets say for which scenario they were written."""

from dataclasses import replace

import pytest

from geswarm.rules import (
    FORMATS,
    RuleSetError,
    RuleSetText,
    find_rule_set,
    format_json,
    format_text,
    format_yaml,
    load_preset,
    preset_names,
    read_rule_set,
)
from geswarm.rules.anything import ANYTHING

MARKED = replace(load_preset("evo8"), scenario="aac")


@pytest.mark.parametrize("form", FORMATS)
def test_every_form_carries_it(form):
    assert read_rule_set(FORMATS[form](MARKED)) == MARKED


def test_files_without_it_are_foragings():
    assert "scenario" not in format_text(load_preset("evo8"))
    assert "scenario" not in format_yaml(load_preset("evo8"))
    old = format_json(load_preset("evo8")).replace('"scenario": "",', "")
    old = old.replace(',\n  "scenario": ""', "")
    assert "scenario" not in old
    assert read_rule_set(old) == load_preset("evo8")


def test_it_stands_behind_the_name():
    assert format_text(MARKED).splitlines()[1:3] == ['name "EVO 8"', 'scenario "aac"']
    assert format_yaml(MARKED).splitlines()[1:3] == ["name: EVO 8", "scenario: aac"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('scenario "a"\nscenario "b"\nrule', "scenario is given twice"),
        ("scenario aac\nrule", "expected a text in double quotes, got the text 'aac'"),
        ('rule\nscenario "a"', "scenario must stand before the first rule"),
        ("rules: []\nscenario: [a]", "scenario: expected text, got"),
        ('{"rules": [], "scenario": 3}', "scenario: expected text, got 3"),
    ],
)
def test_what_is_wrong_with_it_is_told(text, message):
    with pytest.raises(RuleSetError, match=message.replace("'", ".").replace("the text ", ".*")):
        read_rule_set(text)


@pytest.mark.parametrize("name", sorted({*preset_names(None)} - {*preset_names()}))
def test_it_is_known_before_the_words_are(name):
    assert find_rule_set(name).scenario == name


@pytest.mark.parametrize("form", FORMATS)
def test_it_is_known_of_rules_with_errors(form):
    text = FORMATS[form](MARKED).replace("0.05", "7")
    assert RuleSetText(text, "").scenario == "aac"


@pytest.mark.parametrize("form", FORMATS)
def test_what_is_not_on_offer_is_listed_once_and_as_a_whole(form):
    text = FORMATS[form](read_rule_set(AAC, "", ANYTHING))
    for here, whole in (("paper", "paper does not offer "), ("", "not on offer here: ")):
        with pytest.raises(RuleSetError) as error:
            read_rule_set(text, "x", offered_by=here)
        messages = [finding.message for finding in error.value.findings]
        assert messages[-1] == f"written for scenario aac; {whole}HUNGER, NEAR, STOP"
        assert len(messages) == len(set(messages)) == 4
        assert error.value.scenario == "aac"


AAC = """scenario "aac"
rule if NEAR(3) == true while STOP do p = 0.1, STOP
rule if NEAR(3) == true while STOP do p = 0.1, HUNGER = 3
"""


def test_there_are_other_errors_in_rules_for_another_scenario():
    with pytest.raises(RuleSetError) as error:
        read_rule_set(AAC.replace("p = 0.1", "p = 5"))
    assert not any("written for" in finding.message for finding in error.value.findings)
