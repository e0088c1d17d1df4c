"""The `geswarm` verbs as a user calls them."""

import json
import re
import subprocess
import sys

import pytest

from geswarm.cli import main
from geswarm.cli.rules import EXPORT_FORMS
from geswarm.exports import EXPORTS
from geswarm.rules import load_preset, load_rule_set, parse_text, parse_yaml

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
    assert document["objective"] == {"expression": "collected", "unit": "objects", "maximise": True}
    figures = {"mean", "sd", "median", "lost_mean"}
    assert set(first) == {"rules", "objective", "fitness", "measures", "collected", *figures}
    assert set(first["measures"]) == {"picked", "collected", "lost"}
    assert len(first["collected"]) == 4
    assert first["collected"] == first["fitness"] == first["measures"]["collected"]
    assert all(type(number) is int for number in first["collected"])
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


def test_in_a_log_rows_of_long_names_can_be_told_apart(
    quick_scenario, tmp_path, monkeypatch, capsys
):
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    folder = "campaign-of-the-spring/zones-missed-often/population-two-hundred"
    names = [f"{folder}/[seed]-{seed}/best.rules" for seed in (1, 2)]
    for name in names:
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text("rule do p = 0.1, PHOTOTAXIS")
    assert main(["evaluate", *names, "--scenario", quick_scenario, "--runs", "2"]) == 0
    table = capsys.readouterr().out.partition(f"{folder}/[seed]-1/best.rules beats")[0]
    assert max(map(len, table.splitlines())) <= 80
    assert all(name in re.sub(r"\s+|\d+\.\d+", "", table) for name in names)
    assert table.split().count("0.0") == 8


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
        (["equal", "evo8"], "the following arguments are required: B"),
        (["equal", "evo8", "nowhere.yaml"], "nowhere.yaml: neither a file"),
        (["export", "evo8"], "the following arguments are required: --to"),
        (["export", "evo8", "--to", "pdf"], "invalid choice"),
        (["export", "evo8", "--to", "dot", "-o", "no/where"], "no/where: cannot be written"),
        (["export", "evo8", "--to", "dot", "-o", ""], ": cannot be written"),
        (["export", "evo8", "--to", "dot", "--strict"], "--strict goes with --to automode"),
        (["export", "evo8", "--to", "dot", "--experiment", "x"], "goes with --to argos-lua"),
        (["export", "evo8", "--to", "argos-lua", "--scenario", "moon"], "moon"),
        (["export", "evo8", "--to", "argos-lua", "--experiment", "x.argos"], "give it one with -o"),
        (
            ["export", "evo8", "--to", "argos-lua", "-o", "x", "--experiment", "x"],
            "different files",
        ),
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


