"""What ends or stops a real dashboard at a bad moment, and what is left then."""

import json
import os
import re
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import threading
import time
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from websockets.sync.client import connect

from geswarm.app import dashboard as dashboard_module
from geswarm.app.dashboard import open_dashboard
from geswarm.rules import load_preset
from geswarm.sim import load_scenario, warm_up

PATIENCE = 120  # s, on a busy machine

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them"),
]


@contextmanager
def started(*arguments, **environment):
    """A process of the dashboard; killed in the end if it is still there."""
    process = subprocess.Popen(
        [sys.executable, "-m", "geswarm.app.main", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", **environment},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def address(process):
    """Where a dashboard says that it is."""
    line = process.stdout.readline()
    found = re.search(r"http://\S+", line)
    assert found, line + process.stderr.read()
    while "experiments.html" not in line:  # where its pages are
        line = process.stdout.readline()
    return found[0]


def open_table(at):
    return connect(at.replace("http", "ws") + "/rules/socket", open_timeout=PATIENCE)


def receive(table, kind, **values):
    """The next message of a kind that has these values."""
    while True:
        message = json.loads(table.recv(timeout=PATIENCE))
        if message["type"] == kind and message.items() >= values.items():
            return message


def say(table, **message):
    table.send(json.dumps(message))


def ends(process, number):
    """Status, standard output and standard error after a signal."""
    process.send_signal(number)
    output, errors = process.communicate(timeout=PATIENCE)
    return process.returncode, output, errors


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_while_compiling(number, tmp_path):
    with started("--port", "0", NUMBA_CACHE_DIR=str(tmp_path)) as process:
        assert "Compiling" in process.stderr.readline()
        time.sleep(2.0)
        assert ends(process, number) == (130, "", "geswarm-ui: stopped\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_while_running_is_silent_and_leaves_nothing(number, tmp_path):
    warm_up(interactive=True)  # it says so where it compiles
    with started("--port", "0", XDG_STATE_HOME=str(tmp_path)) as process:
        with open_table(address(process)) as table:
            say(table, type="edit", version=1, edit={"do": "remove_rule", "rule": 3})
            receive(table, "rules", version=2)
        assert ends(process, number) == (0, "", "")
    assert not list((tmp_path / "geswarm" / "journal").iterdir())


def committed(journal, copies):
    """What would be left of locked journals now; a journal that is being written does not count."""
    copies.mkdir(exist_ok=True)
    for path in journal.glob("*.db"):
        copy = copies / path.name
        shutil.copy(path, copy)
        with suppress(FileNotFoundError):  # SQLite's own, which takes back what was not committed
            shutil.copy(f"{path}-journal", f"{copy}-journal")
        with suppress(sqlite3.Error), closing(sqlite3.connect(copy)) as connection:
            yield from (rules for (rules,) in connection.execute("SELECT rules FROM unsaved"))


def test_edits_survive_kill_9(tmp_path):
    journal = tmp_path / "geswarm" / "journal"
    with started("--port", "0", XDG_STATE_HOME=str(tmp_path)) as process:
        with open_table(address(process)) as table:
            assert receive(table, "unsaved")["left"] == []
            say(table, type="edit", version=1, edit={"do": "set_name", "name": "Mine"})
            end = time.monotonic() + PATIENCE
            while not any("name: Mine" in kept for kept in committed(journal, tmp_path / "copy")):
                assert time.monotonic() < end
                time.sleep(0.01)
        process.kill()
        process.wait()
    with started("--port", "0", XDG_STATE_HOME=str(tmp_path)) as process:
        with open_table(address(process)) as one, open_table(address_again(one)) as two:
            (left,) = receive(one, "unsaved")["left"]
            assert (left["name"], left["rules"]) == ("Mine", 4)
            for table in (one, two):
                say(table, type="bring_back", file=left["file"])
                assert receive(table, "rules", version=2)["rule_set"]["name"] == "Mine"
            assert "already" in receive(two, "notice")["text"]
            say(one, type="undo", version=2)
            assert receive(one, "rules", version=3)["rule_set"]["name"] == "EVO 8"
        assert ends(process, signal.SIGTERM)[0] == 0
    assert not list(journal.iterdir())


def address_again(table):
    host, port = table.remote_address
    return f"http://{host}:{port}"


def test_edits_are_made_where_nothing_can_be_kept(tmp_path):
    (tmp_path / "geswarm").write_text("")
    with (
        started("--port", "0", XDG_STATE_HOME=str(tmp_path)) as process,
        open_table(address(process)) as table,
    ):
        say(table, type="edit", version=1, edit={"do": "remove_rule", "rule": 3})
        assert "saved" in receive(table, "notice")["text"]
        say(table, type="edit", version=2, edit={"do": "remove_rule", "rule": 2})
        receive(table, "rules", version=3)
        assert ends(process, signal.SIGTERM) == (0, "", "")


def test_a_busy_port_is_told(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as busy:
        port = busy.getsockname()[1]
        with started("--port", str(port)) as process:
            other = int(address(process).rpartition(":")[2])
            assert other > port
            errors = ends(process, signal.SIGINT)[2]
    assert errors == f"Port {port} is busy, using {other} instead.\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is full")
def test_a_dashboard_whose_address_cannot_be_told_ends(tmp_path):
    command = f"exec {sys.executable} -m geswarm.app.main --port 0 > /dev/full"
    ended = subprocess.run(["sh", "-c", command], stderr=subprocess.PIPE, text=True)
    said = "geswarm-ui: standard output cannot be written: No space left on device\n"
    assert (ended.returncode, ended.stderr) == (1, said)


def test_a_dashboard_goes_on_after_sleep():
    with started("--port", "0") as process, open_table(address(process)) as table:
        before = receive(table, "live")["time"]
        process.send_signal(signal.SIGSTOP)
        time.sleep(3.0)
        process.send_signal(signal.SIGCONT)
        while receive(table, "live")["time"] <= before:
            pass
        assert ends(process, signal.SIGTERM) == (0, "", "")


def test_nothing_catches_up_when_the_clock_has_jumped(monkeypatch):
    hour, jump = 3600.0, [0.0]
    clock = SimpleNamespace(perf_counter=lambda: time.perf_counter() + jump[0])
    monkeypatch.setattr(dashboard_module, "time", clock)
    dashboard = open_dashboard(load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0)
    dashboard.session.post(lambda session: session.play())
    dashboard.session.post(lambda _: dashboard.recorder.start(dashboard.server, None))
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    for jump[0] in (hour, 2 * hour, 3 * hour):
        seen = threading.Event()
        dashboard.session.post(lambda _, seen=seen: seen.set())
        assert seen.wait(PATIENCE)
    dashboard.stop()
    loop.join(PATIENCE)
    dashboard.close()
    assert 0 < dashboard.recorder.seconds < hour / 10
    assert dashboard.session.world.time < hour / 10


@pytest.mark.browser
def test_pages_come_back_by_themselves_when_the_dashboard_does(tmp_path, browser):
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = str(free.getsockname()[1])
    page = browser.new_page(viewport={"width": 600, "height": 800})
    with started("--port", port, XDG_STATE_HOME=str(tmp_path)) as process:
        page.goto(f"{address(process)}/rules/rules.html")
        page.get_by_test_id("in-words").click()
        page.get_by_test_id("rule-1-enabled").click()
        page.get_by_text("Changes1").wait_for()
        page.get_by_test_id("tab-changes").click()
        page.reload()  # what is looked at survives that
        page.locator("#changes").wait_for()
        page.get_by_test_id("tab-table").click()
        page.get_by_test_id("rule-1-english").wait_for()
        process.kill()
        process.wait()
        page.get_by_test_id("offline").wait_for()
    with started("--port", port, XDG_STATE_HOME=str(tmp_path)) as process:
        assert address(process).endswith(port)
        page.get_by_test_id("bring-back").click(timeout=PATIENCE * 1000)
        page.get_by_test_id("unsaved").wait_for(state="detached")
        assert page.get_by_test_id("rule-1-enabled").get_attribute("aria-checked") == "false"
    page.close()
