"""Robots are drawn as finely as the slowest browser can bear."""

import json
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest
from websockets.sync.client import connect

from geswarm.app.dashboard import open_dashboard
from geswarm.app.panels.swarm_panel import detail_html
from geswarm.app.protocol.base import FrameTime
from geswarm.app.scene.arena import ShownArena
from geswarm.app.scene.detail import MOST_IN_FULL, Detail, DetailKeeper
from geswarm.app.scene.pointer import Pointer, nearest
from geswarm.app.server.channel import frame_told
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

from .test_arena import PAPER, view
from .test_dashboard import PATIENCE, wait_until

FULL, SIMPLE, POINTS = Detail
LARGE = 10_000


def keep(keeper, seconds, frame, robots=LARGE, browsers=1):
    """Let seconds go by at so many seconds per frame."""
    keeper.frame = frame
    for _ in range(round(10 * seconds)):
        keeper.sync(0.1, robots, browsers)
    return keeper.detail


@pytest.mark.parametrize(("robots", "detail"), [(4, FULL), (MOST_IN_FULL, FULL), (LARGE, POINTS)])
def test_only_a_large_swarm_begins_as_points(robots, detail):
    assert keep(DetailKeeper(), 60, None, robots) is detail


def test_robots_are_drawn_finer_where_every_browser_is_quick():
    keeper = DetailKeeper()
    assert keep(keeper, 5, 0.02) is POINTS
    assert keep(keeper, 10, 0.02) is SIMPLE
    assert keep(keeper, 600, 0.02) is SIMPLE  # the finest for so many
    assert not keeper.coarser_than_usual
    assert keeper.pause == 0.0


def test_a_browser_that_is_slow_gets_points_and_is_told():
    keeper = DetailKeeper()
    assert keep(keeper, 12, 0.3, robots=900) is POINTS
    assert "drawn as points" in detail_html(keeper)
    assert "3.3 frames per second" in detail_html(keeper)
    assert keep(keeper, 600, 0.1, robots=900) is POINTS  # neither slow nor quick: it stays
    assert keep(DetailKeeper(), 60, 9.0, robots=20) is FULL  # it is not the robots


def test_it_does_not_flicker():
    keeper, taken = DetailKeeper(), []
    for _ in range(36_000):  # an hour of a browser that is slow as soon as robots are finer
        keeper.frame = 0.02 if keeper.detail is POINTS else 1.0
        before = keeper.detail
        keeper.sync(0.1, LARGE, 1)
        taken.append(keeper.detail is not before)
    assert sum(taken[6000:]) <= 12


def test_a_large_swarm_is_points_again_when_somebody_comes_to_look():
    keeper = DetailKeeper()
    assert keep(keeper, 20, 0.02) is SIMPLE
    assert keep(keeper, 1, 0.02, browsers=2) is POINTS
    assert keep(keeper, 20, 0.02, browsers=1) is SIMPLE


def test_a_slow_browser_is_not_sent_more_than_it_draws():
    keeper = DetailKeeper()
    keep(keeper, 1, 0.4)
    assert keeper.pause == 0.4
    keep(keeper, 1, 30.0)
    assert keeper.pause == 1.0
    keep(keeper, 1, 30.0, robots=4)
    assert keeper.pause == 0.0


def test_an_arena_is_drawn_as_points_and_back(server):
    made = []
    arena = ShownArena("/arena", lambda kind, _: made.append(kind))
    arena.build(server.scene, PAPER)
    arena.sync(view())
    arena.sync(view(robots=5, objects=2, behaviour=1, x=1.0), POINTS)
    points = arena.handles.points
    assert arena.handles.robots is arena.handles.objects is None
    np.testing.assert_allclose(points.robots.points[:, :2], [(1.0, 0.5 * i) for i in range(5)])
    np.testing.assert_array_equal(points.robots.colors, [(31, 99, 222)] * 5)
    assert len(points.objects.points) == 2 + 2  # two lie, two are carried
    arena.sync(view(robots=2), POINTS)
    assert arena.handles.points is points
    assert len(points.robots.points) == 2
    arena.sync(view(), SIMPLE)
    assert arena.handles.points is None
    assert made == ["robot", "object"] * 2


def test_a_robot_that_is_a_point_is_selected_by_a_click_near_it():
    world = view(robots=3, x=1.0)
    assert nearest(world, (1.05, 0.52), 0.1) == 1
    assert nearest(world, (2.0, 0.5), 0.1) is None
    calls = []
    session = SimpleNamespace(
        view=lambda: world,
        select=lambda robot: calls.append(robot),
        deselect=lambda: calls.append(None),
    )
    pointer = Pointer(lambda command: command(session))
    pointer._clicked_points(np.array((1.0, -5.0, 5.146)), np.array((0.0, 0.74, -0.67)))
    pointer._clicked_points(np.array((1.0, -5.0, 5.0)), np.array((0.0, 0.0, 1.0)))
    assert calls == [1, None]


def test_a_browser_that_is_not_looked_at_counts_for_nothing():
    assert frame_told(FrameTime(None)) is None


def test_what_pages_tell_of_their_frames_counts_and_so_does_silence(server, channel, monkeypatch):
    address = f"ws://127.0.0.1:{server.get_port()}/rules/socket"
    with connect(address) as slow, connect(address) as quick, connect(address):
        for page, frame in ((slow, 500.0), (quick, 16.0)):
            page.send(json.dumps({"type": "frame_time", "milliseconds": frame}))
        wait_until(lambda: channel.slowest_frame() == 0.5)
        slow.send(json.dumps({"type": "frame_time", "milliseconds": None}))
        wait_until(lambda: channel.slowest_frame() == 0.016)
        later = time.monotonic() + 60.0
        monkeypatch.setattr(time, "monotonic", lambda: later)
        assert channel.slowest_frame() > 50.0
        monkeypatch.undo()
    wait_until(lambda: channel.slowest_frame() is None)


@pytest.mark.browser
@pytest.mark.slow
def test_ten_thousand_robots_do_not_freeze_a_page(tmp_path, monkeypatch, browser):
    monkeypatch.chdir(tmp_path)
    width = 210.0
    large = load_scenario("paper").with_changes(
        robots=LARGE, width=width, length=width, nest=75.0, source=100.0, duration=1.0
    )
    dashboard = open_dashboard(large, load_preset("evo8"), "127.0.0.1", 0, workers=1)
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    session = dashboard.session
    session.post(lambda session: session.play())
    page = browser.new_page(viewport={"width": 1500, "height": 900})
    page.set_default_timeout(2 * PATIENCE)
    try:
        page.goto(dashboard.address)
        page.get_by_text("Robots are drawn as points").wait_for()
        page.get_by_role("button", name="Pause").click()
        wait_until(lambda: not session.playback.playing)
        assert dashboard.stage.keeper.detail is POINTS
        assert dashboard.stage.keeper.frame < 20.0
    finally:
        page.close()
        dashboard.stop()
        loop.join(20)
        dashboard.close()
