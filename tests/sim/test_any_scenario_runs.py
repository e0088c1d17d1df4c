"""Whatever a scenario is made of: robots stay inside, numbers are numbers, objects add up."""

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from geswarm.rules import RuleSet
from geswarm.sim import Objective, ScenarioError, World, evaluate
from geswarm.sim.arena.geometry import distances
from geswarm.sim.footbot import RADIUS
from geswarm.sim.terms.ground import GroundError
from geswarm.sim.terms.parts import PartsError
from tests.sim.any_scenario import scenarios

STEPS = 60


def is_sound(scenario, seed):
    world = World(scenario, RuleSet(), seed)
    world.step(STEPS)
    state = world.state
    for values in (state.x, state.y, state.theta, state.objects, list(state.measures.values())):
        assert np.isfinite(values).all()
    places = np.column_stack((state.x, state.y))
    assert (distances(scenario.arena.outline, places) <= 1e-6).all()
    for obstacle in scenario.arena.obstacles:
        assert (distances(obstacle, places) >= 0.99 * RADIUS).all()
    if scenario.objects:
        measures = state.measures
        known = {"picked", "collected", "lost"} <= measures.keys()
        carried = int(state.carried.sum())
        assert not known or measures["picked"] == measures["collected"] + measures["lost"] + carried
    small = scenario.with_changes(duration=STEPS * 0.1)
    simulations = [(0, seed, 0, k) for k in range(3)]
    one, two = (evaluate([RuleSet()], small, simulations, workers=n) for n in (1, 2))
    np.testing.assert_array_equal(one.fitness, two.fitness)


@st.composite
def sensible(draw):
    """Any arena and numbers, with terms of the library."""
    scenario = draw(scenarios())
    areas = [f"ON_{area.upper()}" for area in scenario.arena.areas]
    known = [*areas, "SEES_OBSTACLE", "IS_CLOSE_TO", "NEIGHBOURS"]
    behaviours = ["RANDOM_WALK", "STOP", "ATTRACTION", "REPULSION"]
    if scenario.arena.lights:
        known, behaviours = [*known, "LIGHT"], [*behaviours, "PHOTOTAXIS", "ANTI-PHOTOTAXIS"]
    registers, measures = ["HUNGER(0..5)"], [f"on_{area}" for area in scenario.arena.areas]
    if scenario.objects and {"nest", "source"} <= set(scenario.arena.areas):
        known, measures = [*known, "HAS_OBJECT", "SEES_OBJECT"], ["picked", "collected", "lost"]
        registers += ["WANT_OBJECT", "DROP_OBJECT"]
    assume(measures)
    try:
        return scenario.with_changes(
            robots=draw(st.integers(1, 12)),
            objects=scenario.objects if "picked" in measures else 0,
            preconditions=draw(
                st.lists(st.sampled_from(known), min_size=1, max_size=4, unique=True)
            ),
            behaviours=["RANDOM_WALK", *draw(st.sets(st.sampled_from(behaviours[1:]), max_size=3))],
            initial_behaviour="RANDOM_WALK",
            registers=registers,
            measures=measures,
            objective=Objective(measures[0]),
            reference="",
        )
    except ScenarioError:  # so many do not fit
        assume(False)


@pytest.mark.long
@given(scenario=sensible(), seed=st.integers(0, 2**31))
@settings(
    max_examples=12,
    deadline=None,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)
def test_any_scenario_is_sound(scenario, seed):
    try:
        World(scenario, RuleSet(), seed)
    except (GroundError, PartsError):
        return  # told, and not run
    is_sound(scenario, seed)
