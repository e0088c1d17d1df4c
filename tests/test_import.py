"""`geswarm import` as a user calls it."""

import io
import re
import sys
from pathlib import Path

import pytest

from geswarm.app.main import main as evolve
from geswarm.cli import main
from geswarm.sim import load_scenario
from tests.automode.machines import AAC, FLEE
from tests.automode.test_as_rules import too_many_orders

TWO = (
    "--nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 "
    "--s1 1 --n1 1 --n1x0 0 --c1x0 5 --p1x0 .02"
)
TERMS = """
from geswarm.sim.terms import Real, Whole, behaviour


@behaviour("EXPLORATION", Whole("rwm", 1, 100, "steps"))
def exploration(rwm: Real, cos: Real, sin: Real) -> tuple[Real, Real]:
    return cos, sin
"""
SCENARIO = """
extends: aac
preconditions: [FLOOR]
behaviours: [EXPLORATION, STOP, PHOTOTAXIS]
registers: ["STATE(enter0, in0, enter1, in1)"]
initial_behaviour: STOP
terms: exploration.py
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.txt").write_text(f"# found\n--fsm-config {TWO}\n")
    (tmp_path / "several.txt").write_text(f"{AAC}\n--bt-config {FLEE}\n")
    return tmp_path


def run(capsys, *arguments):
    status = main(["import", *arguments, "--from", "automode"])
    return status, *capsys.readouterr()


def test_controllers_are_shown_in_words(capsys):
    status, out, _ = run(capsys, "several.txt")
    assert status == 0
    for words in ("State machine 1", "attraction (att 3)", "to 0: white floor (p 0.25)"):
        assert words in out
    assert "with the register STATE(enter0, in0, enter1, in1, enter2, in2)." in out
    for words in ("Behaviour tree 2", "sequence*", "neighbour count (xi 4, eta 2.5)"):
        assert words in out
    _, second, _ = run(capsys, "several.txt", "--number", "2")
    assert "Behaviour tree 2" in second
    assert "State machine" not in second


def test_standard_input_is_read(capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO(TWO))
    status, out, _ = run(capsys, "-", "--as", "machine")
    assert (status, out) == (0, f"--fsm-config {TWO}\n")


def test_texts_come_back_as_they_were(capsys, folder):
    assert run(capsys, "several.txt", "--as", "machine", "-o", "again.txt")[0] == 0
    assert (folder / "again.txt").read_text() == f"--fsm-config {AAC}\n--bt-config {FLEE}\n"


def test_there_and_back_in_a_scenario(capsys, folder):
    (folder / "epuck.yaml").write_text(SCENARIO)
    (folder / "exploration.py").write_text(TERMS)
    assert run(capsys, "two.txt", "--scenario", "epuck.yaml", "-o", "two.yaml")[0] == 0
    assert "scenario: epuck\n" in (folder / "two.yaml").read_text()
    assert main(["check", "two.yaml"]) == 0
    capsys.readouterr()
    assert main(["export", "two.yaml", "--to", "automode", "--strict"]) == 0
    assert capsys.readouterr().out == f"--fsm-config {TWO}\n"


def test_the_scenario_that_the_rules_need_is_written(capsys, folder):
    both = ("--write-scenario", "mine.yaml", "-o", "two.yaml")
    assert run(capsys, "two.txt", "--scenario", "epuck-aac", *both)[0] == 0
    scenario = load_scenario("mine.yaml")
    assert scenario.registers == ("STATE(enter0, in0, enter1, in1)",)
    assert {0.02, 0.5, 1.0} <= set(scenario.probabilities)
    assert scenario.robots == load_scenario("epuck-aac").robots
    assert "scenario: mine\n" in (folder / "two.yaml").read_text()
    assert main(["check", "two.yaml", "--scenario", "mine.yaml"]) == 0
    capsys.readouterr()
    back = ["export", "two.yaml", "--to", "automode", "--strict", "--scenario", "mine.yaml"]
    assert main(back) == 0
    assert capsys.readouterr().out == f"--fsm-config {TWO}\n"


@pytest.mark.parametrize("name", ["short", "a: b # c", 'é "f"'])
def test_the_scenario_may_extend_a_file_elsewhere(capsys, folder, name):
    (folder / "base").mkdir()
    (folder / "base" / f"{name}.yaml").write_text("extends: epuck-aac\nduration: 5\n")
    (folder / "here").mkdir()
    both = ("--write-scenario", "here/mine.yaml", "-o", "two.yaml")
    assert run(capsys, "two.txt", "--scenario", f"base/{name}.yaml", *both)[0] == 0
    assert load_scenario("here/mine.yaml").duration == 5.0


def test_a_scenario_that_lacks_more_than_the_register_is_not_written(capsys, folder):
    both = ("--write-scenario", "mine.yaml", "-o", "two.yaml")
    status, out, err = run(capsys, "two.txt", "--scenario", "xor", *both)
    assert (status, out, err) == (2, "", "geswarm: xor does not offer EXPLORATION\n")
    status, out, err = run(capsys, "two.txt", *both)
    assert (status, out) == (2, "")
    assert err == "geswarm: --write-scenario: expected --scenario S and -o FILE with it\n"
    twice = ("--scenario", "epuck-aac", "--write-scenario", "a.yaml", "-o", "a.yaml")
    status, out, err = run(capsys, "two.txt", *twice)
    assert (status, out) == (2, "")
    assert err == "geswarm: --write-scenario and -o: expected two files, got a.yaml twice\n"
    assert not (folder / "mine.yaml").exists()
    assert not (folder / "a.yaml").exists()


def test_what_a_scenario_does_not_offer_is_told(capsys, folder):
    status, out, _ = run(capsys, "two.txt", "--scenario", "xor")
    assert status == 0
    assert "xor does not offer EXPLORATION, STATE\n" in out
    status, out, err = run(capsys, "two.txt", "--scenario", "xor", "-o", "two.yaml")
    assert (status, out) == (2, "")
    assert err == "geswarm: xor does not offer EXPLORATION, STATE\n"
    assert not (folder / "two.yaml").exists()


def test_values_that_a_scenario_does_not_offer_are_told(capsys, folder):
    (folder / "epuck.yaml").write_text(SCENARIO.replace(", enter1, in1", ""))
    (folder / "exploration.py").write_text(TERMS)
    _, out, _ = run(capsys, "two.txt", "--scenario", "epuck.yaml")
    assert "epuck.yaml: expected enter0 or in0, got 'enter1'" in out


def test_rules_that_do_something_else_are_not_written(capsys, folder):
    (folder / "many.txt").write_text(too_many_orders())
    status, out, err = run(capsys, "many.txt", "-o", "many.yaml")
    assert (status, out) == (1, "")
    assert err.startswith("error: AutoMoDe: state 0, black floor, ")
    assert not (folder / "many.yaml").exists()
    status, out, _ = run(capsys, "many.txt")
    assert status == 0
    assert "Rules cannot say exactly the same; the greatest differences:\n  state 0, " in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "nowhere: cannot be read: No such file or directory"),
        (["a\0b"], "a\0b: cannot be read: embedded null byte"),
        (["two.txt", "--number", "2"], "--number: expected 1 to 1, got 2"),
        (
            ["several.txt", "--as", "rules"],
            "rules: expected one controller, got 2: choose with --number",
        ),
        (
            ["several.txt", "--as", "rules", "--number", "2"],
            "rules: expected a machine, got a behaviour tree, which rules cannot say",
        ),
        (["two.txt", "-o", "/dev/null/x"], "/dev/null/x: cannot be written: Not a directory"),
    ],
)
def test_what_cannot_be_done_is_one_line(capsys, arguments, message):
    assert run(capsys, *arguments) == (2, "", f"geswarm: {message}\n")


def test_each_error_in_a_file_is_a_line(capsys, folder):
    (folder / "bad.txt").write_text("--nstates 1 --s0 0\n\n--nstates 9\n")
    status, out, err = run(capsys, "bad.txt")
    assert (status, out) == (2, "")
    assert err.splitlines() == [
        "geswarm: bad.txt:1: column 13: expected --rwm0 for --s0 (longest turn, steps), found none",
        "bad.txt:3: column 11: --nstates: expected a whole number from 1 to 4 (how many states), "
        "got '9'",
    ]
    (folder / "bytes.txt").write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in run(capsys, "bytes.txt")[2]


def test_the_guide_is_what_happens(capsys, folder):
    guide = Path(__file__).parent.parent / "static" / "guide" / "automode.md"
    text = guide.read_text(encoding="utf-8")
    (machine,) = re.findall(r"# aac\.txt\n    (.*)", text)
    (folder / "aac.txt").write_text(machine)
    (folder / "all.txt").write_text(f"{machine}\n" * 3)
    commands = re.findall(r"^    geswarm (import .*?) *#", text, re.MULTILINE)
    said = {}
    for command in map(str.strip, commands):
        assert main(command.split()) == 0
        said[command] = capsys.readouterr().out
    assert len(said) == 4
    (verdict,) = re.findall(r"^    (\d rules say .*)", text, re.MULTILINE)
    assert verdict in said["import aac.txt --from automode"]
    assert said["import aac.txt --from automode --as machine"] == f"--fsm-config {machine}\n"


@pytest.mark.long
def test_the_five_commands_of_the_guide(capsys, folder):
    guide = Path(__file__).parent.parent / "static" / "guide" / "automode.md"
    text = guide.read_text(encoding="utf-8")
    (machine,) = re.findall(r"# rests\.txt\n    (.*)", text)
    (folder / "rests.txt").write_text(machine)
    road = text[text.index("# rests.txt") : text.index("`mine.yaml` extends")]
    commands = re.findall(r"^    (geswarm\S*) (.*?)(?: *#.*)?$", road, re.MULTILINE)
    assert len(commands) == 5
    for program, arguments in commands:
        if program == "geswarm-ui":
            small = arguments.replace("--generations 25", "--generations 2 --population 10")
            assert evolve(small.split()) == 0
        else:
            assert main(arguments.split()) == 0
    assert capsys.readouterr().out.splitlines()[-1] == machine
    assert (folder / "better" / "best.yaml").exists()
