"""The examples in docstrings and in the README do what they say."""

import doctest
import re
from pathlib import Path

import pytest

import geswarm.analysis
import geswarm.automode
import geswarm.automode.machine
import geswarm.evolution
import geswarm.exports
import geswarm.ge
import geswarm.rules
import geswarm.rules.state_machine
import geswarm.sim


@pytest.mark.parametrize(
    "module",
    [
        geswarm.automode,
        geswarm.automode.machine,
        geswarm.rules,
        geswarm.exports,
        geswarm.rules.state_machine,
        geswarm.sim,
        geswarm.ge,
        geswarm.evolution,
        geswarm.analysis,
    ],
    ids=lambda module: module.__name__,
)
def test_docstring_examples_are_true(module):
    results = doctest.testmod(module)
    assert results.failed == 0 < results.attempted


def test_the_python_of_the_readme_runs(tmp_path, monkeypatch, capsys):
    """As it stands, but for fewer generations."""
    text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (example,) = [each for each in examples if "EvolutionRun" in each]
    assert "generations=30" in example
    monkeypatch.chdir(tmp_path)
    exec(compile(example.replace("generations=30", "generations=1"), "README.md", "exec"), {})
    assert "Comparison(" in capsys.readouterr().out
    assert (tmp_path / "best.yaml").exists()
    run = geswarm.evolution.EvolutionRun.read("runs/mine")
    assert len(run.history) == 1
    assert run.population()
    assert run.genealogy()
    assert run.best == geswarm.rules.load_rule_set("best.yaml")
