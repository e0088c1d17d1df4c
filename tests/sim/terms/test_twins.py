"""Each sensor and each behaviour against plain Python, in random worlds."""

import math

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from geswarm.rules import BehaviourChange, Precondition, Rule, RuleSet, StateChange, Term
from geswarm.sim import World, parts_of
from geswarm.sim.footbot import RADIUS
from tests.sim import oracle
from tests.sim.assembly import ground_twin
from tests.sim.terms import twin
from tests.sim.terms.scenarios import SENSING

CYCLE = (
    Term("STOP"),
    Term("PHOTOTAXIS"),
    Term("ATTRACTION", (2.5,)),
    Term("RANDOM_WALK", (0.0, 5.0)),
    Term("REPULSION", (5.0,)),
    Term("RANDOM_WALK", (1.0, 5.0)),
    Term("ANTI-PHOTOTAXIS"),
    Term("ATTRACTION", (1.0,)),
)
AROUND = RuleSet(
    (
        *(
            Rule((), (before,), (BehaviourChange(0.2, after),))
            for before, after in reversed(list(zip(CYCLE, (*CYCLE[1:], CYCLE[0]), strict=True)))
        ),
        Rule((), (), (StateChange(0.05, "DROP_OBJECT", True),)),
    )
)
"""From each behaviour to the next, never from one to itself in one step."""
worlds = st.builds(
    lambda robots, seed: World(SENSING.with_changes(robots=robots), AROUND, seed),
    st.integers(1, 14),
    st.integers(0, 2**32),
)


@given(worlds)
@settings(max_examples=8, deadline=None, phases=[Phase.generate])
def test_robots_read_what_is_there(world):
    scenario = world.scenario
    for _ in range(25):
        before = world.state
        world.step()
        after = world.state
        for i in range(scenario.robots):
            possible = twin.readings(scenario, before, i)
            found = world.perceived(after.percepts[i])
            assert found.keys() == possible.keys()
            for name, value in found.items():
                assert value in possible[name], (name, i)
        world.step(4)


def test_comparisons_of_one_reading():
    vocabulary = parts_of(SENSING).vocabulary
    for near in range(8):
        for k in range(1, 8):
            close = Precondition(Term("IS_CLOSE_TO", (k,)), True)
            assert vocabulary.holds(close, near) == (near >= k)
            assert vocabulary.holds(Precondition("NEIGHBOURS", k, "<"), near) == (near < k)
    assert vocabulary.holds(Precondition("FLOOR", "black", "!="), "white")
    assert vocabulary.holds(Precondition("LIGHT", 2, ">="), 2)


def is_free(scenario, places, i):
    """Whether robot i touches nobody and nothing, for sure."""
    gaps = [d - 2 * RADIUS for _, _, d in twin.others(places, i)]
    gaps.append(ground_twin.clearance(scenario.arena, *places[i]) - RADIUS)
    return min(gaps) > 2 * scenario.max_speed * 0.1


@given(worlds)
@settings(max_examples=8, deadline=None, phases=[Phase.generate])
def test_robots_move_as_their_behaviours_say(world):
    scenario, walks, compared = world.scenario, twin.Walks(world), set()
    for step in range(60):
        before = world.state
        world.step()
        after = world.state
        places = list(zip(before.x.tolist(), before.y.tolist(), strict=True))
        for i in range(scenario.robots):
            was, term = (state.behaviours[state.instance[i]] for state in (before, after))
            walk = None
            if term.name == "RANDOM_WALK":
                walk = walks.target(i, term, step, was != term)
            pose = (*places[i], float(before.theta[i]))
            sure = True
            if term.name != "STOP":
                to = twin.target(scenario, places, i, term, walk)
                pose, sure = twin.moved(scenario, places, pose[2], i, to)
            if sure and is_free(scenario, places, i):
                compared.add(term.name)
                assert (after.x[i], after.y[i]) == pytest.approx(pose[:2], abs=1e-5), term
                assert abs(oracle.wrapped(after.theta[i] - pose[2])) < 2e-4, term
    assert compared


def test_attraction_gathers_and_repulsion_spreads():
    def spread(behaviour):
        rules = RuleSet((Rule((), (), (BehaviourChange(1.0, behaviour),)),))
        world = World(SENSING.with_changes(robots=6, rab_range=3.0), rules, 4)
        world.step(400)
        x, y = world.state.x, world.state.y
        return math.hypot(x.std(), y.std())

    assert spread(Term("ATTRACTION", (5.0,))) < 0.8 * spread(Term("REPULSION", (5.0,)))
