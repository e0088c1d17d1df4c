"""The arena under the mouse and the keys of a real browser."""

import math
import re
import threading

import numpy as np
import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

from .test_dashboard import PATIENCE, wait_until

pytestmark = [pytest.mark.browser, pytest.mark.slow]

ROBOT_HEIGHT, OBJECT_HEIGHT = 0.09, 0.04  # m, of a point that the mouse hits


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    """A dashboard with the swarm at rest."""
    monkeypatch.chdir(tmp_path)
    quick = load_scenario("paper").with_changes(duration=100.0)
    dashboard = open_dashboard(quick, load_preset("evo8"), "127.0.0.1", 0)
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()


@pytest.fixture
def session(dashboard):
    return dashboard.session


@pytest.fixture
def screen(dashboard, browser):
    page = browser.new_page(viewport={"width": 1500, "height": 900}, accept_downloads=True)
    page.set_default_timeout(PATIENCE)
    page.goto(dashboard.address)
    page.wait_for_selector("canvas")
    page.get_by_role("button", name="Play").wait_for()
    wait_until(lambda: all(c in cameraman(dashboard)._welcomed for c in clients(dashboard)))
    yield page
    page.close()


def clients(dashboard):
    return list(dashboard.server.get_clients().values()) or [None]


def cameraman(dashboard):
    return dashboard.stage.cameraman


def on_screen(dashboard, page, x, y, z):
    """Where a place in the arena is on the page, in pixels."""
    (client,) = clients(dashboard)
    camera = client.camera
    forward = camera.look_at - camera.position
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    seen = np.array((x, y, z)) - camera.position
    half = math.tan(camera.fov / 2) * (seen @ forward)
    across = seen @ right / half / camera.aspect
    upwards = seen @ np.cross(right, forward) / half
    box = page.locator("canvas").first.bounding_box()
    return (
        box["x"] + box["width"] * (1 + across) / 2,
        box["y"] + box["height"] * (1 - upwards) / 2,
    )


def robot_on_screen(dashboard, page, robot):
    view = dashboard.session.view()
    return on_screen(dashboard, page, view.x[robot], view.y[robot], ROBOT_HEIGHT)


def click_until(page, place, condition):
    """Click again while the renderer in software does not yet show what is to be clicked."""
    for _ in range(10):
        page.mouse.click(*place)
        for _ in range(20):
            if condition():
                return
            page.wait_for_timeout(100)
    raise AssertionError("clicked in vain")


def drag(page, start, end):
    page.mouse.move(*start)
    page.mouse.down()
    for step in np.linspace(0, 1, 6):
        page.mouse.move(*(np.array(start) + step * (np.array(end) - start)))
        page.wait_for_timeout(150)
    page.wait_for_timeout(500)
    page.mouse.up()


def open_folder(page, name):
    page.get_by_text(name, exact=True).last.click()


def test_click_a_robot_inspect_it_follow_it_and_look_away(dashboard, session, screen):
    click_until(screen, robot_on_screen(dashboard, screen, 1), lambda: session.selected == 1)
    screen.get_by_text("Robot 2").wait_for()
    screen.get_by_text("WANT_OBJECT true").wait_for()
    assert dashboard.stage.overlays.handles.ring.visible
    (client,) = clients(dashboard)
    far = np.linalg.norm(client.camera.position - client.camera.look_at)
    screen.get_by_label("Follow").check()
    wait_until(lambda: np.linalg.norm(client.camera.position - client.camera.look_at) < far / 2)
    session.post(lambda session: session.hold("robot", 1, 1.0, 1.0))
    wait_until(lambda: np.allclose(client.camera.look_at[:2], (1.0, 1.0), atol=0.05))
    screen.get_by_label("Follow").uncheck()
    wait_until(lambda: np.linalg.norm(client.camera.position - client.camera.look_at) > 0.9 * far)
    ground = on_screen(dashboard, screen, 1.6, -1.8, 0.0)
    click_until(screen, ground, lambda: session.selected is None)
    screen.get_by_text("Robot 2").wait_for(state="hidden")


