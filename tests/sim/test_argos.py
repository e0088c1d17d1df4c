"""Collected objects agree with ARGoS 3, which ran the same scenarios and rules 20 times each."""

import json
import re
from pathlib import Path

import pytest
from scipy import stats

from geswarm.rules import ControlTable, load_preset
from geswarm.sim import batch
from geswarm.sim.batch import evaluate
from geswarm.sim.scenario.model import load_scenario
from geswarm.sim.world import World

CASES = json.loads(Path(__file__).with_name("argos_reference.json").read_text())["cases"]
RUNS = 50
TOLERANCE = 0.08


def scenario_of(case):
    name, *miss = re.split(r" with zone_miss ", case["scenario"])
    scenario = load_scenario(name)
    return scenario.with_changes(zone_miss=float(miss[0])) if miss else scenario


def name_of(case):
    return f"{case['scenario']}, {case['rules']}"


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_batch_agrees_with_argos(case):
    table = ControlTable.compile(load_preset(case["rules"]))
    runs = [(0, seed, 0, 0) for seed in range(1, RUNS + 1)]
    result = evaluate([table], scenario_of(case), runs)
    assert result.fitness.mean() == pytest.approx(case["mean"], rel=TOLERANCE)
    assert result.measures["lost"].sum() == case["lost"]


@pytest.mark.slow
@pytest.mark.parametrize("rules", ["hand-coded", "evo8"])
def test_world_agrees_with_argos(rules):
    (case,) = (c for c in CASES if (c["scenario"], c["rules"]) == ("paper", rules))
    scenario = scenario_of(case)
    collected = []
    for seed in range(1, RUNS + 1):
        world = World(scenario, load_preset(rules), seed)
        world.step(scenario.steps)
        collected.append(world.fitness)
    assert sum(collected) / RUNS == pytest.approx(case["mean"], rel=TOLERANCE)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_both_ways_of_running_have_the_same_distribution(case, monkeypatch):
    table = ControlTable.compile(load_preset(case["rules"]))
    scenario = scenario_of(case)
    runs = [(0, seed, 0, 0) for seed in range(300)]
    side_by_side = evaluate([table], scenario, runs).fitness
    monkeypatch.setattr(batch, "runs_side_by_side", lambda _: False)
    one_by_one = evaluate([table], scenario, runs).fitness
    assert stats.ks_2samp(side_by_side, one_by_one).pvalue > 1e-3
    assert stats.ttest_ind(side_by_side, one_by_one).pvalue > 1e-3
    assert side_by_side.mean() == pytest.approx(case["mean"], rel=TOLERANCE)
