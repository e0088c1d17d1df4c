"""Where robots and objects start: nobody inside another, everything within reach."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from geswarm.rules import RuleSet, load_preset
from geswarm.sim import World, batch, footbot, load_scenario
from geswarm.sim.scenario.checks import robots_in_nest
from geswarm.sim.scenario.model import ScenarioError
from tests.sim import oracle
from tests.sim.controllers import controllers_for

PAPER = load_scenario("paper")
EVO8 = load_preset("evo8")
ROUNDING = 4e-6  # m: positions are kept in single precision
crowds = pytest.mark.parametrize("robots", [110, 150, 200, 216])


@st.composite
def dense_scenarios(draw, most=300):
    """From one robot to as many as the nest has room for, dense ones more often."""
    width, nest = draw(st.floats(0.18, 12.0)), draw(st.floats(0.09, 5.0))
    length = nest + draw(st.floats(0.1, 3.0))
    room = min(most, robots_in_nest(width, length, nest))
    assume(room > 0)
    return PAPER.with_changes(
        robots=draw(st.integers(1, room) | st.integers(max(1, room // 2), room) | st.just(room)),
        width=width,
        length=length,
        nest=nest,
        source=length - nest,
        object_margin=0.0,
        objects=draw(st.integers(1, 50)),
        grip_reach=draw(st.sampled_from([0.12, 0.05, 0.2])),
    )


def assert_apart_in_the_nest(scenario, x, y):
    places = np.column_stack((x, y)).astype(float)
    if len(places) > 1:
        assert cKDTree(places).query(places, k=2)[0][:, 1].min() >= 2 * footbot.RADIUS - ROUNDING
    reach = scenario.width / 2 - footbot.RADIUS
    assert np.abs(x).max() <= reach + ROUNDING
    assert np.min(y) >= footbot.RADIUS - scenario.length / 2 - ROUNDING
    assert np.max(y) <= scenario.nest - scenario.length / 2 + ROUNDING
    assert np.max(y) <= scenario.length / 2 - footbot.RADIUS + ROUNDING


def assert_starts_well(world):
    scenario, seen = world.scenario, world.state
    assert_apart_in_the_nest(scenario, seen.x, seen.y)
    reach = (scenario.width / 2 - footbot.RADIUS, scenario.length / 2 - footbot.RADIUS)
    nearest = np.clip(seen.objects, np.negative(reach), reach)
    gaps = np.hypot(*(seen.objects - nearest).T)
    assert gaps.max() <= scenario.grip_reach + ROUNDING
    assert seen.objects[:, 1].min() >= scenario.length / 2 - scenario.source - ROUNDING


@given(dense_scenarios(), dense_scenarios(), st.integers(0, 2**63 - 1))
@settings(max_examples=80)
def test_nobody_starts_inside_another_in_any_scenario(scenario, other, seed):
    world = World(scenario, RuleSet(), seed)
    assert_starts_well(world)
    world.step(3)
    world.reset(seed ^ 1)
    assert_starts_well(world)
    world.set_scenario(other)
    if world.steps == 0:
        assert_starts_well(world)


@crowds
def test_a_nest_that_is_nearly_full(robots):
    for seed in range(3):
        world = World(PAPER.with_changes(robots=robots), EVO8, seed)
        assert_starts_well(world)
        world.step(20)
        assert np.isfinite(world.state.x).all()


def test_a_large_swarm_that_is_dense():
    scenario = PAPER.with_changes(robots=10_000, width=30.0, length=20.0, nest=11.0, source=9.0)
    assert robots_in_nest(30.0, 20.0, 11.0) == 11_440
    assert_starts_well(World(scenario, EVO8, 1))


def test_lanes_start_apart():
    scenario = PAPER.with_changes(robots=24, width=1.5, nest=0.6)
    assert robots_in_nest(1.5, 4.2, 0.6) == 32
    controllers = controllers_for([EVO8], scenario)
    group = batch.Group(controllers, scenario, np.array([(0, seed, 0, 0) for seed in range(64)]))
    for lane in range(64):
        x, y = group.robots["x"][:, lane], group.robots["y"][:, lane]
        assert_apart_in_the_nest(scenario, x, y)


@crowds
def test_the_oracle_starts_where_the_world_does(robots):
    scenario = PAPER.with_changes(robots=robots)
    twin, seen = oracle.Oracle(scenario, 7), World(scenario, EVO8, 7).state
    expected = [(robot.x, robot.y, oracle.wrapped(robot.theta)) for robot in twin.robots]
    np.testing.assert_allclose(np.column_stack((seen.x, seen.y, seen.theta)), expected, atol=1e-6)


def test_full_nests_differ_between_seeds_and_robots_head_anywhere():
    scenario = PAPER.with_changes(robots=150)
    one, other = (World(scenario, EVO8, seed).state for seed in (1, 2))
    assert np.abs(one.x - other.x).max() > 0.01
    assert np.ptp(one.theta) > 6.0


def test_one_more_than_fits_is_refused():
    with pytest.raises(ScenarioError, match="217 do not fit in the nest, which has room for 216"):
        PAPER.with_changes(robots=217)


def test_a_source_too_shallow_to_reach_into_is_refused():
    with pytest.raises(ScenarioError, match=r"margin of 0\.0779289 m, without which none reaches"):
        PAPER.with_changes(source=0.05, grip_reach=0.01, object_margin=0.0)
