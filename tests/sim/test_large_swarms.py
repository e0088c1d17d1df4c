"""The pairs that are listed now and then are those that comparing each with each finds."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from geswarm.rules import RuleSet, load_preset
from geswarm.sim.controllers import encoding
from geswarm.sim.scenario.model import load_scenario
from geswarm.sim.world import World
from tests.sim import oracle

PAPER = load_scenario("paper")
CROWD = PAPER.with_changes(robots=45, width=4.0, length=3.0, nest=1.2, source=1.2, objects=20)


def world_comparing_all(monkeypatch, *arguments):
    with monkeypatch.context() as patch:
        patch.setattr(encoding, "_ALL_PAIRS_UP_TO", 10**6)
        return World(*arguments)


@pytest.mark.parametrize("rules", ["hand-coded", "evo8"])
def test_a_crowd_is_the_oracle(rules):
    rule_set = load_preset(rules)
    world, twin = World(CROWD, rule_set, 4), oracle.Oracle(CROWD, 4)
    for _ in range(60):
        world.step()
        twin.step(oracle.by_rules(rule_set))
        seen = world.state
        expected = [(robot.x, robot.y) for robot in twin.robots]
        np.testing.assert_allclose(np.stack([seen.x, seen.y], axis=1), expected, atol=1e-4)
    counted = {"picked": twin.picked, "collected": twin.collected, "lost": twin.lost}
    assert world.measures == counted
    np.testing.assert_allclose(world.state.objects, twin.objects, atol=1e-6)


@given(
    st.integers(33, 120),
    st.floats(1.5, 30.0),
    st.floats(2.0, 12.0),
    st.sampled_from([0.05, 0.5, 3.0, 100.0]),
    st.integers(0, 100),
)
@settings(max_examples=25, deadline=None)
def test_listed_and_all_pairs_are_the_same_in_any_arena(robots, width, length, rab_range, seed):
    with pytest.MonkeyPatch.context() as patch:
        scenario = PAPER.with_changes(
            robots=min(robots, int(20 * width)),
            width=width,
            length=length,
            nest=length / 2,
            source=length / 2,
            rab_range=rab_range,
        )
        one = World(scenario, RuleSet(), seed)
        other = world_comparing_all(patch, scenario, RuleSet(), seed)
    for _ in range(5):
        one.step()
        other.step()
        assert np.array_equal(one.state.x, other.state.x)
        assert np.array_equal(one.state.y, other.state.y)


def deepest_overlap(world):
    seen = world.state
    distances, _ = cKDTree(np.stack([seen.x, seen.y], axis=1)).query(
        np.stack([seen.x, seen.y], axis=1), k=2
    )
    return max(0.0, 0.17 - distances[:, 1].min())


@pytest.mark.parametrize(("avoidance_gain", "tolerance"), [(1.0, 0.001), (0.0, 0.01)])
def test_no_overlap_is_left_in_a_crowd(avoidance_gain, tolerance):
    scenario = PAPER.with_changes(
        robots=2000, width=30.0, length=30.0, nest=12.0, source=10.0, objects=1000
    ).with_changes(avoidance_gain=avoidance_gain)
    world = World(scenario, load_preset("hand-coded"), 1)
    overlaps = []
    for _ in range(100):
        world.step(5)
        overlaps.append(deepest_overlap(world))
    assert max(overlaps) < tolerance
    assert np.median(overlaps) < 1e-4


def test_many_objects_are_found():
    scenario = PAPER.with_changes(
        robots=400, width=40.0, length=6.0, nest=2.0, source=3.5, objects=3000
    )
    world = World(scenario, load_preset("evo8"), 2)
    for _ in range(40):
        world.step(25)
        before = world.state
        world.step()
        seen = world.state
        wanted = ~before.carried & (seen.internal_states & 1).astype(bool)
        gaps, _ = cKDTree(before.objects).query(np.stack([before.x, before.y], axis=1))
        takes = seen.carried & ~before.carried
        assert np.all(gaps[takes] <= scenario.grip_reach + 1e-6)
        # An object may have been taken by another robot in the same step.
        missed = wanted & ~seen.carried & (gaps <= scenario.grip_reach)
        assert missed.sum() <= takes.sum()
    assert world.measures["picked"] > 100
    north = scenario.length / 2
    objects = world.state.objects
    assert np.all((objects[:, 1] >= north - scenario.source) & (objects[:, 1] <= north))
    assert math.isclose(np.ptp(objects[:, 0]), scenario.width, rel_tol=0.02)
