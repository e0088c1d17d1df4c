"""Long commands while the machine fails them: see also `tests/app/test_headless.py`."""

import contextlib
import os
import signal
import subprocess

import pytest

from geswarm.app.main import main
from geswarm.cli import main as reproduce
from geswarm.cli.stopping import stop_on_signals
from tests.analysis.reproduction.test_campaign import ask, made
from tests.analysis.reproduction.test_campaign import command as reproduce_command
from tests.app.test_headless import SMALL, command, outcome

PATIENCE = 120


@pytest.fixture
def common(tmp_path):
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: paper\nduration: 20\n")
    return [*SMALL, "--scenario", str(scenario), "--generations"]


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_stopped_while_it_compiles_it_goes_on_later(tmp_path, common, number, monkeypatch):
    whole, part = tmp_path / "whole", tmp_path / "part"
    assert main([*common, "3", "--out", str(whole)]) == 0
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "nothing compiled yet"))
    process = command(*common, "3", "--out", str(part))
    said = process.stderr.readline()
    assert said.startswith("Compiling")
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert "Traceback" not in err
    if number == signal.SIGKILL:
        assert process.returncode == -signal.SIGKILL
    else:
        assert process.returncode == 130
        assert err == f"Stopped. Resume with: geswarm-ui --no-ui --resume {part}\n"
    monkeypatch.undo()
    assert main(["--no-ui", "--resume", str(part)]) == 0
    assert outcome(part) == outcome(whole)


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_reproduce_stopped_while_it_compiles_goes_on_later(tmp_path, number, monkeypatch):
    whole, part = tmp_path / "whole", tmp_path / "part"
    assert reproduce(ask(whole)) == 0
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "nothing compiled yet"))
    arguments = ask(part)
    process = reproduce_command(arguments)
    assert process.stderr.readline().startswith("Compiling")
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert err == f"Stopped. Go on with: geswarm reproduce --out {part}\n"
    monkeypatch.undo()
    assert reproduce(arguments) == 0
    assert made(part) == made(whole)


def test_a_second_ctrl_c_does_not_wait():
    with stop_on_signals() as stop:
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.is_set()
        os.kill(os.getpid(), signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


@contextlib.contextmanager
def small_disk(place):
    """A file system of eight megabytes, where one may be mounted."""
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", str(place)]
    if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no file system may be mounted here: needs root in its own right")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


def fill(path):
    """Write until there is no room left."""
    with path.open("ab", buffering=0) as file, contextlib.suppress(OSError):
        while True:
            file.write(b"x" * 4096)


def test_a_disk_that_is_full_is_said_and_costs_nothing(tmp_path, common, capsys):
    assert main([*common, "40", "--out", str(tmp_path / "whole")]) == 0
    with small_disk(tmp_path / "disk") as disk:
        room = disk / "room"
        room.write_bytes(b"x" * 7_600_000)
        part = disk / "run"
        assert main([*common, "40", "--out", str(part)]) == 1
        err = capsys.readouterr().err
        assert "cannot write" in err
        assert f"--resume {part}" in err
        assert main(["--no-ui", "--resume", str(part)]) in (1, 2)  # it is still full
        assert "Traceback" not in capsys.readouterr().err
        room.unlink()
        assert main(["--no-ui", "--resume", str(part)]) == 0
        assert outcome(part) == outcome(tmp_path / "whole")


def test_a_disk_without_any_room_is_said(tmp_path, common, capsys):
    with small_disk(tmp_path / "disk") as disk:
        fill(disk / "room")
        assert main([*common, "3", "--out", str(disk / "run")]) == 2
        err = capsys.readouterr().err
        assert str(disk / "run") in err
        assert "Traceback" not in err
        assert not (disk / "run" / "run.db").exists()


@pytest.mark.slow
def test_a_full_disk_under_reproduce_is_said_and_costs_nothing(tmp_path, capsys):
    assert reproduce(ask(tmp_path / "whole")) == 0
    with small_disk(tmp_path / "disk") as disk:
        room = disk / "room"
        arguments = ask(disk / "campaign")
        for left in (100_000, 500_000):  # less than a run needs, and then than the report
            fill(room)
            with room.open("ab") as file:
                file.truncate(room.stat().st_size - left)
            assert reproduce(arguments) == 1
            err = capsys.readouterr().err
            assert "cannot" in err
            assert f"Go on with: geswarm reproduce --out {disk / 'campaign'}" in err
            assert "Traceback" not in err
        assert not (disk / "campaign" / "report.html").exists()
        room.unlink()
        assert reproduce(arguments) == 0
        assert made(disk / "campaign") == made(tmp_path / "whole")
