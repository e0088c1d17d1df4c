"""The kernels against the oracle: same random numbers, same trajectory."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import FORAGING, Rule, RuleSet, load_preset
from geswarm.sim import batch, footbot
from geswarm.sim.scenario.model import load_scenario
from geswarm.sim.world import World
from tests.sim import oracle
from tests.sim.controllers import controllers_for
from tests.strategies import any_probabilities, rules

CROWDED = load_scenario("flexibility-5").with_changes(
    name="crowded", robots=9, width=1.4, length=1.6, nest=0.7, source=0.7, objects=4
)
"""Many encounters, objects and walls in few steps."""

two_rule_sets = pytest.mark.parametrize("preset", ["hand-coded", "evo8"])
rule_sets = st.builds(
    RuleSet,
    st.lists(rules(any_probabilities, enabled=st.booleans()), max_size=6).map(tuple),
)


TOLERANCE = 2e-5
"""Metres and radians by which single precision may differ in the steps between two looks."""


def assert_same(world, twin):
    seen = world.state
    counted = {"picked": twin.picked, "collected": twin.collected, "lost": twin.lost}
    assert seen.measures == counted
    assert seen.fitness == twin.collected
    for i, robot in enumerate(twin.robots):
        assert (seen.x[i], seen.y[i]) == pytest.approx((robot.x, robot.y), abs=TOLERANCE)
        assert abs(oracle.wrapped(seen.theta[i] - robot.theta)) < 10 * TOLERANCE
        assert FORAGING.behaviours[seen.behaviour[i]].name == robot.behaviour
        assert seen.internal_states[i] == oracle.bits(robot.states, FORAGING.state_index)
        assert seen.percepts[i] == oracle.bits(robot.percepts, FORAGING.precondition_index)
        assert seen.carried[i] == robot.carried
        assert seen.last_rule[i] == robot.last_rule
    np.testing.assert_allclose(seen.objects, twin.objects, atol=TOLERANCE)


def go_on_from(world, twin):
    """Put the oracle's robots exactly where the world's are: rounding grows in a crowd."""
    seen = world.state
    for i, robot in enumerate(twin.robots):
        robot.x, robot.y, robot.theta = map(float, (seen.x[i], seen.y[i], seen.theta[i]))
    twin.objects = [tuple(place) for place in seen.objects.tolist()]


def run_both(scenario, rule_set, seed, steps, every):
    world, twin = World(scenario, rule_set, seed), oracle.Oracle(scenario, seed)
    rule_counts = [0] * len(rule_set.rules)
    action_counts = [[0] * len(rule.actions) for rule in rule_set.rules]
    decide = oracle.by_rules(rule_set, rule_counts, action_counts)
    for _ in range(0, steps, every):
        go_on_from(world, twin)
        world.step(every)
        for _ in range(every):
            twin.step(decide)
        assert_same(world, twin)
    assert world.state.rule_counts.tolist() == rule_counts
    assert [list(counts) for counts in world.state.action_counts] == action_counts
    return world


@two_rule_sets
def test_world_is_the_oracle(preset):
    run_both(load_scenario("paper"), load_preset(preset), seed=5, steps=2000, every=20)


@two_rule_sets
def test_world_is_the_oracle_in_a_crowd(preset):
    world = run_both(CROWDED, load_preset(preset), seed=11, steps=400, every=4)
    assert world.fitness > 0


@given(rule_sets, st.integers(0, 2**63 - 1))
@settings(max_examples=25)
def test_world_is_the_oracle_for_any_rules(rule_set, seed):
    run_both(CROWDED, rule_set, seed, steps=60, every=4)


@two_rule_sets
def test_swarms_and_lanes_are_one_source(preset):
    """By table, robots side by side do exactly what simulations side by side do."""
    for scenario in (CROWDED, load_scenario("scalability-20"), load_scenario("paper")):
        scenario = scenario.with_changes(duration=100.0)
        controllers = controllers_for([load_preset(preset)], scenario)
        simulations = np.array([(0, seed, 2, 1) for seed in range(5)])
        lanes, swarm = (np.zeros((5, 3)) for _ in range(2))
        batch._run_side_by_side(controllers, scenario, simulations, lanes, None)
        batch._run_one_by_one(controllers, scenario, simulations, swarm, None)
        assert lanes.sum() > 0
        np.testing.assert_array_equal(lanes, swarm)


@given(rule_sets, st.integers(0, 1000))
@settings(max_examples=25)
def test_objects_and_walls(rule_set, seed):
    world = World(CROWDED, rule_set, seed)
    reach_x, reach_y = CROWDED.width / 2 - footbot.RADIUS, CROWDED.length / 2 - footbot.RADIUS
    for _ in range(8):
        world.step(50)
        seen = world.state
        dropped = seen.measures["collected"] + seen.measures["lost"]
        assert seen.measures["picked"] == dropped + seen.carried.sum()
        assert np.all(np.abs(seen.x) <= reach_x)
        assert np.all(np.abs(seen.y) <= reach_y)
        assert np.all(np.isfinite(seen.theta))
        assert seen.objects.shape == (CROWDED.objects, 2)
        assert np.all(seen.objects[:, 1] >= CROWDED.length / 2 - CROWDED.source)


@given(st.lists(st.integers(0, 30), max_size=5), st.integers(0, 100))
@settings(max_examples=15)
def test_steps_add_up(parts, seed):
    one, other = (World(CROWDED, load_preset("evo8"), seed) for _ in range(2))
    for part in parts:
        one.step(part)
    other.step(sum(parts))
    for name, value in vars(one.state).items():
        if name != "action_counts":
            np.testing.assert_array_equal(value, getattr(other.state, name))
    assert one.state.action_counts == other.state.action_counts


def test_robots_at_the_very_same_place_part():
    scenario = load_scenario("paper").with_changes(robots=2)
    world, twin = World(scenario, RuleSet(), 1), oracle.Oracle(scenario, 1)
    for i in range(2):
        world.move_robot(i, 0.25, 0.5)
        twin.robots[i].x, twin.robots[i].y = 0.25, 0.5
    for _ in range(30):
        world.step()
        twin.step(oracle.by_rules(RuleSet()))
        assert_same(world, twin)
    seen = world.state
    assert math.hypot(seen.x[0] - seen.x[1], seen.y[0] - seen.y[1]) > 0.17 - 1e-6


def test_two_robots_never_overlap_by_more_than_a_step_allows():
    scenario = load_scenario("paper").with_changes(robots=2)
    world = World(scenario, load_preset("hand-coded"), 3)
    for _ in range(2000):
        world.step()
        seen = world.state
        assert math.hypot(seen.x[0] - seen.x[1], seen.y[0] - seen.y[1]) > 0.17 - 1e-6


def test_a_contradictory_rule_never_fires():
    precondition = load_preset("evo8").rules[1].preconditions[0]
    never = type(precondition)(precondition.percept, not precondition.value)
    rule = Rule((precondition, never), (), load_preset("evo8").rules[1].actions)
    world = World(CROWDED, RuleSet((rule,)), 1)
    world.step(200)
    assert world.state.rule_counts.tolist() == [0]
