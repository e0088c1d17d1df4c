"""Rules one by one and control tables make the same swarm: alike in distribution."""

import numpy as np
import pytest
from scipy import stats

from geswarm.rules import load_preset, parse_text
from geswarm.sim import World, evaluate, vocabulary_of
from tests.sim.terms.scenarios import AAC, MEETING, REMEMBERING, SENSING

RULES = {
    "aac": load_preset("aac", vocabulary_of(AAC)),
    "remembering": parse_text(
        """
        rule do p = 0.1, HUNGER += 1
        rule if HUNGER >= 4 do p = 0.5, MODE = red do p = 0.2, HUNGER -= 3
        rule if ON_BLACK == true do p = 0.3, MODE = green do p = 1, HUNGER = 0
        rule if MODE == green and NEIGHBOURS >= 2 while RANDOM_WALK or ATTRACTION(2.5)
             do p = 0.2, STOP
        rule if MODE == red do p = 0.1, ATTRACTION(2.5) do p = 0.1, REPULSION(5)
        rule if MODE != green do p = 0.02, MODE = blue
        rule if MODE == blue do p = 0.1, RANDOM_WALK
        """,
        vocabulary=vocabulary_of(REMEMBERING),
    ),
    "meeting": parse_text(
        """
        rule if CROWDED(2, 1.5) == true while RANDOM_WALK do p = 0.3, STOP
        rule if ALONE(3, 2) == true while STOP do p = 0.1, MODE = green do p = 0.2, RANDOM_WALK
        rule if ALONE(1, 0.5) == false and CROWDED(3, 2) == false and MODE == green
             do p = 0.5, PHOTOTAXIS do p = 1, MODE = red
        rule if CROWDED(1, 1) == false while PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS
        rule if ON_BLACK == true do p = 0.1, RANDOM_WALK
        """,
        vocabulary=vocabulary_of(MEETING),
    ),
    "sensing": parse_text(
        """
        rule if SEES_OBSTACLE == true do p = 0.3, RANDOM_WALK(1, 5)
        rule if LIGHT < 3 while STOP or REPULSION(2) do p = 0.2, PHOTOTAXIS
        rule if FLOOR == black and HAS_OBJECT == true do p = 0.1, DROP_OBJECT = true
        rule if SEES_OBJECT == true and IS_CLOSE_TO(2) == false do p = 0.05, ANTI-PHOTOTAXIS
        rule if LIGHT >= 4 while PHOTOTAXIS do p = 0.1, REPULSION(2)
        """,
        vocabulary=vocabulary_of(SENSING),
    ),
}


@pytest.mark.parametrize(
    "scenario",
    [
        AAC,
        MEETING,
        *(pytest.param(each, marks=pytest.mark.long) for each in (REMEMBERING, SENSING)),
    ],
    ids=lambda each: each.name,
)
def test_worlds_and_batches_are_alike(scenario):
    scenario = scenario.with_changes(duration=30.0)
    rules, runs = RULES[scenario.name], range(80)
    result = evaluate([rules], scenario, [(0, seed, 0, 0) for seed in runs])
    one_by_one = []
    for seed in runs:
        world = World(scenario, rules, seed + 1000)
        world.step(scenario.steps)
        one_by_one.append(world.measures)
    assert result.fitness.std() > 0
    for name, values in result.measures.items():
        others = np.array([measures[name] for measures in one_by_one])
        if values.std() + others.std() == 0:
            continue
        assert stats.ks_2samp(values, others).pvalue > 1e-3, name
        assert stats.ttest_ind(values, others).pvalue > 1e-3, name
