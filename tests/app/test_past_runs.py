"""A run that is begun again is not lost."""

import numpy as np
import pytest

from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.wire import typed

from .test_journal import wait_until
from .test_session import HALF_P, PAPER


@pytest.fixture
def session():
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    yield session
    session.close()


@pytest.fixture
def twin():
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    yield session
    session.close()


def go(session, steps):
    session._advance(steps, budget=60.0)


def assert_the_same(one, other):
    mine, theirs = vars(one.world.state), vars(other.world.state)
    assert mine.pop("action_counts") == theirs.pop("action_counts")
    for name, value in mine.items():
        np.testing.assert_array_equal(value, theirs[name], err_msg=name)
    np.testing.assert_array_equal(one.world.decisions, other.world.decisions)
    np.testing.assert_array_equal(one.trace.visits, other.trace.visits)
    np.testing.assert_array_equal(one.trace.trails().ends, other.trace.trails().ends)
    assert (one.scenario, one.loaded, one.world.seed) == (other.scenario, other.loaded, 0)


BEGIN_AGAIN = {
    "reset": lambda session: session.reset(),
    "another seed": lambda session: session.reset(7),
    "another scenario": lambda session: session.set_scenario(load_scenario("scalability-10")),
    "more robots": lambda session: session.change_scenario(robots=9),
    "a rival": lambda session: session.compare_with("Hand-coded"),
}


@pytest.mark.parametrize("how", BEGIN_AGAIN)
def test_a_run_begun_again_is_gone_back_to_exactly_as_it_was(session, twin, how):
    for each in (session, twin):
        go(each, 1003)
    BEGIN_AGAIN[how](session)
    assert (session.world.steps, session.past.latest.time) == (0, pytest.approx(100.3))
    go(session, 50)
    session.take_back_reset()
    assert_the_same(session, twin)
    assert session.rival is None
    for each in (session, twin):
        go(each, 500)
    assert_the_same(session, twin)


def test_going_back_keeps_what_is_left_and_comes_round(session):
    for seed, steps in ((1, 300), (2, 200), (3, 100)):
        session.reset(seed)
        go(session, steps)
    seen = []
    for _ in range(4):
        session.take_back_reset()
        seen.append((session.world.seed, session.world.steps))
    assert seen == [(2, 200), (1, 300), (3, 100), (2, 200)]


def test_a_key_that_is_held_down_does_not_push_out_a_long_run(session):
    go(session, 5000)
    for _ in range(50):
        session.reset()
        go(session, 1)
    while session.world.steps != 5000:
        before = session.past.latest
        session.take_back_reset()
        assert before is not None


def test_a_run_that_has_not_begun_is_not_kept(session):
    session.reset()
    session.reset(4)
    assert session.past.latest is None
    session.take_back_reset()
    assert session.world.seed == 4


def test_a_run_gone_back_to_follows_the_rules_as_they_are_now(session):
    go(session, 500)
    session.reset()
    session.edit(typed(HALF_P))
    session.take_back_reset()
    assert session.world.steps == 500
    assert session.world.rule_set.rules == session.document.rule_set.rules


def test_a_rival_comes_back_with_its_run(session):
    session.compare_with("Hand-coded")
    go(session, 700)
    collected = session.rival.swarm.world.state
    session.compare_with("Evolved")
    session.take_back_reset()
    assert session.rival.name == "Hand-coded"
    np.testing.assert_array_equal(session.rival.swarm.world.state.x, collected.x)


def test_a_robot_that_is_not_there_is_not_selected_any_more(session):
    go(session, 10)
    session.change_scenario(robots=9)
    session.select(8)
    session.take_back_reset()
    assert session.selected is None


def test_kept_runs_take_a_bounded_room(session, monkeypatch):
    monkeypatch.setattr("geswarm.app.state.past_runs._MOST_ROBOTS", 12)
    for steps in (30, 20, 10, 40, 50):
        go(session, steps)
        session.reset()
    assert [round(10 * run.time) for run in session.past._runs] == [30, 40, 50]


def test_the_swarm_is_seen_in_its_state_machine_after_going_back(session):
    wait_until(lambda: session.machine.drawn is not None)
    go(session, 10)
    session.reset()
    session.take_back_reset()
    assert session.machine.activity(session.world) is not None
