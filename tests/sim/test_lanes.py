"""Simulations side by side against the oracle: single precision, the same model."""

import math

import numpy as np
import pytest
from numba import njit

from geswarm.rules import FORAGING, RuleSet, load_preset
from geswarm.sim import batch
from geswarm.sim.kernels import single
from geswarm.sim.kernels.linking import KernelCompiler
from geswarm.sim.scenario.model import load_scenario
from tests.sim import oracle
from tests.sim.controllers import controllers_for

PAPER = load_scenario("paper")
CROWDED = PAPER.with_changes(
    name="crowded", robots=6, width=1.4, length=1.6, nest=0.7, source=0.7, objects=4
)
BEHAVIOURS = [entry.name for entry in FORAGING.behaviours]


def distance_to_oracle(group, twin, lane):
    """Largest distance between a robot and its twin; infinite if their memories differ."""
    largest = 0.0
    for i, robot in enumerate(twin.robots):
        memory = [int(group.robots[name][i, lane]) for name in ("carried", "behaviour", "state")]
        states = oracle.bits(robot.states, FORAGING.state_index)
        if memory != [robot.carried, BEHAVIOURS.index(robot.behaviour), states]:
            return math.inf
        x, y = group.robots["x"][i, lane], group.robots["y"][i, lane]
        largest = max(largest, math.hypot(x - robot.x, y - robot.y))
    return largest


@pytest.mark.parametrize("preset", ["hand-coded", "evo8"])
@pytest.mark.parametrize("scenario", [PAPER, CROWDED], ids=lambda scenario: scenario.name)
def test_lanes_follow_the_oracle(scenario, preset):
    controllers = controllers_for([load_preset(preset)], scenario)
    simulations = np.array([(0, seed, 0, 0) for seed in range(16)])
    group = batch.Group(controllers, scenario, simulations)
    ideal = scenario.with_changes(zone_miss=0.0)  # the table misses zones
    twins = [oracle.Oracle(ideal, seed) for seed in range(16)]
    decide = oracle.by_table(controllers.tables)
    for first in range(0, 300, 50):
        group.run(first, 50)
        for twin in twins:
            for _ in range(50):
                twin.step(decide)
    apart = np.array([distance_to_oracle(group, twin, lane) for lane, twin in enumerate(twins)])
    # A rounding error may decide whether something happens in this step or the next.
    assert np.count_nonzero(apart < 1e-4) >= 13
    for lane in np.flatnonzero(apart < 1e-4):
        twin = twins[lane]
        counts = [int(group.measured(name)[lane]) for name in ("picked", "collected", "lost")]
        assert counts == [twin.picked, twin.collected, twin.lost]


def test_robots_at_the_very_same_place_part():
    group = batch.Group(
        controllers_for([RuleSet()], PAPER), PAPER, np.zeros((1, 4), dtype=np.int64)
    )
    group.robots["x"][:2, 0], group.robots["y"][:2, 0] = 0.25, 0.5
    group.run(0, 5)
    x, y = group.robots["x"][:, 0], group.robots["y"][:, 0]
    assert math.hypot(x[0] - x[1], y[0] - y[1]) > 0.169
    assert np.isfinite(x).all()
    assert np.isfinite(y).all()


def test_a_target_of_length_zero_is_straight_ahead():
    alone = PAPER.with_changes(robots=1)
    group = batch.Group(
        controllers_for([RuleSet()], alone), alone, np.zeros((1, 4), dtype=np.int64)
    )
    robot = group.robots
    robot["x"], robot["y"], robot["cos"], robot["sin"] = 0.0, 0.0, 0.6, 0.8
    robot["walk_x"], robot["walk_y"], robot["walk_until"] = 0.0, 0.0, 1000
    group.run(0, 1)
    assert robot["x"][0, 0] == pytest.approx(0.006)
    assert robot["y"][0, 0] == pytest.approx(0.008)


@njit(pipeline_class=KernelCompiler)
def evaluated(x, bits):
    cos, sin = np.cos(x.astype(np.float64)), np.sin(x.astype(np.float64))
    results = np.empty((len(x), 9))
    for k in range(len(x)):
        turn_cos, turn_sin = single.cos_sin(np.float32(x[k] / 2))
        along, across = single.heading(bits[k])
        results[k] = (
            single.angle_of(np.float32(cos[k]), np.float32(sin[k])),
            turn_cos,
            turn_sin,
            single.inverse_root(np.float32(np.exp(10 * x[k]))),
            along,
            across,
            single.fraction(bits[k]),
            single.inverse_root(np.float32(0.0)),
            single.half_turns(np.float32(10 * x[k])),
        )
    return results


def test_errors_of_single_precision_functions_are_within_their_bounds():
    x = np.linspace(-math.pi, math.pi, 100_001).astype(np.float32)
    bits = np.linspace(0, 2**32 - 1, len(x)).astype(np.uint32)
    angle, cos, sin, root, along, across, fraction, of_zero, turned = evaluated(x, bits).T
    wide = x.astype(np.float64)
    assert np.abs(np.angle(np.exp(1j * (angle - wide)))).max() < 3e-6
    assert np.abs(cos - np.cos(wide / 2)).max() < 6e-7
    assert np.abs(sin - np.sin(wide / 2)).max() < 6e-7
    assert np.abs(root * np.sqrt(np.exp(10 * wide)) - 1).max() < 5e-6 + 1e-6  # and of exp's input
    true = 2 * np.pi * bits / 2**32
    assert np.hypot(along - np.cos(true), across - np.sin(true)).max() < 2e-6
    assert np.abs(np.hypot(along, across) - 1).max() < 1e-6
    assert np.abs(fraction - bits / 2**32).max() < 2**-24
    assert fraction.max() < 1
    assert np.isfinite(of_zero).all()
    assert np.abs(turned).max() < math.pi + 1e-5
    assert np.abs(np.angle(np.exp(1j * (turned - 10 * wide)))).max() < 5e-6
