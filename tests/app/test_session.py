"""The session without a display."""

import math
import time
from itertools import count
from types import SimpleNamespace

import numpy as np
import pytest

from geswarm.app.panels.evolution_panel import load_best
from geswarm.app.state.evolution import EvolutionThread, Phase
from geswarm.app.state.playback import Playback
from geswarm.app.state.session import Session
from geswarm.app.state.trace import SAMPLE_STEPS
from geswarm.app.state.view import between
from geswarm.evolution import RunConfig
from geswarm.ge import Settings
from geswarm.rules import EditError, RuleSetError, format_yaml, load_preset
from geswarm.sim import load_scenario
from tests.app.wire import typed

PAPER = load_scenario("paper")
HALF_P = {
    "do": "set",
    "rule": 0,
    "part": "actions",
    "at": 0,
    "element": {"p": 0.5, "behaviour": "RANDOM_WALK"},
}


@pytest.fixture
def session():
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    yield session
    session.close()


def run(session, seconds, frame=0.1):
    for _ in range(round(seconds / frame)):
        session.frame(frame, budget=1.0)


def test_paused_until_played(session):
    run(session, 1.0)
    assert session.world.steps == 0
    session.play()
    run(session, 1.0)
    assert session.world.steps == 10


@pytest.mark.parametrize("speed", [1.0, 5.0, 50.0])
def test_time_goes_by_as_fast_as_wanted_and_gives_the_same_trajectory(session, speed):
    session.play()
    session.set_speed(speed)
    while session.world.steps < 500:
        session.frame(0.1, budget=1.0)
    other = Session(PAPER, load_preset("evo8"), session.evolution)
    while other.world.steps < session.world.steps:
        other.step()
    assert session.world.steps == 500
    np.testing.assert_array_equal(session.world.state.x, other.world.state.x)


def test_as_fast_as_possible_fills_the_budget_and_no_more(session, monkeypatch):
    session.play()
    session.set_speed(math.inf)
    clock = SimpleNamespace(perf_counter=count(0, 0.125).__next__)
    monkeypatch.setattr("geswarm.app.state.session.time", clock)
    session.frame(1 / 30, budget=0.5)
    looks = 3  # at the clock, before there is no time left
    assert session.world.steps == looks * SAMPLE_STEPS + 1


def test_the_display_moves_smoothly_between_steps(session):
    session.play()
    seen = []
    for _ in range(60):
        session.frame(1 / 30, budget=1.0)
        view = session.view()
        seen.append(np.stack([view.x, view.y]))
    paths = np.linalg.norm(np.diff(seen, axis=0), axis=1)
    assert paths.max() <= 1.05 * PAPER.max_speed / 30  # no jump from step to step


def test_turns_are_interpolated_the_short_way(session):
    before = session.view()
    first, then = np.full(4, math.pi - 0.1), np.full(4, -math.pi + 0.1)
    a = type(before)(before.x, before.y, first, before.behaviour, before.carried, before.objects)
    b = type(before)(before.x, before.y, then, before.behaviour, before.carried, before.objects)
    np.testing.assert_allclose(np.abs(between(a, b, 0.5).theta), math.pi)


def test_an_edit_acts_on_the_running_swarm_without_reset(session):
    session.play()
    run(session, 5.0)
    before = session.world.state
    session.edit(typed(HALF_P))
    after = session.world.state
    assert session.world.rule_set.rules[0].actions[0].p == 0.5
    assert after.steps == before.steps
    np.testing.assert_array_equal(after.x, before.x)
    session.undo()
    assert session.world.rule_set == load_preset("evo8")
    session.redo()
    assert session.world.rule_set.rules[0].actions[0].p == 0.5


