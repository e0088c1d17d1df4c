"""AutoMoDe's modules and small machines in aac's arena do what they do in the real stack.

`epuck_reference.json` holds means and deviations of runs of argos3-epuck 48 with reference model
1.2; [mean, deviation] over runs of speed (m/s), turn rate (rad/s), distance to the nearest
neighbour (m) and the share of robot-steps without motion.
"""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest

from geswarm.automode import read_machines
from geswarm.sim import load_scenario, parts_of
from geswarm.sim.batch import Group
from geswarm.sim.controllers.tables import compile_controllers

REFERENCE = json.loads(Path(__file__).with_name("epuck_reference.json").read_text())
RUNS, SEED = 48, 7
pytestmark = pytest.mark.long


def group_of(case):
    scenario = load_scenario("epuck-aac")
    arena = scenario.arena if case["lit"] else dataclasses.replace(scenario.arena, lights=())
    numbers = tuple(case["numbers"].items())
    changes = {"robots": case["robots"], "rab_range": case["rab_range"], "numbers": numbers}
    scenario = scenario.with_changes(arena=arena, **changes)
    parts = parts_of(scenario)
    sure = [0.0] * len(parts.sensors)
    controllers = compile_controllers(read_machines(case["machine"]), sure, parts)
    return Group(controllers, scenario, np.array([(0, SEED, 0, run) for run in range(RUNS)]))


def poses(group):
    x, y = (group.robots[name][:, :RUNS].astype(np.float64) for name in ("x", "y"))
    return x, y, np.arctan2(group.robots["sin"], group.robots["cos"])[:, :RUNS]


def statistics_of(group):
    """The objective of each run, and the mean of each statistic."""
    group.run(0, 1)
    before, sums = poses(group), dict.fromkeys(("speed", "still", "turn_rate", "nn"), 0.0)
    for step in range(1, 1200):
        group.run(step, 1)
        x, y, heading = poses(group)
        went = np.hypot(x - before[0], y - before[1])
        turned = (heading - before[2] + math.pi) % (2 * math.pi) - math.pi
        sums["speed"] += 10 * went.mean()
        sums["still"] += (went < 5e-4).mean()
        sums["turn_rate"] += 10 * np.abs(turned).mean()
        if len(x) > 1 and step % 10 == 0:
            apart = np.hypot(x[:, None] - x[None], y[:, None] - y[None])
            sums["nn"] += 10 * (apart + 9.0 * np.eye(len(x))[:, :, None]).min(axis=0).mean()
        before = x, y, heading
    return group.measured("on_black")[:RUNS], {name: each / 1199 for name, each in sums.items()}


@pytest.mark.parametrize("case", REFERENCE, ids=[each["controller"] for each in REFERENCE])
def test_figures_agree_with_the_real_stack(case):
    objective, found = statistics_of(group_of(case))
    error = math.hypot(case["sd"] / math.sqrt(case["runs"]), objective.std() / math.sqrt(RUNS))
    assert objective.mean() == pytest.approx(case["mean"], rel=0.1, abs=2.0 * error)
    for name, value in found.items():
        mean, deviation = case[name]
        error = deviation / math.sqrt(case["runs"])
        assert value == pytest.approx(mean, rel=0.1, abs=max(2.0 * error, 0.01)), name