def test_equal_says_where_rule_sets_differ(tmp_path, capsys):
    same = tmp_path / "same.json"
    assert main(["export", "evo8", "--to", "json", "-o", str(same)]) == 0
    assert main(["equal", "evo8", str(same)]) == 0
    assert capsys.readouterr().out == "equal\n"
    assert main(["equal", "evo8", "hand-coded"]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "different when outside the nest, away from the source and not holding an object, "
        "while going to the light, with WANT_OBJECT true:",
        "  evo8",
        "    0.95      keep going to the light",
        "    0.05      start walking at random",
        "  hand-coded",
        "    1         keep going to the light",
    ]
    assert main(["equal", "evo8", "evo8", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == {"a": "evo8", "b": "evo8", "equal": True, "difference": None}
    assert main(["equal", "hand-coded", "evo8", "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document["equal"] is False
    assert document["difference"]["first"] == {"keep going to the light": 1.0}


@pytest.mark.parametrize("form", EXPORT_FORMS)
def test_export_writes_every_form_to_a_file_or_to_standard_output(form, tmp_path, capsys):
    path = tmp_path / "out"
    assert main(["export", "evo8", "--to", form]) == 0
    out = capsys.readouterr().out
    assert main(["export", "evo8", "--to", form, "-o", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == out != ""
    assert capsys.readouterr().out == ""
    assert [entry.name for entry in tmp_path.iterdir()] == ["out"]
    if form in ("yaml", "text", "json"):
        assert load_rule_set(str(path)) == load_preset("evo8")


def test_export_to_a_directory_fails_and_leaves_nothing(tmp_path, capsys):
    assert main(["export", "evo8", "--to", "dot", "-o", str(tmp_path)]) == 2
    assert "cannot be written: Is a directory" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_export_writes_through_a_link(tmp_path):
    link, file = tmp_path / "link", tmp_path / "file"
    link.symlink_to(file)
    assert main(["export", "evo8", "--to", "dot", "-o", str(link)]) == 0
    assert link.is_symlink()
    assert file.read_text().startswith("digraph")


@pytest.mark.parametrize("letter", ["n", "群"])
def test_export_writes_any_name_that_can_be(letter, tmp_path, capsys):
    longest = 255 // len(letter.encode())
    for suffix, more in ((".svg", []), (".lua", ["--experiment", ".argos"])):
        form = "argos-lua" if more else "svg"
        name, *others = [
            str(tmp_path / (letter * (longest - len(ending)) + ending))
            for ending in (suffix, *more[1:])
        ]
        arguments = ["export", "evo8", "--to", form, "-o", name]
        assert main([*arguments, *more[:1], *others]) == 0
    assert len(list(tmp_path.iterdir())) == 4
    too_long = str(tmp_path / (letter * (longest + 1)))
    assert main(["export", "evo8", "--to", "dot", "-o", too_long]) == 2
    assert "cannot be written: File name too long" in capsys.readouterr().err
    assert len(list(tmp_path.iterdir())) == 4


def test_export_offers_all_there_is():
    assert set(EXPORT_FORMS) == {*EXPORTS, "argos-lua"}


def test_export_writes_an_argos_experiment_beside_the_script(tmp_path, capsys):
    script, experiment = tmp_path / "lua" / "evo8.lua", tmp_path / "evo8.argos"
    script.parent.mkdir()
    arguments = ["export", "evo8", "--to", "argos-lua", "-o", str(script), "--scenario"]
    assert main([*arguments, "scalability-10", "--experiment", str(experiment)]) == 0
    written = experiment.read_text()
    assert '<params script="lua/evo8.lua" />' in written
    assert 'path="evo8-floor.ppm"' in written
    assert 'quantity="10"' in written
    assert (tmp_path / "evo8-floor.ppm").read_text().startswith("P3\n1 440\n")
    assert "-- Scenario: scalability-10" in script.read_text()


def test_export_to_automode_warns_and_refuses_if_strict(tmp_path, capsys):
    path = tmp_path / "fsm.txt"
    assert main(["export", "evo8", "--to", "automode", "--strict", "-o", str(path)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "error: AutoMoDe: left out" in captured.err
    assert not path.exists()
    assert main(["export", "evo8", "--to", "automode", "-o", str(path)]) == 0
    assert "warning: AutoMoDe: left out" in capsys.readouterr().err
    assert path.read_text().startswith("--fsm-config --nstates 3 ")
    simple = tmp_path / "simple.rules"
    simple.write_text("rule if ON_NEST == true do p = 0.1, PHOTOTAXIS")
    assert main(["export", str(simple), "--to", "automode", "--strict"]) == 0
    assert capsys.readouterr().err == ""


def test_export_leaves_the_old_file_if_the_rules_are_wrong(tmp_path, capsys):
    path, bad = tmp_path / "out.tex", tmp_path / "bad.rules"
    path.write_text("old")
    bad.write_text("rule do p = 3, PHOTOTAXIS")
    assert main(["export", str(bad), "--to", "latex", "-o", str(path)]) == 2
    assert path.read_text() == "old"
    assert "probability must be between 0 and 1" in capsys.readouterr().err


def test_help_does_not_load_the_simulator():
    heavy = ("numba", "numpy", "plotly", "rich", "scipy", "yaml")
    code = "import sys, geswarm.cli; print([m for m in sys.modules if m in sys.argv])"
    result = subprocess.run(
        [sys.executable, "-c", code, *heavy], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"