def test_robots_and_objects_are_dragged(dashboard, session, screen):
    wait_until(lambda: dashboard.stage.arena.handles.robots is not None)
    screen.wait_for_timeout(2000)
    end = on_screen(dashboard, screen, 1.0, -0.4, ROBOT_HEIGHT)
    drag(screen, robot_on_screen(dashboard, screen, 0), end)
    wait_until(lambda: session.held is None)
    view = session.view()
    assert (view.x[0], view.y[0]) == pytest.approx((1.0, -0.4), abs=0.05)
    thing = view.objects[0]
    start = on_screen(dashboard, screen, *thing, OBJECT_HEIGHT)
    drag(screen, start, on_screen(dashboard, screen, -1.2, 1.0, OBJECT_HEIGHT))
    wait_until(lambda: session.held is None)
    assert session.view().objects[0] == pytest.approx((-1.2, 1.0), abs=0.05)
    drag(screen, robot_on_screen(dashboard, screen, 0), (340, 890))  # far outside
    wait_until(lambda: session.held is None)
    assert session.view().y[0] == pytest.approx(-2.1 + 0.085)


def test_the_keys_are_argos_s(dashboard, session, screen):
    screen.get_by_text("Swarm", exact=True).hover()
    screen.keyboard.press("p")
    wait_until(lambda: session.playback.playing)
    screen.keyboard.press("o")
    wait_until(lambda: not session.playback.playing)
    steps = session.world.steps
    screen.keyboard.press("x")
    wait_until(lambda: session.world.steps == steps + 1)
    screen.keyboard.press("f")
    wait_until(lambda: math.isinf(session.playback.speed))
    screen.get_by_text("Speed max").wait_for()
    screen.keyboard.press("r")
    wait_until(lambda: session.world.steps == 0)
    screen.keyboard.press("f")
    wait_until(lambda: session.playback.speed == 1.0)
    screen.get_by_role("button", name="10x").click()
    screen.get_by_text("Speed 10x").wait_for()


def test_a_run_that_was_reset_by_a_key_is_gone_back_to(session, screen):
    back = screen.get_by_role("button", name="Back to")
    session.post(lambda session: session._advance(1205, budget=60.0))
    screen.get_by_text("2:00", exact=True).wait_for()
    assert not back.is_visible()
    screen.get_by_label("Seed").fill("7")
    wait_until(lambda: session.world.steps == 0 and session.world.seed == 7)
    back.click()
    wait_until(lambda: (session.world.steps, session.world.seed) == (1205, 0))
    wait_until(lambda: screen.get_by_label("Seed").input_value() == "0")
    screen.get_by_text("Swarm", exact=True).hover()
    screen.keyboard.press("r")
    wait_until(lambda: session.world.steps == 0)
    screen.get_by_role("button", name="Back to 2:00 of the run before").click()
    wait_until(lambda: session.world.steps == 1205)
    assert (session.scenario, session.rival) == (session.loaded, None)
    back.wait_for(state="hidden")


def test_trails_heat_map_and_ranges_are_shown(dashboard, session, screen):
    open_folder(screen, "Show")
    for name in ("Trails", "Visit heat map"):
        screen.get_by_label(name).check()
    screen.get_by_label("Sensing ranges").click()
    screen.get_by_role("option", name="all robots").click()
    session.post(lambda session: (session.set_speed(50.0), session.play()))
    screen.get_by_text("range and bearing, 0.5 m").wait_for()
    overlays = dashboard.stage.overlays
    wait_until(lambda: overlays.handles.trails is not None and session.world.steps > 300)
    wait_until(lambda: overlays.handles.visits.visible)
    wait_until(lambda: overlays.handles.visits.image[..., 3].max() > 100)
    assert all(batch.visible for batch in overlays.handles.ranges)
    screen.get_by_label("Trails").uncheck()
    wait_until(lambda: not overlays.handles.trails.visible)


