"""The kernels against the oracle: same random numbers, same trajectory."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from geswarm.rules import FORAGING, ControlTable, Rule, RuleSet, Space, load_preset
from geswarm.sim import batch, footbot
from geswarm.sim.encoding import encode_tables
from geswarm.sim.kernels import motion, state
from geswarm.sim.scenario import load_scenario
from geswarm.sim.world import World
from tests.sim import oracle
from tests.strategies import any_probabilities, plain_rule_sets, rules

CROWDED = load_scenario("flexibility-5").with_changes(
    name="crowded", robots=9, width=1.4, length=1.6, nest=0.7, source=0.7, objects=4
)
"""Many encounters, objects and walls in few steps."""

two_rule_sets = pytest.mark.parametrize("preset", ["hand-coded", "evo8"])
rule_sets = st.builds(
    RuleSet,
    st.lists(rules(any_probabilities, enabled=st.booleans()), max_size=6).map(tuple),
)


def assert_same(world, twin):
    seen = world.state
    assert (seen.picked, seen.collected, seen.lost) == (twin.picked, twin.collected, twin.lost)
    for i, robot in enumerate(twin.robots):
        assert (seen.x[i], seen.y[i]) == pytest.approx((robot.x, robot.y), abs=1e-9)
        assert abs(oracle.wrapped(seen.theta[i] - robot.theta)) < 1e-9
        assert FORAGING.behaviours[seen.behaviour[i]].name == robot.behaviour
        assert seen.internal_states[i] == oracle.bits(robot.states, FORAGING.state_index)
        assert seen.percepts[i] == oracle.bits(robot.percepts, FORAGING.precondition_index)
        assert seen.carried[i] == robot.carried
        assert seen.last_rule[i] == robot.last_rule
    np.testing.assert_allclose(seen.objects, twin.objects, atol=1e-12)


def run_both(scenario, rule_set, seed, steps, every):
    world, twin = World(scenario, rule_set, seed), oracle.Oracle(scenario, seed)
    rule_counts = [0] * len(rule_set.rules)
    action_counts = [[0] * len(rule.actions) for rule in rule_set.rules]
    decide = oracle.by_rules(rule_set, rule_counts, action_counts)
    for _ in range(0, steps, every):
        world.step(every)
        for _ in range(every):
            twin.step(decide)
        assert_same(world, twin)
    assert world.state.rule_counts.tolist() == rule_counts
    assert [list(counts) for counts in world.state.action_counts] == action_counts
    return world


@two_rule_sets
def test_world_is_the_oracle(preset):
    run_both(load_scenario("paper"), load_preset(preset), seed=5, steps=2000, every=100)


@two_rule_sets
def test_world_is_the_oracle_in_a_crowd(preset):
    world = run_both(CROWDED, load_preset(preset), seed=11, steps=400, every=10)
    assert world.collected > 0


@given(rule_sets, st.integers(0, 2**63 - 1))
@settings(max_examples=25)
def test_world_is_the_oracle_for_any_rules(rule_set, seed):
    run_both(CROWDED, rule_set, seed, steps=60, every=20)


def table_twin(scenario, rule_set, key):
    """The oracle drawing from the control table, and the table."""
    words = encode_tables([ControlTable.compile(rule_set)], scenario.zone_miss)
    twin = oracle.Oracle(scenario.with_changes(zone_miss=0.0), *key)  # the table misses zones
    return twin, oracle.by_table(words.words[0], int(words.slot_bits[0])), words


def run_batch_and_oracle(scenario, rule_set, key):
    twin, decide, words = table_twin(scenario, rule_set, key)
    for _ in range(scenario.steps):
        twin.step(decide)
    tallies = np.zeros((1, 3), dtype=np.int64)
    batch._run_one_by_one(words, scenario, np.array([(0, *key)]), tallies, None)
    assert tallies[0].tolist() == [twin.picked, twin.collected, twin.lost]
    return twin.collected


@two_rule_sets
def test_one_by_one_is_the_oracle(preset):
    scenario = CROWDED.with_changes(duration=60.0)
    assert run_batch_and_oracle(scenario, load_preset(preset), (3, 2, 1)) > 0


@given(plain_rule_sets(probabilities=any_probabilities), st.integers(0, 2**40))
@settings(max_examples=15)
def test_one_by_one_is_the_oracle_for_any_rules(rule_set, seed):
    run_batch_and_oracle(CROWDED.with_changes(duration=15.0), rule_set, (seed, 0, 0))


@given(rule_sets, st.integers(0, 1000))
@settings(max_examples=25)
def test_objects_and_walls(rule_set, seed):
    world = World(CROWDED, rule_set, seed)
    reach_x, reach_y = CROWDED.width / 2 - footbot.RADIUS, CROWDED.length / 2 - footbot.RADIUS
    for _ in range(8):
        world.step(50)
        seen = world.state
        assert seen.picked == seen.collected + seen.lost + seen.carried.sum()
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
    assert math.hypot(seen.x[0] - seen.x[1], seen.y[0] - seen.y[1]) > 0.17


def test_two_robots_never_overlap_by_more_than_a_step_allows():
    scenario = load_scenario("paper").with_changes(robots=2)
    world = World(scenario, load_preset("hand-coded"), 3)
    for _ in range(2000):
        world.step()
        seen = world.state
        assert math.hypot(seen.x[0] - seen.x[1], seen.y[0] - seen.y[1]) > 0.17 - 1e-9


def test_codes_and_bits_are_those_of_the_vocabulary():
    assert list(FORAGING.precondition_index) == ["ON_NEST", "ON_SOURCE", "HAS_OBJECT"]
    assert (state.ON_NEST, state.ON_SOURCE, state.HAS_OBJECT) == (1, 2, 4)
    index = FORAGING.behaviour_index
    assert index["PHOTOTAXIS"] == state.PHOTOTAXIS
    assert index["ANTI-PHOTOTAXIS"] == state.ANTI_PHOTOTAXIS
    assert index["RANDOM_WALK"] == state.RANDOM_WALK
    assert FORAGING.initial_behaviour == "RANDOM_WALK"
    assert [entry.name for entry in FORAGING.behaviours if entry.restarts] == ["RANDOM_WALK"]
    assert 1 << FORAGING.state_index["WANT_OBJECT"] == state.WANT_OBJECT
    assert 1 << FORAGING.state_index["DROP_OBJECT"] == state.DROP_OBJECT
    space = Space.of(FORAGING)
    initially = state.WANT_OBJECT
    assert space.initial_states == space.kept[state.DROP_OBJECT | initially] == initially
    assert len(FORAGING.behaviours) == state.BEHAVIOURS
    assert 1 << len(FORAGING.internal_states) == state.STATES


@njit
def angles(x, y):
    return np.array([motion._angle(x[k], y[k]) for k in range(len(x))])


@njit
def turns(values):
    pairs = np.empty((len(values), 2))
    for k, value in enumerate(values):
        pairs[k] = motion._cos_sin(value)
    return pairs


def test_series_are_the_functions():
    true = np.linspace(-math.pi, math.pi, 40_001)
    for scale in (1e-3, 1.0, 1e3):
        got = angles(scale * np.cos(true), scale * np.sin(true))
        error = np.angle(np.exp(1j * (got - true)))
        assert np.abs(error).max() < 2e-14
    assert angles(np.zeros(1), np.zeros(1))[0] == 0
    values = np.linspace(-1, 1, 20_001)
    np.testing.assert_allclose(turns(values)[:, 0], np.cos(values), atol=2e-16)
    np.testing.assert_allclose(turns(values)[:, 1], np.sin(values), atol=2e-16)


def test_a_contradictory_rule_never_fires():
    precondition = load_preset("evo8").rules[1].preconditions[0]
    never = type(precondition)(precondition.percept, not precondition.value)
    rule = Rule((precondition, never), (), load_preset("evo8").rules[1].actions)
    world = World(CROWDED, RuleSet((rule,)), 1)
    world.step(200)
    assert world.state.rule_counts.tolist() == [0]
