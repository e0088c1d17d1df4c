"""What the arena's panels say, without a browser."""

from types import SimpleNamespace

import numpy as np
import pytest
import viser

from geswarm.app.panels.inspector_panel import compass, last_rule_html, place, robot_html
from geswarm.app.panels.record_panel import status
from geswarm.app.panels.scenario_panel import VALUES
from geswarm.app.panels.show_panel import ShowPanel
from geswarm.app.scene.overlays import heat_map
from geswarm.app.scene.recorder import LONGEST_SECONDS, Recorder, RecorderPhase
from geswarm.app.scene.replay import Setting
from geswarm.app.scene.stage import beside
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.score import score
from geswarm.app.state.session import Session
from geswarm.rules import Rule, RuleSet, load_preset
from geswarm.sim import NEEDS_RESET, World, load_scenario, vocabulary_of
from geswarm.sim.scenario.checks import PARAMETERS

PAPER = load_scenario("paper")
SETTING = Setting(PAPER, False, 0, (("EVO 8", load_preset("evo8")),))


@pytest.mark.parametrize(
    ("degrees", "said"),
    [(90, "0° (north)"), (0, "90° (east)"), (-90, "180° (south)"), (180, "270° (west)")],
)
def test_headings_are_said_as_a_compass_does(degrees, said):
    assert compass(degrees) == said


def test_compass_goes_all_round():
    for degrees in np.linspace(-180, 180, 721):
        assert not compass(degrees).startswith("360")


def test_places_are_said_by_the_points_of_the_compass():
    assert place(-1.3199, 0.8) == "1.32 m west, 0.80 m north of the centre"
    assert place(0.5, -2.0) == "0.50 m east, 2.00 m south of the centre"


def test_the_inspector_tells_percepts_behaviour_states_and_rule():
    evo8 = load_preset("evo8")
    world = World(PAPER, evo8, 1)
    world.step(3000)
    state = world.state
    for robot in range(4):
        text = robot_html(world, robot, evo8)
        assert ("an object" in text) == bool(state.carried[robot])
        assert f"R{state.last_rule[robot] + 1}" in text
        for name in ("ON_NEST", "ON_SOURCE", "HAS_OBJECT", "WANT_OBJECT", "DROP_OBJECT"):
            assert name in text


def test_the_inspector_tells_what_any_scenario_has():
    scenario = load_scenario("aac")
    vocabulary = vocabulary_of(scenario)
    rules = load_preset("aac", vocabulary)
    world = World(scenario, rules, 1)
    world.step(20)
    text = robot_html(world, 0, rules)
    for word in ("ON_BLACK", "neighbours", str(world.state.behaviours[world.state.instance[0]])):
        assert word in text
    assert "carries" not in text
    assert "internal states" not in text


def test_the_score_is_what_the_scenario_measures():
    world = World(PAPER, load_preset("evo8"), 1)
    assert [name for name, _ in score(world)] == ["collected", "picked", "lost"]
    many = World(load_scenario("aac"), RuleSet(()), 1)
    many.step(100)
    assert score(many) == [("on black", f"{many.fitness:.0f}")]


def test_comments_are_escaped():
    rules = RuleSet((Rule(comment="<script>"),))
    assert "&lt;script&gt;" in last_rule_html(0, rules)
    assert "none" in last_rule_html(-1, rules)
    assert "none" in last_rule_html(4, rules)


def test_every_value_of_the_scenario_can_be_changed():
    changed = {"duration", "name"} | {value.key.partition(".")[0] for value in VALUES}
    assert changed == {"name", *PARAMETERS}
    for value in VALUES:
        other = PAPER.with_changes(**value.change(PAPER, value.of(PAPER)))
        assert other == PAPER
        assert type(getattr(other, value.key.partition(".")[0])) is not str
    assert {value.key for value in VALUES if value.needs_reset} == set(NEEDS_RESET)


def test_arenas_do_not_overlap():
    for name in ("paper", "scalability-20", "flexibility-5", "aac"):
        shape = load_scenario(name)
        x, y = beside(shape)
        assert abs(x) > shape.width or abs(y) > shape.length


def test_a_recording_becomes_one_html_file(server):
    recorder, sent = Recorder(), []
    client = SimpleNamespace(send_file_download=lambda *file, **_: sent.append(file))
    ball = server.scene.add_icosphere("/ball", 1.0)
    recorder.sync(1.0)
    assert (recorder.phase, recorder.seconds) == (RecorderPhase.IDLE, 0.0)
    recorder.start(server, client)
    recorder.note(SETTING, 0.0)
    for x in range(30):
        ball.position = (x, 0.0, 0.0)
        recorder.sync(1 / 30)
    assert recorder.seconds == pytest.approx(1.0)
    assert "0:0" in status(recorder)
    recorder.sync(LONGEST_SECONDS)  # ends by itself
    recorder.join()
    ((name, content),) = sent
    assert name.endswith(".html")
    assert b"__VISER_EMBED_DATA__" in content
    assert recorder.phase is RecorderPhase.IDLE
    assert "MB" in status(recorder)


def test_a_recording_that_fails_is_told(server, monkeypatch):
    recorder = Recorder()
    recorder.start(server, None)
    recorder.note(SETTING, 0.0)
    monkeypatch.setattr(viser.infra.StateSerializer, "as_html", lambda self: 1 / 0)
    recorder.stop()
    recorder.join()
    assert "ZeroDivisionError" in status(recorder)


def test_the_colours_of_the_heat_map_are_explained_while_it_is_shown(server):
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    panel = ShowPanel(session)
    panel.build(server.gui)
    panel.sync()
    assert not panel.legend.visible
    session.shown.visits = True
    panel.sync()
    assert panel.legend.visible
    often = heat_map(np.full((8, 8), 9))[4, 4, :3]
    assert "#{:02x}{:02x}{:02x}".format(*often) in panel.legend.content
    session.shown.ranges = "all"
    panel.sync()
    assert "visited rarely" in panel.legend.content
    assert "grip reach" in panel.legend.content
    session.close()