def test_a_rival_runs_beside_and_the_score_runs(dashboard, session, screen):
    session.post(lambda session: (session.set_speed(50.0), session.play()))
    screen.get_by_label("Compare with").click()
    screen.get_by_role("option", name="Hand-coded").click()
    wait_until(lambda: session.rival is not None)
    screen.get_by_text("these rules", exact=True).first.wait_for()
    wait_until(lambda: session.world.fitness > 0)
    titles = dashboard.stage._titles
    wait_until(lambda: re.fullmatch(r"Hand-coded: \d+", titles["/rival"].text))
    (client,) = clients(dashboard)
    wait_until(lambda: client.camera.look_at[0] > 2.0)  # both are in the picture
    screen.get_by_label("Compare with").click()
    screen.get_by_role("option", name="nothing").click()
    wait_until(lambda: session.rival is None and dashboard.stage.rival.handles is None)


def test_a_rival_that_has_just_gone_is_told_until_something_else_is_chosen(
    dashboard, session, screen, monkeypatch
):
    monkeypatch.setattr(type(session), "rivals_offered", lambda _: ("Hand-coded", "gone"))
    compare = screen.get_by_label("Compare with")
    wait_until(lambda: "gone" in dashboard.swarm_panel.handles.compare.options)
    compare.click()
    screen.get_by_role("option", name="gone").click()
    told = screen.get_by_text("Not possible: 'gone' is no longer there to compare with")
    told.wait_for()
    wait_until(lambda: compare.input_value() == "nothing")
    compare.click()
    screen.get_by_role("option", name="Hand-coded").click()
    wait_until(lambda: session.rival is not None)
    told.wait_for(state="hidden")
    session.post(lambda session: session.compare_with(None))


def test_scenario_values_act_live_or_through_a_reset_and_errors_are_kind(session, screen):
    session.post(lambda session: session.play())
    open_folder(screen, "Scenario")
    wait_until(lambda: session.world.steps > 5)
    screen.get_by_label("zone_miss").fill("0.5")
    wait_until(lambda: session.scenario.zone_miss == 0.5)
    assert session.world.steps > 5
    robots = screen.get_by_label("Robots", exact=True)
    robots.fill("900")
    screen.get_by_text("900 do not fit in the nest").wait_for()
    wait_until(lambda: robots.input_value() == "4")
    robots.click()
    screen.keyboard.press("End")
    screen.keyboard.type("5")
    screen.keyboard.press("Backspace")
    screen.get_by_text("900 do not fit in the nest").wait_for(state="hidden")
    robots.fill("6")
    wait_until(lambda: len(session.view().x) == 6)
    screen.get_by_text("paper, changed").wait_for()
    screen.get_by_role("button", name="Reset to paper's values").click()
    wait_until(lambda: session.scenario == session.loaded)
    wait_until(lambda: robots.input_value() == "4")


def test_a_stretch_is_recorded_and_plays_by_itself(session, screen, browser, tmp_path):
    session.post(lambda session: session.play())
    open_folder(screen, "Record")
    screen.get_by_role("button", name="Start recording").click()
    screen.get_by_text("Recording 0:02").wait_for()
    with screen.expect_download() as download:
        screen.get_by_role("button", name="Stop and download").click()
    path = tmp_path / "replay.html"
    download.value.save_as(path)
    replay = browser.new_page()
    complaints = []
    replay.on("pageerror", lambda error: complaints.append(str(error)))
    replay.on(
        "request",
        lambda request: complaints.append(request.url) if request.url.startswith("http") else None,
    )
    replay.goto(path.as_uri())
    replay.wait_for_selector("canvas", timeout=PATIENCE)
    sees_far = "window.__viserMutable?.camera?.fov < 31 && __viserMutable.camera.far > 100"
    replay.wait_for_function(sees_far, timeout=PATIENCE)
    assert replay.title().endswith(" – GESwarm")
    assert replay.evaluate("document.querySelector('link[rel=icon]').href").startswith("data:")
    replay.close()
    assert complaints == []
