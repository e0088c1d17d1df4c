"""`geswarm scenarios` and `geswarm terms` as a user calls them."""

import json

import pytest

from geswarm.cli import main
from geswarm.sim import load_scenario, scenario_names
from geswarm.sim.library.terms import BUILT_IN


@pytest.fixture(autouse=True)
def narrow(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")


def printed(capsys, *arguments):
    assert main(list(arguments)) == 0
    return capsys.readouterr().out


def terms(capsys, *arguments):
    document = json.loads(printed(capsys, "terms", "--json", *arguments))
    of_the_first_body = reversed(document["terms"])
    return {(each["kind"], each["name"]): each for each in of_the_first_body}


def test_scenarios_are_listed_with_all_that_tells_them_apart(capsys):
    found = json.loads(printed(capsys, "scenarios", "--json"))["scenarios"]
    assert [each["name"] for each in found] == scenario_names()
    aac = next(each for each in found if each["name"] == "aac")
    assert aac["about"].startswith("Aggregation with ambient cues: robots gather")
    assert (aac["robots"], aac["duration"], aac["reference"]) == (20, 120, "aac")
    unit = "robot-steps"
    assert aac["objective"] == {"expression": "on_black", "unit": unit, "maximise": True}
    assert aac["preconditions"] == list(load_scenario("aac").preconditions)


@pytest.mark.parametrize("verb", [["scenarios"], ["terms"], ["terms", "--scenario", "homing"]])
def test_tables_fit_a_terminal(verb, capsys):
    table = printed(capsys, *verb)
    assert max(map(len, table.splitlines())) <= 80
    assert "on_home" in table or verb == ["terms"]


def test_the_library_lists_every_term(capsys):
    found = terms(capsys)
    for kind, known in (
        (kind, terms_of)
        for each in BUILT_IN.values()
        for kind, terms_of in (
            ("precondition", each.percepts),
            ("behaviour", each.behaviours),
            ("register", each.registers),
            ("measure", each.measures),
        )
    ):
        assert {name for of, name in found if of == kind} >= known.keys()
    assert ("precondition", "ON_<AREA>") in found
    assert all(each["source"] for each in found.values())
    assert all(each["about"] for each in found.values())


def test_terms_tell_arguments_words_values_units_and_source(capsys):
    found = terms(capsys)
    close = found["precondition", "IS_CLOSE_TO"]
    assert close["arguments"] == [
        {"name": "k", "unit": "robots", "kind": "whole", "low": 1, "high": 7}
    ]
    assert close["words"] == ["close to at least {k} robots", "close to fewer than {k} robots"]
    assert close["source"].startswith("geswarm/sim/terms/robots.py, line ")
    near = found["precondition", "NEIGHBOURS"]
    assert near["values"] == list(range(8))
    assert near["comparisons"] == ["==", "!=", ">=", "<=", ">", "<"]
    assert found["precondition", "HAS_OBJECT"]["source"] == "paper, section 3.1.1"
    (gain,) = found["behaviour", "ATTRACTION"]["arguments"]
    assert (gain["kind"], gain["low"], gain["high"], gain["step"]) == ("number", 1, 5, 0.5)
    assert found["register", "DROP_OBJECT"]["operations"] == ["="]
    assert found["measure", "collected"]["unit"] == "objects"


def test_a_scenario_offers_its_own(tmp_path, capsys):
    path = tmp_path / "mine.yaml"
    path.write_text('extends: xor\nregisters: ["MODE(red, green)", HUNGER(0..5)]\n')
    found = terms(capsys, "--scenario", str(path))
    assert found["precondition", "FLOOR"]["values"] == list(load_scenario("xor").arena.colours)
    assert found["precondition", "MODE"]["values"] == ["red", "green"]
    assert found["register", "HUNGER"]["operations"] == ["=", "+=", "-="]
    assert found["measure", "larger_group"]["about"]
    assert ("precondition", "HAS_OBJECT") not in found


def test_a_wrong_scenario_is_a_usage_error(capsys):
    assert main(["terms", "--scenario", "moon"]) == 2
    assert "there is no scenario or file" in capsys.readouterr().err
