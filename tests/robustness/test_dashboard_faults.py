"""Evolution in a dashboard that is killed, stopped, or whose disk is full: nothing is lost."""

import contextlib
import json
import signal
import time
from pathlib import Path

import pytest
from websockets.sync.client import connect

from geswarm.app.main import main
from geswarm.evolution import EvolutionRun, RunConfig
from tests.app.test_faults import PATIENCE, address, ends, receive, say, started
from tests.app.test_headless import outcome
from tests.robustness.test_faults import fill, small_disk

pytestmark = pytest.mark.slow

GENERATIONS = 200


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    """The run folder is below the working directory."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def short(tmp_path):
    """A scenario in which many generations take little time."""
    path = tmp_path / "short.yaml"
    path.write_text("duration: 500\n")
    return str(path)


def open_page(at, page):
    return connect(at.replace("http", "ws") + f"/{page}/socket", open_timeout=PATIENCE)


def begin(page):
    """Start a small evolution; its directory once a few generations are done."""
    for name, value in (("population", 6), ("evaluations", 1), ("generations", GENERATIONS)):
        say(page, type="plan", name=name, value=value)
    say(page, type="start", instead=False)
    return follow(page, lambda status: status["done"] >= 3)


def follow(page, condition):
    """The first status for which a condition holds; it is told when it changes."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        say(page, type="watch")
        with contextlib.suppress(TimeoutError):
            message = json.loads(page.recv(timeout=1.0))
            if message["type"] == "status" and condition(message):
                return message
    raise AssertionError("waited in vain")


def undisturbed(directory, place):
    """What the run of a directory comes to if nothing happens to it."""
    config = RunConfig.from_yaml((directory / "config.yaml").read_text())
    run = EvolutionRun.create(config, place)
    run.run()
    run.close()
    return outcome(place)


@pytest.mark.parametrize(
    "number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT], ids=lambda number: number.name
)
def test_an_evolution_goes_on_exactly_without_its_dashboard(tmp_path, short, number):
    with (
        started("--port", "0", "--scenario", short, XDG_STATE_HOME=str(tmp_path)) as process,
        open_page(address(process), "evolution") as page,
    ):
        directory = Path("runs", begin(page)["run"])
        status, output, errors = ends(process, number)
    if number == signal.SIGKILL:
        assert status == -signal.SIGKILL
    else:
        hint = f"Evolution stopped; it can go on with: geswarm-ui --no-ui --resume {directory}\n"
        assert (status, output, errors) == (0, "", hint)
    assert main(["--no-ui", "--resume", str(directory)]) == 0
    assert outcome(directory) == undisturbed(directory, tmp_path / "whole")


def test_a_full_disk_is_said_and_the_arena_goes_on(tmp_path, monkeypatch, short):
    with small_disk(tmp_path / "disk") as disk:
        monkeypatch.chdir(disk)
        try:
            there = ("--port", "0", "--scenario", short)
            with started(*there, XDG_STATE_HOME=str(disk)) as process:
                at = address(process)
                with open_page(at, "evolution") as page, open_page(at, "rules") as table:
                    run = on_a_full_disk(page, table, disk)
                    on_a_disk_with_room_again(page, table, disk, run)
                    directory = Path("runs", run)
                    assert outcome(directory) == undisturbed(directory, tmp_path / "whole")
                assert ends(process, signal.SIGTERM) == (0, "", "")
            assert not list((disk / "geswarm" / "journal").iterdir())
        finally:
            monkeypatch.chdir(tmp_path)


def on_a_full_disk(page, table, disk):
    run = begin(page)["run"]
    say(page, type="pause")
    fill(disk / "room")
    say(page, type="go_on")
    failed = follow(page, lambda status: status["phase"] == "FAILED")
    assert "cannot write" in failed["error"]
    assert failed["resumable"]
    version = receive(table, "rules")["version"]
    say(table, type="edit", version=version, edit={"do": "set_name", "name": "Mine"})
    assert "are lost" in receive(table, "notice")["text"]
    before = receive(table, "live")["time"]
    while receive(table, "live")["time"] <= before:
        pass
    say(table, type="save", format="yaml")  # to the browser's disk, not to ours
    assert "Mine" in receive(table, "file")["text"]
    return run


def on_a_disk_with_room_again(page, table, disk, run):
    (disk / "room").unlink()
    say(table, type="edit", version=2, edit={"do": "set_name", "name": "Kept"})
    receive(table, "rules")
    end = time.monotonic() + PATIENCE
    journal = disk / "geswarm" / "journal"
    while not any(b"Kept" in path.read_bytes() for path in journal.glob("*.db")):
        assert time.monotonic() < end
        time.sleep(0.01)
    say(page, type="resume", name=run, instead=False)
    follow(page, lambda status: status["phase"] == "FINISHED")
