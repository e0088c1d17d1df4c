"""Measures of areas and groups against counting, step by step."""

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from geswarm.rules import load_preset
from geswarm.sim import World, batch, evaluate, parts_of
from geswarm.sim.batch import runs_side_by_side
from tests.sim.assembly import ground_twin
from tests.sim.controllers import controllers_for
from tests.sim.terms.scenarios import REMEMBERING

AREAS = ("black", "white")
RULES = load_preset("aac", parts_of(REMEMBERING).vocabulary)
DOUBT = 1e-5


class Counted:
    """What the measures must be, from places after each step; `unsure` robots were on an edge."""

    def __init__(self):
        self.on = dict.fromkeys(AREAS, 0)
        self.larger = self.most = self.unsure = 0

    def look(self, x, y):
        numbers = []
        for name in AREAS:
            found = [
                ground_twin.in_area(REMEMBERING.arena, name, *at) for at in zip(x, y, strict=True)
            ]
            numbers.append(sum(inside for inside, _ in found))
            self.on[name] += numbers[-1]
            self.unsure += sum(doubt < DOUBT for _, doubt in found)
        self.most = max(numbers)
        self.larger += self.most

    def agrees(self, measures):
        assert measures.keys() == {"on_black", "on_white", "larger_group", "max_group"}
        for name, expected in (
            *((f"on_{name}", self.on[name]) for name in AREAS),
            ("larger_group", self.larger),
            ("max_group", self.most),
        ):
            assert abs(measures[name] - expected) <= self.unsure


@given(st.sampled_from([1, 20, 64, 70]), st.integers(0, 2**32))
@settings(max_examples=6, deadline=None, phases=[Phase.generate])
def test_a_world_measures_what_can_be_counted(robots, seed):
    world, counted = World(REMEMBERING.with_changes(robots=robots), RULES, seed), Counted()
    for _ in range(40):
        world.step()
        seen = world.state
        counted.look(seen.x.tolist(), seen.y.tolist())
        counted.agrees(world.measures)
        assert seen.measures == world.measures
        assert world.fitness == world.measures["on_black"]
    world.reset()
    assert set(world.measures.values()) == {0}


@given(st.integers(0, 2**32), st.lists(st.integers(1, 3), min_size=10, max_size=10))
@settings(max_examples=3, deadline=None, phases=[Phase.generate])
def test_simulations_side_by_side_measure_what_can_be_counted(seed, parts):
    controllers = controllers_for([RULES], REMEMBERING)
    group = batch.Group(controllers, REMEMBERING, np.array([(0, seed, 0, run) for run in range(3)]))
    first, counted = 0, [Counted() for _ in range(3)]
    for part in parts:
        for _ in range(part):
            group.run(first, 1)
            first += 1
            for lane, each in enumerate(counted):
                each.look(group.robots["x"][:, lane].tolist(), group.robots["y"][:, lane].tolist())
    names = [each.name for each in parts_of(REMEMBERING).measures]
    for lane, each in enumerate(counted):
        each.agrees({name: group.measured(name)[lane] for name in names})


@pytest.mark.parametrize("robots", [20, 65])
def test_both_layouts_give_the_objective_of_their_measures(robots):
    scenario = REMEMBERING.with_changes(robots=robots, duration=10.0)
    assert runs_side_by_side(scenario) == (robots == 20)
    result = evaluate([RULES], scenario, [(0, seed, 0, 0) for seed in range(4)])
    measures = result.measures
    np.testing.assert_array_equal(result.fitness, measures["on_black"])
    together = measures["on_black"] + measures["on_white"]
    assert np.all(measures["larger_group"] <= together)
    assert np.all(measures["larger_group"] >= together / 2)
    assert np.all(measures["max_group"] <= robots)
    assert result.fitness.max() > 0
