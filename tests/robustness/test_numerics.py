"""What holds in any scenario within the documented ranges, under any rules."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from geswarm.rules import ControlTable, RuleSet
from geswarm.sim import CONTROL_STEP, World, evaluate, footbot, load_scenario
from geswarm.sim.scenario.checks import PARAMETERS
from geswarm.sim.scenario.model import ScenarioError
from tests.strategies import any_probabilities, rules

PAPER = load_scenario("paper")
STEPS = 30

rule_sets = st.builds(
    RuleSet, st.lists(rules(any_probabilities, enabled=st.booleans()), max_size=5).map(tuple)
)


def within(key, least=None, most=None):
    """Any value of a parameter, its ends and small ones more often, in a part of its range."""
    parameter = PARAMETERS[key]
    low = max(parameter.low, -math.inf if least is None else least)
    high = min(parameter.high, math.inf if most is None else most)
    if parameter.kind is int:
        return st.integers(int(low), int(high))
    above = parameter.above and low == parameter.low
    return st.floats(low, high, exclude_min=above) | st.floats(
        low, min(high, low + 1), exclude_min=above
    )


@st.composite
def scenarios(draw):
    """Scenarios that anybody could write down, from one robot in a tight box to a crowd."""
    small = draw(st.booleans())
    width, length = (draw(within(key, most=2.0 if small else 1e4)) for key in ("width", "length"))
    nest = length * draw(st.floats(0.01, 0.99))
    walk = sorted(draw(st.tuples(within("random_walk", most=100), within("random_walk"))))
    values = {
        "robots": draw(st.sampled_from([1, 2, 3, 4, 33, 200]) | within("robots", most=200)),
        "objects": draw(within("objects", most=200)),
        "width": width,
        "length": length,
        "nest": nest,
        "source": (length - nest) * draw(st.floats(0.01, 1.0)),
        "zone_miss": draw(st.sampled_from([0.0, 1.0, 0.08]) | within("zone_miss")),
        "object_margin": draw(st.just(0.0) | st.floats(0, width / 2)),
        "random_walk": tuple(walk),
        **{
            key: draw(st.just(getattr(PAPER, key)) | within(key))
            for key in ("light", "grip_reach", "max_speed", "turn_gain", "proximity_range",
                        "rab_range", "avoidance_gain")
        },
    }  # fmt: skip
    try:
        return PAPER.with_changes(name="any", duration=STEPS * CONTROL_STEP, **values)
    except ScenarioError:
        assume(False)


def assert_sound(world):
    """Nothing is lost, nothing is outside, nothing is undefined."""
    seen, scenario = world.state, world.scenario
    dropped = seen.measures["collected"] + seen.measures["lost"]
    assert seen.measures["picked"] == dropped + seen.carried.sum()
    for name in ("x", "y", "theta", "objects"):
        assert np.isfinite(getattr(seen, name)).all(), name
    assert np.all(np.abs(seen.x) <= scenario.width / 2 - footbot.RADIUS)
    assert np.all(np.abs(seen.y) <= scenario.length / 2 - footbot.RADIUS)
    assert seen.objects.shape == (scenario.objects, 2)
    rounding = 1e-12 * max(scenario.width, scenario.length)
    assert np.all(
        np.abs(seen.objects[:, 0]) <= scenario.width / 2 - scenario.object_margin + rounding
    )
    north = scenario.length / 2
    assert np.all(seen.objects[:, 1] >= north - scenario.source - rounding)
    assert np.all(seen.objects[:, 1] <= north - scenario.object_margin + rounding)


def same_state(one, other):
    assert one.action_counts == other.action_counts
    for name in vars(one).keys() - {"action_counts"}:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def hold_in_any_scenario(scenario, rule_set, seed, chunks):
    world, at_once = World(scenario, rule_set, seed), World(scenario, rule_set, seed)
    assert_sound(world)
    for chunk in chunks:
        world.step(chunk)
        assert_sound(world)
    at_once.step(sum(chunks))
    same_state(world.state, at_once.state)


any_chunks = st.lists(st.integers(0, 10), min_size=1, max_size=4)


@given(scenarios(), rule_sets, st.integers(0, 2**63 - 1), any_chunks)
@settings(max_examples=60)
def test_any_world_is_sound_and_does_not_depend_on_its_chunks(scenario, rule_set, seed, chunks):
    hold_in_any_scenario(scenario, rule_set, seed, chunks)


def counts_of_any_batch(scenario, rule_set, seed):
    """Counts that cannot be wrong in themselves, and are the same alone."""
    table = ControlTable.compile(rule_set)
    simulations = [(0, seed, 0, run) for run in range(3)]
    result = evaluate([table], scenario, simulations, workers=2)
    picked, collected, lost = (result.measures[name] for name in ("picked", "collected", "lost"))
    carried = picked - collected - lost
    assert np.all((carried >= 0) & (carried <= scenario.robots))
    assert np.all((collected >= 0) & (lost >= 0))
    alone = evaluate([table], scenario, simulations[1:2], workers=1)
    assert alone.measures["picked"][0] == picked[1]
    assert alone.fitness[0] == collected[1]


@given(scenarios(), rule_sets, st.integers(0, 2**63 - 1))
@settings(max_examples=40)
def test_any_batch_counts_what_there_is(scenario, rule_set, seed):
    counts_of_any_batch(scenario, rule_set, seed)


@st.composite
def roomy_scenarios(draw):
    """At most one robot per square metre, four times the paper's density."""
    robots = draw(st.integers(2, 20))
    width = draw(st.floats(0.7, 5.0))
    length = robots / width * draw(st.floats(1.0, 4.0))
    assume(length > 0.6)
    return PAPER.with_changes(
        robots=robots,
        width=width,
        length=length,
        nest=length * 0.6,
        source=length * 0.4,
        max_speed=draw(st.floats(0.01, 0.5)),
        avoidance_gain=draw(st.sampled_from([0.0, 0.1, 1.0])),
    )


def deepest_overlap(world, alone=False):
    """Of all robots, or of those that have only one other one near."""
    seen = world.state
    places = np.stack([seen.x, seen.y], axis=1)
    distances, _ = cKDTree(places).query(places, k=3)  # infinite where there are not so many
    near = 2 * footbot.RADIUS + 4 * world.scenario.max_speed * CONTROL_STEP
    counted = (distances[:, 2] > near) if alone else slice(None)
    return 2 * footbot.RADIUS - distances[counted, 1].min(initial=np.inf)


@given(roomy_scenarios(), rule_sets, st.integers(0, 1000))
@settings(max_examples=40)
def test_bodies_overlap_by_no_more_than_two_go_in_a_step(scenario, rule_set, seed):
    """As much again where there are three: the third one may push a pair together."""
    world = World(scenario, rule_set, seed)
    assume(deepest_overlap(world) <= 0)
    for _ in range(100):
        world.step()
        assert deepest_overlap(world, alone=True) <= 2 * scenario.max_speed * CONTROL_STEP
        assert deepest_overlap(world) <= 2 * 2 * scenario.max_speed * CONTROL_STEP


@pytest.mark.long
def test_many_worlds_are_sound():
    @settings(max_examples=3000)
    @given(scenarios(), rule_sets, st.integers(0, 2**63 - 1), any_chunks)
    def hold(scenario, rule_set, seed, chunks):
        hold_in_any_scenario(scenario, rule_set, seed, chunks)
        counts_of_any_batch(scenario, rule_set, seed)

    hold()
