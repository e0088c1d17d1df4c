"""Files that an older version wrote are read, continued and run; those of a newer one are not."""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from geswarm.evaluation import evaluate_rule_sets
from geswarm.evolution import EvolutionRun
from geswarm.ge import Injection, SettingsChange, StoreError
from geswarm.rules import RuleSetError, load_preset, load_rule_set, same_behaviour
from geswarm.sim import load_scenario

FILES = Path(__file__).parent / "files"
VERSIONS = sorted(path.name for path in FILES.iterdir())


@pytest.fixture(params=VERSIONS)
def older(request, tmp_path):
    """A copy of the files of one version."""
    return shutil.copytree(FILES / request.param, tmp_path / "older")


def rows(directory):
    return (directory / "history.csv").read_text().splitlines()


def test_a_run_is_opened_continued_and_evaluated(older):
    directory = older / "run"
    before = rows(directory)
    assert len(before) == 1 + 4
    run = EvolutionRun.resume(directory)
    assert rows(directory) == before
    assert (run.config.seed, run.config.scenario.duration) == (7, 1500.0)
    assert run.config.settings.selection == "tournament"
    assert [type(one.what) for one in run.steering] == [SettingsChange, Injection]
    assert run.settings.mutation == 0.4
    frozen = run.config.frozen
    assert len(frozen) == 1
    assert len(run.population().members) == 6
    assert run.genealogy()
    run.run()
    assert run.finished
    run.close()
    assert rows(directory)[:5] == before
    assert len(rows(directory)) == 1 + 6
    best = load_rule_set(str(directory / "best.yaml"))
    assert best.rules[:1] == frozen
    (evaluation,) = evaluate_rule_sets([best], run.config.scenario, runs=2)
    assert evaluation.mean >= 0


def test_the_best_so_far_is_what_it_was(older):
    before = load_rule_set(str(older / "run" / "best.yaml"))
    EvolutionRun.resume(older / "run").close()
    after = load_rule_set(str(older / "run" / "best.yaml"))
    assert after.rules == before.rules
    assert after.origin.fitness == before.origin.fitness > 0


@pytest.mark.parametrize("form", ["yaml", "rules", "json"])
def test_rules_mean_what_they_meant(older, form):
    rule_set = load_rule_set(str(older / f"evo8.{form}"))
    assert same_behaviour(rule_set, load_preset("evo8"))
    assert rule_set.name == "EVO 8"
    assert rule_set.origin.preset == "evo8"
    assert all(rule.comment for rule in rule_set.rules)


def test_a_scenario_means_what_it_meant(older):
    scenario = load_scenario(older / "scenario.yaml")
    assert (scenario.robots, scenario.width, scenario.length) == (6, 3.0, 2.4)
    assert (scenario.zone_miss, scenario.random_walk) == (0.02, (2.0, 8.0))
    assert (scenario.objects, scenario.nest, scenario.source) == (3, 0.75, 1.0)


def test_files_of_a_newer_version_are_refused(older):
    with closing(sqlite3.connect(older / "run" / "run.db")) as database:
        database.execute("PRAGMA user_version = 99")
    before = (older / "run" / "run.db").read_bytes()
    with pytest.raises(StoreError, match="found 99; this run was made by a newer GESwarm"):
        EvolutionRun.resume(older / "run")
    assert (older / "run" / "run.db").read_bytes() == before
    for name, old, new in (
        ("evo8.yaml", "schema: 1", "schema: 2"),
        ("evo8.json", '"schema": 1', '"schema": 3'),
    ):
        path = older / name
        path.write_text(path.read_text().replace(old, new))
        with pytest.raises(RuleSetError, match=r"expected schema [12], got [23]"):
            load_rule_set(str(path))
