"""The schema of the JSON form: it fits all that is written, and refuses what reading refuses."""

import json

import jsonschema
import pytest
from hypothesis import given, settings

from geswarm.cli import main
from geswarm.exports import EXPORTS
from geswarm.exports.json_document import SCHEMA_FILE
from geswarm.rules import (
    RuleSet,
    RuleSetError,
    format_json,
    load_preset,
    preset_names,
    read_rule_set,
)
from tests import strategies
from tests.exports.test_exports import CROWDED

SCHEMA = json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def test_the_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("preset", preset_names())
def test_presets_fit_the_schema(preset):
    VALIDATOR.validate(json.loads(EXPORTS["json"](load_preset(preset))))


@settings(max_examples=40, deadline=None)
@given(strategies.documented_rule_sets)
def test_all_that_is_written_fits_the_schema(rule_set):
    for form in (format_json, EXPORTS["json"]):
        VALIDATOR.validate(json.loads(form(rule_set)))


def test_all_that_is_written_is_in_the_schema():
    for rule_set in (CROWDED, RuleSet(), load_preset("evolved")):
        document = json.loads(EXPORTS["json"](rule_set))
        assert set(document) == set(SCHEMA["properties"])


@pytest.mark.parametrize(
    "wrong",
    [
        {},
        [],
        {"rules": 5},
        {"schema": 3, "rules": []},
        {"rules": [], "ruels": []},
        {"rules": [3]},
        {"rules": [{"comment": 1}]},
        {"rules": [{"precondition": []}]},
        {"rules": [{"behaviours": [{"name": "PHOTOTAXIS", "argument": []}]}]},
        {"rules": [{"preconditions": [{"percept": {"name": "ON_NEST"}}]}]},
        {"rules": [{"preconditions": [{"percept": {"name": "ON_NEST"}, "value": []}]}]},
        {"rules": [{"actions": [{"p": 2, "behaviour": {"name": "PHOTOTAXIS"}}]}]},
        {"rules": [{"actions": [{"p": 1, "state": "WANT_OBJECT"}]}]},
        {"rules": [], "origin": 3},
        {"rules": [], "origin": {"runs": "x"}},
        {"rules": [], "origin": None},
        {"rules": [], "origin": {"generations": 3}},
        {"rules": None},
        {"rules": [], "schema": True},
        {"rules": [{"preconditions": [{"name": "ON_NEST", "holds": True, "p": 1}]}]},
        {"rules": [{"actions": [{"p": 1, "behavior": "PHOTOTAXIS"}]}]},
        {"rules": [{"actions": [{"p": 1, "behaviour": "PHOTOTAXIS", "value": True}]}]},
    ],
)
def test_what_reading_refuses_does_not_fit(wrong):
    assert not VALIDATOR.is_valid(wrong)
    with pytest.raises(RuleSetError):
        read_rule_set(json.dumps(wrong), "wrong.json")


def test_the_help_says_where_the_schema_is(capsys):
    with pytest.raises(SystemExit):
        main(["export", "--help"])
    told = "".join(capsys.readouterr().out.split())
    assert "".join(str(SCHEMA_FILE).split()) in told
