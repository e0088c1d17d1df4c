"""`geswarm scenarios` and `geswarm terms` as a user calls them."""

import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from geswarm.cli import main
from geswarm.sim import load_scenario, scenario_names
from geswarm.sim.arena.geometry import distances
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


def test_an_arena_is_drawn(tmp_path, capsys):
    file = tmp_path / "sca.svg"
    assert printed(capsys, "scenarios", "sca", "--picture", str(file)) == ""
    tags = [each.tag.rpartition("}")[2] for each in ET.parse(file).iter()]
    walls, patches, lights, start = 3, 3, 1, 1
    outlines = 3  # clip, ground, wall
    assert tags.count("polygon") == outlines + walls + 1  # the shelter
    assert tags.count("circle") == patches - 1 + lights + start


def test_missions_are_generated(tmp_path, capsys):
    folder = tmp_path / "deep" / "missions"
    arguments = ["scenarios", "--generate", "mg1", "--seed", "5", "-o", str(folder), "--number"]
    names = printed(capsys, *arguments, "40").split()
    assert names == [str(folder / f"mg1-5-{k}.yaml") for k in range(1, 41)]
    first = (folder / "mg1-5-1.yaml").read_text()
    found = [load_scenario(name) for name in names]
    printed(capsys, *arguments, "1")
    assert (folder / "mg1-5-1.yaml").read_text() == first
    measures = {each.measures for each in found}
    assert measures == {(name,) for name in ("delivered", "on_home", "larger_group", "max_group")}
    assert {each.duration for each in found} == {60, 120, 180}
    assert {len(each.arena.outline.points) for each in found} == {3, 4, 6}
    assert {len(each.arena.obstacles) for each in found} == {0, 1, 2, 3}
    assert all(15 <= each.robots <= 20 and each.reference == "" for each in found)
    for each in found:
        discs = [patch.shape for patch in each.arena.patches]
        for k, disc in enumerate(discs):
            for other in discs[:k]:
                apart = distances(other, np.array([[disc.x, disc.y]]))[0]
                assert apart >= disc.radius - 1e-9


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["sca"], "expected S and --picture FILE together"),
        (["--generate", "mg1"], "expected --generate mg1 and -o DIR together"),
        (["moon", "--picture", "x.svg"], "there is no scenario or file"),
    ],
)
def test_what_is_drawn_or_generated_must_be_said(arguments, message, capsys):
    assert main(["scenarios", *arguments]) == 2
    assert message in capsys.readouterr().err
