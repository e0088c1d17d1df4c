"""The README's own terms and the pages of the guide are what they say."""

import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from geswarm.app.main import main as geswarm_ui
from geswarm.cli import main as geswarm
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import load_rule_set
from geswarm.sim import ScenarioError, load_scenario, parse_scenario, terms, vocabulary_of
from geswarm.sim.arena.file import ARENA_KEYS
from geswarm.sim.library.page import terms_page
from geswarm.sim.scenario.checks import PARAMETERS
from geswarm.sim.scenario.words import WORDS

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDE = {
    page.stem: page.read_text(encoding="utf-8")
    for page in sorted((ROOT / "static" / "guide").glob("*.md"))
}
ANYTHING = "extends: aac\n"


@pytest.fixture
def example(tmp_path, monkeypatch):
    """The files of the README's example, in the working directory."""
    blocks = re.findall(r"```\w*\n# (alone\.\w+)\n(.*?)```", README, re.DOTALL)
    assert [name for name, _ in blocks] == ["alone.yaml", "alone.py", "alone.rules"]
    for name, text in blocks:
        (tmp_path / name).write_text(f"# {name}\n{text}", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def printed(capsys, *arguments):
    assert geswarm(list(arguments)) == 0
    return capsys.readouterr().out


def test_the_example_is_short():
    (code,) = re.findall(r"```python\n# alone\.py\n(.*?)```", README, re.DOTALL)
    _, count, sensor_and_percept, behaviour, measure = re.split(r"\n\n+(?=@)", code.strip())
    for term in (f"{count}\n{sensor_and_percept}", behaviour, measure):
        assert len([line for line in term.splitlines() if line]) <= 8


def test_the_example_is_offered_as_any_term(example, capsys):
    offered = printed(capsys, "terms", "--scenario", "alone.yaml")
    for words in (
        "PACKED(k)",
        "APPROACH(pace)",
        "To the light, at a share of full speed",
        "alone",
    ):
        assert words in offered
    assert "no findings" in printed(capsys, "check", "alone.rules")
    assert "B ← APPROACH(0.5)" in printed(capsys, "show", "alone.rules")


@pytest.mark.slow
def test_the_example_runs(example, capsys):
    scenario = load_scenario("alone.yaml")
    rules = load_rule_set("alone.rules", vocabulary_of(scenario))
    (found,) = evaluate_rule_sets([rules], scenario, runs=50, seed=0)
    assert 0.70 < found.mean < 0.77  # the README says 0.74
    tiny = ["--population", "20", "--generations", "2", "--evaluations", "1", "--seed", "1"]
    headless = ["--no-ui", "--scenario", "alone.yaml", "--preset", "modern", "--workers", "1"]
    assert geswarm_ui([*headless, *tiny, "--out", "runs/alone"]) == 0
    best = load_rule_set("runs/alone/best.yaml", vocabulary_of(scenario))
    assert best.scenario == "alone"
    assert "share of" in printed(
        capsys, "evaluate", "runs/alone/best.yaml", "--scenario", "alone.yaml", "--runs", "2"
    )


def test_what_is_wrong_with_the_example_is_told_as_the_readme_says(example):
    code = (example / "alone.py").read_text(encoding="utf-8")
    clamp = " if beside < I(7) else I(7)"
    assert clamp in code
    (example / "alone.py").write_text(code.replace(clamp, ""), encoding="utf-8")
    with pytest.raises(ScenarioError) as error:
        load_scenario("alone.yaml")
    assert f"    {str(error.value).replace(f'{example}/', '')}\n" in README


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        (
            "elbow_room",
            "elbow_rom",
            "alone.py, line 6: is_beside names elbow_rom, which is",
        ),
        ("in_lit", "in_lid", "alone.py, line 26: alone names in_lid, which is"),
        ("def alone", "def alon", "measures 1: unknown measure alone; did you mean alon?"),
        (
            '"PACKED"',
            '"PACK"',
            "unknown precondition PACKED; did you mean PACK?",
        ),
        ("1, 7)", "1, 9**9)", "line 17: ValueError: k: expected at most 1000 values"),
        ("1, 7)", "'a', 7)", "line 17: ValueError: k: expected numbers, got 'a'"),
        ("crowd, Whole", "crowd, crowd, Whole", "PACKED: expected arguments Whole, Number or"),
        ("7), truth", "7), holds='{n}', truth", "PACKED: '{n}': expected one of k, compar"),
        ("7), truth", "7), fails='{', truth", "PACKED: '{': Single '{'"),
        ("values=8", "values='8'", "line 11: ValueError: expected a whole number of values"),
        ("# alone.py", "raise SystemExit", "alone.py, line 1: SystemExit"),
        ("    return I(d2", "    if d2:\n        return I(d2", "alone.py, line 8: is_beside: `if`"),
        ("to_light_y, pace", "to_light_y", "expected 3 numbers"),
        ("< I(7)", "< I(7 // 0)", "alone.py, line 14: crowd raised ZeroDivisionError"),
    ],
)
def test_other_faults_of_the_example_are_told_by_line_and_name(right, wrong, told, example):
    code = (example / "alone.py").read_text(encoding="utf-8")
    assert right in code
    (example / "alone.py").write_text(code.replace(right, wrong), encoding="utf-8")
    with pytest.raises(ScenarioError) as error:
        load_scenario("alone.yaml")
    assert told in str(error.value)