def test_undo_goes_all_the_way_back_and_a_new_edit_forgets_the_future(session):
    document = session.document
    for p in (0.1, 0.2, 0.3):
        session.edit(typed({**HALF_P, "element": {"p": p, "behaviour": "RANDOM_WALK"}}))
    for _ in range(5):
        session.undo()
    assert document.rule_set == load_preset("evo8")
    assert (document.can_undo, document.can_redo) == (False, True)
    session.edit(typed(HALF_P))
    assert (document.can_undo, document.can_redo) == (True, False)


def test_what_cannot_be_done_changes_nothing(session):
    version = session.document.version
    with pytest.raises(EditError):
        session.edit(typed({"do": "remove_rule", "rule": 9}))
    with pytest.raises(RuleSetError):
        session.load_text("rule do p = 7, PHOTOTAXIS", "mine.rules")
    with pytest.raises(RuleSetError):
        session.load_preset("evo9")
    assert session.document.version == version
    assert session.world.rule_set == load_preset("evo8")


def test_files_and_presets_are_loaded_and_can_be_undone(session):
    session.load_text(format_yaml(load_preset("hand-coded")), "mine.yaml")
    assert session.world.rule_set == load_preset("hand-coded")
    session.undo()
    assert session.world.rule_set == load_preset("evo8")


def test_undo_takes_back_what_was_loaded_too(session):
    evo8, hand_coded = load_preset("evo8"), load_preset("hand-coded")
    session.load_preset("hand-coded")
    assert session.document.loaded == hand_coded
    session.undo()
    assert session.document.loaded == session.document.rule_set == evo8
    assert session.document.unsaved is None
    session.redo()
    assert session.document.loaded == session.document.rule_set == hand_coded


def test_commands_are_carried_out_by_the_next_frame(session):
    session.post(lambda session: session.edit(typed(HALF_P)))
    assert session.document.version == 1
    session.frame(0.0, budget=1.0)
    assert session.document.version == 2


def test_reset_and_another_scenario(session):
    session.play()
    run(session, 2.0)
    start = Session(PAPER, load_preset("evo8"), session.evolution).world.state.x
    session.reset()
    np.testing.assert_array_equal(session.view().x, start)
    session.reset(seed=3)
    assert session.world.seed == 3
    session.set_scenario(load_scenario("scalability-10"))
    assert len(session.view().x) == 10
    assert session.document.rule_set == load_preset("evo8")


def test_playback_does_not_catch_up_after_a_hang():
    playback = Playback(0.1)
    playback.playing = True
    assert playback.steps_due(60.0) <= 3


def wait_for(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.01)


def test_evolution_runs_pauses_goes_on_and_gives_its_best(session, tmp_path):
    evolution = session.evolution
    config = RunConfig(
        PAPER.with_changes(duration=20.0), Settings(population=8, generations=10_000)
    )
    evolution.start(config, tmp_path / "run")
    wait_for(lambda: len(evolution.history) >= 3)
    assert set(evolution.references) == {"EVO 8", "Hand-coded"}
    evolution.pause()
    assert evolution.phase is Phase.PAUSED
    paused_at = len(evolution.history)
    time.sleep(0.3)
    assert len(evolution.history) <= paused_at + 1  # the generation that was at work
    paused_at = len(evolution.history)
    evolution.go_on()
    wait_for(lambda: len(evolution.history) > paused_at)
    load_best(session)
    assert session.world.rule_set.origin.run == str(tmp_path / "run")
    evolution.stop()
    assert evolution.phase is Phase.STOPPED
    done = len(evolution.history)
    evolution.resume(tmp_path / "run")
    wait_for(lambda: len(evolution.history) > done)


def test_a_failed_evolution_is_told_and_leaves_the_arena_alone(session, tmp_path):
    (tmp_path / "file").write_text("")
    config = RunConfig(PAPER, Settings(population=8, generations=2))
    session.evolution.start(config, tmp_path / "file" / "run")
    wait_for(lambda: not session.evolution.active)
    assert session.evolution.phase is Phase.FAILED
    assert "file" in session.evolution.error
    session.play()
    run(session, 1.0)
    assert session.world.steps == 10
