"""What the session knows of the arena: hands in it, the rival, the scenario changed live."""

import math
from pathlib import Path

import numpy as np
import pytest

from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.rival import BEFORE, best_of
from geswarm.app.state.session import Session
from geswarm.rules import load_preset
from geswarm.sim import World, load_scenario
from tests.app.wire import typed

from .test_session import HALF_P, PAPER, run


@pytest.fixture
def session():
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    yield session
    session.close()


# --- hands ---


def test_a_robot_is_selected_and_deselected(session):
    session.select(2)
    session.follow(True)
    assert (session.selected, session.following) == (2, True)
    session.select(1)
    assert (session.selected, session.following) == (1, True)
    session.select(1)
    assert (session.selected, session.following) == (None, False)
    session.select(99)
    session.follow(True)
    assert (session.selected, session.following) == (None, False)


def test_a_held_robot_stays_in_the_hand_and_the_others_go_on(session):
    session.play()
    session.hold("robot", 1, 1.5, 0.5)
    start = session.view()
    assert (start.x[1], start.y[1]) == (1.5, 0.5)
    for _ in range(20):
        session.frame(1 / 30, budget=1.0)
        view = session.view()
        assert (view.x[1], view.y[1]) == (1.5, 0.5)
    assert np.hypot(view.x - start.x, view.y - start.y)[[0, 2, 3]].max() > 0.01
    session.release()
    run(session, 1.0)
    assert session.view().x[1] != 1.5


def test_what_is_held_stays_inside_the_arena(session):
    session.hold("robot", 0, 99.0, -99.0)
    assert session.view().x[0] == pytest.approx(2.1 - 0.085)
    session.hold("object", 3, 0.0, -99.0)
    assert session.view().objects[3].tolist() == pytest.approx([0.0, 0.1])
    session.hold("object", 99, 0.0, 0.0)
    assert session.held.index == 3


def test_reset_takes_things_out_of_the_hand(session):
    session.hold("robot", 0, 1.0, 1.0)
    session.reset()
    assert session.held is None
    np.testing.assert_array_equal(session.view().x, World(PAPER, load_preset("evo8")).state.x)


def test_the_trace_is_the_same_at_any_speed(session):
    traces = []
    for speed in (1.0, 50.0, math.inf):
        session.reset()
        session.set_speed(speed)
        session.play()
        while session.world.steps < 100:
            session.frame(0.1, budget=0.0005)
        session.pause()
        while session.world.steps % 100:
            session.step()
        traces.append((session.world.steps, session.trace.visits.copy()))
    (steps, visits), *others = traces
    assert visits.sum() == 4 * steps / 5
    for other_steps, other in others:
        assert other.sum() == 4 * other_steps / 5
        if other_steps == steps:
            np.testing.assert_array_equal(visits, other)


# --- side by side ---


def test_the_same_rules_beside_each_other_do_the_same(session):
    run(session, 1.0)
    session.compare_with("EVO 8")
    assert session.world.steps == 0
    session.play()
    session.set_speed(50.0)
    run(session, 20.0)
    other = session.rival.swarm.world
    assert session.world.steps == other.steps >= 9000
    assert session.world.fitness == other.fitness > 0
    np.testing.assert_array_equal(session.view().x, session.rival_view().x)


def test_the_rival_follows_reset_seed_and_scenario(session):
    session.compare_with("Hand-coded")
    session.play()
    run(session, 3.0)
    session.reset(seed=5)
    rival = session.rival.swarm.world
    assert (rival.steps, rival.seed, rival.fitness) == (0, 5, 0)
    np.testing.assert_array_equal(rival.state.x, session.world.state.x)
    assert rival.rule_set == load_preset("hand-coded")
    session.set_scenario(load_scenario("scalability-10"))
    assert len(session.rival_view().x) == len(session.view().x) == 10
    session.change_scenario(max_speed=0.2)
    assert rival.scenario.max_speed == 0.2
    session.compare_with(None)
    assert session.rival_view() is None


def test_only_what_there_is_can_be_compared_with(session):
    assert session.rivals_offered() == ("EVO 8", "Evolved", "Hand-coded")
    session.compare_with(best_of("run"))
    assert session.rival is None
    assert session.rival_problem == "'best of run' is no longer there to compare with"
    session.edit(typed(HALF_P))
    assert BEFORE in session.rivals_offered()
    session.evolution.best = load_preset("hand-coded")
    session.evolution.directory = Path("runs/mine")
    session.compare_with("best of mine")
    assert session.rival.swarm.world.rule_set == load_preset("hand-coded")
    assert session.rival_problem == ""


def test_the_version_before_the_edit_moves_on_with_every_edit(session):
    session.edit(typed(HALF_P))
    session.compare_with(BEFORE)
    rival = session.rival.swarm.world
    assert rival.rule_set.rules == load_preset("evo8").rules
    session.play()
    run(session, 2.0)
    session.edit(typed({**HALF_P, "element": {"p": 0.25, "behaviour": "RANDOM_WALK"}}))
    assert rival.rule_set.rules[0].actions[0].p == 0.5
    assert rival.steps == session.world.steps > 0
    session.undo()
    session.undo()
    assert session.rival is not None  # nothing is before: it keeps what it has


# --- the scenario ---


def test_physics_changes_at_once_without_reset(session):
    session.play()
    run(session, 3.0)
    session.select(1)
    before, version = session.world.state, session.scenario_version
    session.change_scenario(zone_miss=0.5, random_walk=(1.0, 2.0))
    assert session.world.scenario.zone_miss == 0.5
    assert session.world.steps == before.steps
    assert session.selected == 1
    assert session.scenario_version > version
    assert session.verdict.answer is None or session.scenario.zone_miss == 0.5
    session.restore_scenario()
    assert session.scenario == session.loaded == PAPER
    assert session.world.steps == before.steps


def test_another_number_of_robots_needs_a_reset(session):
    session.play()
    run(session, 3.0)
    session.select(3)
    session.change_scenario(robots=2)
    assert session.world.steps == 0
    assert session.selected is None
    assert len(session.view().x) == 2
    assert len(session.trace.trails().ends) % 2 == 0
    run(session, 3.0)


def test_what_cannot_be_is_told_and_changes_nothing(session):
    session.play()
    run(session, 1.0)
    session.change_scenario(robots=900)
    assert "900 do not fit in the nest" in session.scenario_problem
    assert (session.scenario, session.world.steps) == (PAPER, 10)
    session.change_scenario(robots=5)
    assert session.scenario_problem == ""
