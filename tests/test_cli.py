"""The `geswarm` verbs as a user calls them."""

import json
import subprocess
import sys

import pytest

from geswarm.cli import main
from geswarm.rules import load_preset, parse_text, parse_yaml

QUICK = "extends: paper\nduration: 100\n"


@pytest.fixture
def quick_scenario(tmp_path):
    path = tmp_path / "quick.yaml"
    path.write_text(QUICK)
    return str(path)


def test_evaluate_prints_one_json_object_and_nothing_else(quick_scenario, capsys):
    arguments = ["evaluate", "hand-coded", "evo8", "--scenario", quick_scenario]
    assert main([*arguments, "--runs", "4", "--seed", "7", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["scenario"] == quick_scenario
    assert (document["runs"], document["seed"]) == (4, 7)
    first, second = document["results"]
    assert (first["rules"], second["rules"]) == ("hand-coded", "evo8")
    assert set(first) == {"rules", "collected", "mean", "sd", "median", "lost_mean"}
    assert len(first["collected"]) == 4
    assert first["mean"] == sum(first["collected"]) / 4
    (comparison,) = document["comparisons"]
    assert set(comparison) == {"a", "b", "p_value", "effect"}
    assert (comparison["a"], comparison["b"]) == ("hand-coded", "evo8")


def test_evaluate_gives_the_same_figures_with_any_number_of_workers(quick_scenario, capsys):
    outputs = []
    for workers in ("1", "3"):
        main(["evaluate", "evo8", "--scenario", quick_scenario, "--runs", "7", "--json",
              "--workers", workers])  # fmt: skip
        outputs.append(capsys.readouterr().out)
    assert outputs[0] == outputs[1]


def test_evaluate_prints_a_table(quick_scenario, capsys):
    assert (
        main(["evaluate", "evo8", "hand-coded", "--scenario", quick_scenario, "--runs", "3"]) == 0
    )
    out = capsys.readouterr().out
    assert "hand-coded" in out
    assert "Mann-Whitney" in out


@pytest.mark.slow
def test_evo8_beats_the_hand_coded_rules_as_in_the_paper(capsys):
    assert main(["evaluate", "hand-coded", "evo8", "--runs", "50", "--json"]) == 0
    (comparison,) = json.loads(capsys.readouterr().out)["comparisons"]
    assert comparison["p_value"] < 0.001
    assert comparison["effect"] < 0.5


@pytest.mark.parametrize(("form", "parse"), [("text", parse_text), ("yaml", parse_yaml)])
def test_show_prints_what_can_be_read_back(form, parse, capsys):
    assert main(["show", "evo8", "--as", form]) == 0
    assert parse(capsys.readouterr().out) == load_preset("evo8")


def test_show_prints_the_papers_table(capsys):
    assert main(["show", "evo8"]) == 0
    assert "B2  RANDOM_WALK   ANTI-PHOTOTAXIS" in capsys.readouterr().out


def test_check_lists_every_finding(tmp_path, capsys):
    assert main(["check", "hand-coded"]) == 0
    bad = tmp_path / "bad.rules"
    bad.write_text("rule if ON_NST == true do p = 3, PHOTOTAXIS\n")
    capsys.readouterr()
    assert main(["check", str(bad)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        f"error: {bad}:1: rule 1, precondition 1: "
        "unknown precondition 'ON_NST'; did you mean ON_NEST?",
        f"error: {bad}:1: rule 1, action 1: probability must be between 0 and 1, got 3.0",
    ]


def test_check_lists_hints_but_only_warnings_and_errors_set_the_exit_status(tmp_path, capsys):
    assert main(["check", "evo8"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert (
        "hint: rule 4, action 1: no effect: the behaviour is already PHOTOTAXIS whenever this rule "
        "fires"
    ) in out
    assert all(line.startswith("hint: ") for line in out)
    stuck = tmp_path / "stuck.rules"
    stuck.write_text("rule do p = 0.1, PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS\n")
    assert main(["check", str(stuck)]) == 1
    assert capsys.readouterr().out == (
        "warning: objects are never dropped: DROP_OBJECT is never set while one is held\n"
    )
    sound = tmp_path / "sound.rules"
    sound.write_text(
        "rule do p = 0.1, PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS do p = 0.1, DROP_OBJECT = true\n"
    )
    assert main(["check", str(sound)]) == 0
    assert capsys.readouterr().out == f"{sound}: no findings\n"


def test_rules_come_from_standard_input(monkeypatch, capsys):
    result = subprocess.run(
        [sys.executable, "-m", "geswarm.cli", "show", "-", "--as", "yaml"],
        input="rule do p = 1, PHOTOTAXIS",
        capture_output=True,
        text=True,
        check=True,
    )
    assert parse_yaml(result.stdout) == parse_text("rule do p = 1, PHOTOTAXIS")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["evaluate"], "the following arguments are required: RULES"),
        (["evaluate", "evo9"], "evo9: neither a file"),
        (["evaluate", "evo8", "--runs", "0"], "expected a whole number >= 1, got '0'"),
        (["evaluate", "evo8", "--scenario", "moon"], "moon"),
        (["check", "nowhere.yaml"], "nowhere.yaml: neither a file"),
        (["show", "evo8", "--as", "pdf"], "invalid choice"),
        (["dance"], "invalid choice"),
    ],
)
def test_usage_errors_exit_2_with_one_clear_message(arguments, message, capsys):
    try:
        status = main(arguments)
    except SystemExit as error:
        status = error.code
    captured = capsys.readouterr()
    assert status == 2
    assert message in captured.err
    assert captured.out == ""
    assert "Traceback" not in captured.err


def test_help_does_not_load_the_simulator():
    code = "import sys, geswarm.cli; print([m for m in sys.modules if m in ('numba', 'numpy')])"
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"
