"""The whole dashboard as a user meets it: a real browser, a real swarm, a real evolution."""

import io
import json
import os
import re
import threading
import time
import urllib.request

import imageio.v3 as imageio
import numpy as np
import pytest
from websockets.sync.client import connect

from geswarm.app.dashboard import open_dashboard
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

PATIENCE = 60_000  # ms: the renderer works in software, on a small machine


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    """A running dashboard on a free port, its runs kept in tmp_path."""
    monkeypatch.chdir(tmp_path)
    quick = load_scenario("paper").with_changes(duration=100.0)  # evolution evaluates in it
    dashboard = open_dashboard(quick, load_preset("evo8"), "127.0.0.1", 0)
    dashboard.session.post(lambda session: session.play())
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()
    assert not loop.is_alive()


def wait_until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def first_probability(dashboard):
    return dashboard.session.world.rule_set.rules[0].actions[0].p


def test_page_table_and_socket_share_one_port(dashboard):
    for path in ("/", "/rules/rules.html", "/evolution/evolution.html"):
        with urllib.request.urlopen(dashboard.address + path) as answer:
            assert b"<html" in answer.read()
    with connect(dashboard.address.replace("http", "ws") + "/rules/socket") as socket:
        assert json.loads(socket.recv())["type"] == "vocabulary"
        rules = json.loads(socket.recv())
        assert rules["rule_set"]["name"] == "EVO 8"
        edit = {"do": "remove_rule", "rule": 3}
        socket.send(json.dumps({"type": "edit", "version": 1, "edit": edit}))
        wait_until(lambda: len(dashboard.session.world.rule_set.rules) == 3)
        edit = {"do": "remove_rule", "rule": 99}
        for bad in ({"type": "edit", "version": 2, "edit": edit}, {"type": "dance"}):
            socket.send(json.dumps(bad))
            while (answer := json.loads(socket.recv(timeout=10)))["type"] != "notice":
                pass
            assert answer["level"] == "error"
        assert len(dashboard.session.world.rule_set.rules) == 3


def test_a_failing_command_does_not_end_the_session(dashboard, caplog):
    dashboard.session.post(lambda session: 1 / 0)
    steps = dashboard.session.world.steps
    wait_until(lambda: dashboard.session.world.steps > steps + 5)
    assert "ZeroDivisionError" in caplog.text


@pytest.mark.browser
@pytest.mark.slow
def test_the_researchers_path(dashboard, browser):
    page = browser.new_page(viewport={"width": 1500, "height": 900})
    page.set_default_timeout(PATIENCE)
    page.goto(dashboard.address)
    table = page.frame_locator("iframe[title='Rule table']")

    # EVO 8 is there and the robots move.
    assert "probabilistic" in table.get_by_test_id("rule-1-comment").input_value()
    page.wait_for_selector("canvas")
    wait_until(lambda: pixels(page).std() > 10)
    before = pixels(page)
    wait_until(lambda: np.abs(pixels(page) - before).max(axis=2).mean() > 0.1)

    # A change in the table acts on the running swarm, and undo takes it back.
    steps = dashboard.session.world.steps
    p = table.get_by_test_id("rule-1-action-1-p")
    assert p.input_value() == "0.05"
    p.fill("0.5")
    p.press("Enter")
    wait_until(lambda: first_probability(dashboard) == 0.5)
    assert dashboard.session.world.steps >= steps  # no reset
    table.get_by_test_id("undo").click()
    wait_until(lambda: first_probability(dashboard) == 0.05)
    wait_until(lambda: p.input_value() == "0.05")

    # Evolution runs beside it, the curve grows, its best comes into the arena.
    page.get_by_role("button", name="Start evolution").click()
    page.get_by_text(re.compile(r"Generation \d+ of 1000")).wait_for()
    page.locator(".u-wrap").wait_for()
    curve = chart(page)
    generation = len(dashboard.session.evolution.history)
    wait_until(lambda: len(dashboard.session.evolution.history) > generation + 2)
    wait_until(lambda: chart(page) != curve)
    page.get_by_role("button", name="Load the best").click()
    wait_until(lambda: "Evolved" in table.get_by_test_id("name").input_value())
    assert dashboard.session.world.rule_set.origin.generation is not None
    page.get_by_role("button", name="Stop").click()
    page.get_by_role("button", name="Start evolution").wait_for()
    assert list(dashboard.session.evolution.directory.glob("best.yaml"))


def pixels(page):
    """The middle of the arena as an array of shape (rows, columns, 3)."""
    clip = {"x": 420, "y": 250, "width": 400, "height": 450}
    picture = page.screenshot(type="png", clip=clip)
    return imageio.imread(io.BytesIO(picture))[..., :3].astype(float)


def chart(page):
    return page.locator(".u-wrap canvas").first.evaluate("canvas => canvas.toDataURL()")


@pytest.mark.parametrize(("cores", "threads"), [(1, 1), (2, 1), (8, 7)])
def test_evolution_leaves_one_of_its_own_cores_to_the_arena(cores, threads, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(cores)), raising=False)
    dashboard = open_dashboard(load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0)
    assert dashboard.session.evolution.workers == threads
    dashboard.close()