@pytest.mark.slow
def test_the_example_is_typed(example):
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "alone.py"]
    environment = {"MYPYPATH": str(ROOT), "PATH": ""}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.stdout.startswith("Success"), done.stdout + done.stderr


def blocks(page):
    """The indented blocks of a page."""
    found = re.findall(r"(?:^(?: {4}.*)?\n)+", GUIDE[page], re.MULTILINE)
    return [textwrap.dedent(each).strip() + "\n" for each in found if each.strip()]


def test_scenarios_in_the_guide_are_right():
    outlines, arena, objectives = blocks("scenarios")
    for line in outlines.splitlines():
        assert parse_scenario(f"{ANYTHING}robots: 1\n{line}")
    offered = "measures: [on_west]\nobjective: on_west\npreconditions: [ON_WEST, FLOOR]\n"
    drawn = parse_scenario(f"{ANYTHING}robots: 1\n{arena}{offered}").arena
    assert drawn.areas == ("home", "west")
    assert (len(drawn.obstacles), len(drawn.patches), len(drawn.lights)) == (3, 4, 2)
    share, signed = objectives.splitlines()
    assert parse_scenario(f"extends: aggregation\n{share}").objective.maximise
    signed = signed.replace("crowded", "on_black").replace("alone", "on_white")
    measured = parse_scenario(f"{ANYTHING}measures: [on_black, on_white]\n{signed}")
    assert not measured.objective.maximise


def test_every_key_of_scenario_files_is_in_the_guide():
    for key in ("extends", "arena", *PARAMETERS, *WORDS, *ARENA_KEYS):
        assert re.search(rf"\b{key}\b", GUIDE["scenarios"]), key


def test_own_terms_in_the_guide_are_right(tmp_path):
    (code,) = blocks("own-terms")
    names = "Bits, F, I, Integer, Real, behaviour, condition, heading, update"
    (tmp_path / "mine.py").write_text(f"from geswarm.sim.terms import {names}\n\n{code}")
    (tmp_path / "mine.yaml").write_text(
        f"{ANYTHING}terms: mine.py\nbehaviours: [RANDOM_WALK, STOP, WANDER]\n"
    )
    assert "WANDER" in vocabulary_of(load_scenario(tmp_path / "mine.yaml")).behaviour_names


def test_everything_that_own_terms_import_is_in_the_guide():
    for name in set(terms.__all__) - {"Real", "Integer", "Bits"}:
        assert re.search(rf"\b{name}\b", GUIDE["own-terms"]), name


def test_the_page_of_all_terms_is_that_of_the_library():
    """`python -m geswarm.sim.library.page > static/guide/terms.md` writes it."""
    assert GUIDE["terms"] == terms_page()


@pytest.mark.parametrize("page", ["", *GUIDE])
def test_links_lead_somewhere(page):
    text, folder = (GUIDE[page], ROOT / "static" / "guide") if page else (README, ROOT)
    for target in re.findall(r"\]\(([^):]+)\)", text):
        assert (folder / target).is_file(), target
