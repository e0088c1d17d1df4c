"""The reachable situations against a search with the oracle, and against the simulator."""

import numpy as np
import pytest
from hypothesis import given, settings

from geswarm.rules import FORAGING, ControlTable, Space, load_preset
from geswarm.rules.reachability import Trace, effective_outcomes, reachable_situations
from geswarm.sim import World, load_scenario
from tests.rules.oracle import effects as oracle_effects
from tests.rules.oracle import reachable
from tests.strategies import plain_rule_sets

SPACE = Space.of(FORAGING)
SHAPE = (SPACE.percepts, SPACE.starts, SPACE.outcomes)
SENSED = tuple(FORAGING.precondition_index)
STATES = tuple(FORAGING.state_index)


def marked(rule_set):
    return reachable_situations(ControlTable.compile(rule_set).by_percepts, SPACE)


def expected(rule_set):
    found = np.zeros(SHAPE[:2], dtype=bool)
    for percepts, behaviour, states in reachable(rule_set):
        bits = sum(percepts[name] << bit for bit, name in enumerate(SENSED))
        inner = sum((name in states) << bit for bit, name in enumerate(STATES))
        found[bits, FORAGING.behaviour_index[behaviour] * SPACE.states + inner] = True
    return found


@pytest.mark.parametrize("name", ["hand-coded", "evo8"])
def test_presets_reach_what_the_oracle_finds(name):
    np.testing.assert_array_equal(marked(load_preset(name)), expected(load_preset(name)))


@settings(max_examples=15, deadline=None)
@given(plain_rule_sets(max_rules=2))
def test_any_rule_set_reaches_what_the_oracle_finds(rule_set):
    np.testing.assert_array_equal(marked(rule_set), expected(rule_set))


@settings(max_examples=25, deadline=None)
@given(plain_rule_sets())
def test_a_trace_ends_with_the_effects_of_the_control_table(rule_set):
    trace = Trace.of(rule_set)
    table = ControlTable.compile(rule_set).by_percepts @ effective_outcomes(SPACE)
    for at in range(len(trace.rules) + 1):
        whole = trace.before[at] @ trace.after[at]
        np.testing.assert_allclose(whole, table * trace.reachable[:, :, None], atol=1e-14)


@settings(max_examples=15, deadline=None)
@given(plain_rule_sets(max_rules=2))
def test_a_trace_ends_with_the_effects_that_the_oracle_finds(rule_set):
    decided = Trace.of(rule_set).decided
    for percepts, behaviour, states in reachable(rule_set):
        bits = sum(percepts[name] << bit for bit, name in enumerate(SENSED))
        inner = sum((name in states) << bit for bit, name in enumerate(STATES))
        column = FORAGING.behaviour_index[behaviour] * SPACE.states + inner
        wanted = np.zeros(SPACE.outcomes)
        for (after, true_states, restarted), p in oracle_effects(
            rule_set, percepts, behaviour, states
        ).items():
            states_after = sum((name in true_states) << bit for bit, name in enumerate(STATES))
            code = FORAGING.behaviour_index[after]
            wanted[SPACE.outcome(code, states_after, restarted)] += float(p)
        np.testing.assert_allclose(decided[bits, column], wanted, atol=1e-12)


@settings(max_examples=8, deadline=None)
@given(plain_rule_sets())
def test_simulated_robots_only_get_into_reachable_situations(rule_set):
    allowed = marked(rule_set)
    world = World(load_scenario("paper"), rule_set, seed=1)
    before = world.state
    for _ in range(200):
        world.step()
        after = world.state
        starts = before.behaviour.astype(int) * SPACE.states + before.internal_states
        assert allowed[after.percepts, starts].all()
        before = after


def test_hand_coded_robots_never_go_away_from_the_light_without_an_object_nor_want_none():
    rows = {(p["HAS_OBJECT"], b) for p, b, _ in reachable(load_preset("hand-coded"))}
    assert (False, "ANTI-PHOTOTAXIS") not in rows
    assert all("WANT_OBJECT" in states for _, _, states in reachable(load_preset("hand-coded")))
