"""Verbs that read rule sets in the words of a scenario."""

import json

import pytest

from geswarm.cli import main
from geswarm.evolution import RunConfig
from geswarm.ge import Settings
from geswarm.rules import load_rule_set, parse_json, parse_text, parse_yaml
from geswarm.sim import load_scenario, parse_scenario, scenario_names, vocabulary_of

AAC = vocabulary_of(load_scenario("aac"))
E_PUCK = [name for name in scenario_names() if load_scenario(name).body == "e-puck"]
NEW = ["aac", "aggregation", "homing", "xor", *E_PUCK]


def out(capsys, *arguments, status=0):
    assert main(list(arguments)) == status
    return capsys.readouterr().out


@pytest.mark.parametrize("name", NEW)
def test_presets_of_scenarios_are_read_in_their_words(name, capsys):
    assert "error" not in out(capsys, "check", name)
    assert "error" not in out(capsys, "check", name, "--scenario", name)
    assert f'scenario "{name}"' in out(capsys, "show", name, "--as", "text")
    assert out(capsys, "equal", name, name) == "equal\n"


@pytest.mark.parametrize(
    "form", ["english", "markdown", "latex", "mermaid", "dot", "svg", "text", "yaml", "json"]
)
def test_every_form_takes_any_words(form, capsys):
    assert out(capsys, "export", "aac", "--to", form) == out(
        capsys, "export", "aac", "--to", form, "--scenario", "aac"
    )


def test_what_is_exported_in_words_of_a_scenario_is_read_again(capsys):
    aac = load_rule_set("aac", AAC)
    for form, parse in (("text", parse_text), ("yaml", parse_yaml), ("json", parse_json)):
        assert parse(out(capsys, "export", "aac", "--to", form), "", AAC) == aac


@pytest.mark.parametrize("form", ["argos-lua", "automode"])
def test_forms_without_a_counterpart_name_the_term(form, capsys):
    assert main(["export", "aac", "--to", form]) == 2
    error = capsys.readouterr().err
    for term in ("ON_BLACK", "STOP", "IS_CLOSE_TO(3)"):
        assert f"{term} has no counterpart in" in error


def test_rules_that_have_counterparts_are_exported_for_any_scenario(tmp_path, capsys):
    rules = tmp_path / "light.rules"
    rules.write_text("rule while RANDOM_WALK do p = 0.1, PHOTOTAXIS")
    lua = out(capsys, "export", str(rules), "--to", "argos-lua", "--scenario", "aac")
    assert "local RAB_RANGE = 0.25" in lua
    arguments = ["export", str(rules), "--to", "argos-lua", "--scenario", "aac"]
    assert main([*arguments, "-o", str(tmp_path / "x"), "--experiment", str(tmp_path / "y")]) == 2
    assert "the arena of aac has no counterpart" in capsys.readouterr().err


def test_elsewhere_one_line_for_each_term_and_one_for_all(capsys):
    lines = out(capsys, "check", "aac", "--scenario", "paper", status=1).splitlines()
    assert len(lines) == 5
    assert sum("'STOP'" in line for line in lines) == 1
    assert lines[-1].endswith(
        "written for scenario aac; paper does not offer IS_CLOSE_TO, ON_BLACK, SEES_OBSTACLE, STOP"
    )


def test_a_scenario_beside_the_rules_is_found(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text("extends: xor\nregisters: [HUNGER(0..5)]\n")
    rules = tmp_path / "best.rules"
    rules.write_text('scenario "mine"\nrule if HUNGER < 5 do p = 0.1, HUNGER += 1')
    assert "error" not in out(capsys, "check", str(rules))
    assert "add 1 to HUNGER" in out(capsys, "export", str(rules), "--to", "english")
    rules.write_text('scenario "../mine"\nrule if HUNGER < 5 do p = 0.1, HUNGER += 1')
    assert "paper does not offer HUNGER" in out(capsys, "check", str(rules), status=1)


def test_a_wrong_scenario_is_a_usage_error(capsys):
    for verb in (["show", "aac"], ["check", "aac"], ["equal", "aac", "aac"]):
        assert main([*verb, "--scenario", "moon"]) == 2
        assert "there is no scenario or file" in capsys.readouterr().err


def test_compare_needs_rules_that_every_scenario_can_read(capsys):
    assert main(["compare", "aac", "--scenario", "aac", "homing", "--runs", "1"]) == 2
    error = capsys.readouterr().err
    assert "written for scenario aac; homing does not offer ON_BLACK" in error
    assert main(["evaluate", "evo8", "--scenario", "aac", "--runs", "1"]) == 2
    assert "unknown internal state 'DROP_OBJECT'; there is none on offer" in capsys.readouterr().err


def test_less_is_better_where_the_objective_is_minimised(tmp_path, capsys):
    path = tmp_path / "away.yaml"
    path.write_text(
        "extends: aac\nduration: 20\nobjective: {minimise: on_black, unit: robot-steps}\n"
    )
    idle = tmp_path / "idle.rules"
    idle.write_text("rule do p = 0, STOP")
    arguments = [str(idle), "aac", "--scenario", str(path), "--runs", "8"]
    document = json.loads(out(capsys, "evaluate", *arguments, "--json"))
    walking, gathering = document["results"]
    assert document["objective"] == walking["objective"]
    assert walking["objective"] == {
        "expression": "on_black",
        "unit": "robot-steps",
        "maximise": False,
    }
    assert walking["fitness"] == walking["measures"]["on_black"]
    assert "collected" not in walking
    assert 0 < walking["mean"] < gathering["mean"]
    assert document["comparisons"][0]["effect"] > 0.5
    assert f"{idle} beats aac" in out(capsys, "evaluate", *arguments)
    compared = json.loads(out(capsys, "compare", *arguments, "--json"))["results"]
    assert compared[0]["objective"] == walking["objective"]
    assert compared[1]["effect"] < 0.5


def test_the_scenario_of_a_run_is_that_of_the_rules_in_its_directory(tmp_path, capsys):
    text = "extends: xor\nregisters: [HUNGER(0..5)]\n"
    config = RunConfig(parse_scenario(text, "mine"), Settings())
    (tmp_path / "config.yaml").write_text(config.to_yaml())
    rules = tmp_path / "best.rules"
    rules.write_text('scenario "mine"\nrule if HUNGER < 5 do p = 0.1, HUNGER += 1')
    assert "error" not in out(capsys, "check", str(rules))
    rules.write_text(rules.read_text().replace("mine", "others"))
    assert "written for scenario others; paper" in out(capsys, "check", str(rules), status=1)
    (tmp_path / "config.yaml").write_text("geswarm: none")
    out(capsys, "check", str(rules), status=1)
