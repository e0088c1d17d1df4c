"""`geswarm-ui --no-ui` as a user calls it."""

import os
import signal
import subprocess
import sys
import time

import pytest

from geswarm.app.main import main
from geswarm.rules import load_rule_set

SMALL = ["--no-ui", "--population", "8", "--evaluations", "1"]


@pytest.fixture
def quick(tmp_path):
    path = tmp_path / "quick.yaml"
    path.write_text("extends: paper\nduration: 20\n")
    return ["--scenario", str(path)]


def rows(directory):
    lines = (directory / "history.csv").read_text().splitlines()
    return [line.rpartition(",")[0] for line in lines]


def test_evolves_to_the_end_and_says_where_the_best_is(tmp_path, quick, capsys):
    out = tmp_path / "run"
    assert main([*SMALL, *quick, "--generations", "3", "--out", str(out), "--seed", "4"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert str(out / "best.yaml") in captured.err
    assert "generation 1" in captured.err
    assert load_rule_set(str(out / "best.yaml")).rules
    assert len(rows(out)) == 4


def test_same_history_whatever_the_workers(tmp_path, quick):
    for workers in ("1", "2"):
        out = str(tmp_path / workers)
        assert main([*SMALL, *quick, "--generations", "3", "--out", out, "--workers", workers]) == 0
    assert rows(tmp_path / "1") == rows(tmp_path / "2")


def command(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "geswarm.app.main", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_stopped_at_any_moment_it_goes_on_exactly(tmp_path, quick, number):
    whole, part = tmp_path / "whole", tmp_path / "part"
    common = [*SMALL, *quick, "--generations", "60"]
    assert main([*common, "--out", str(whole)]) == 0
    process = command(*common, "--out", str(part))
    history = part / "history.csv"
    while not history.exists() or len(history.read_text().splitlines()) < 4:
        assert process.poll() in (None, 0)
        time.sleep(0.005)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    if number != signal.SIGKILL and process.returncode != 0:
        assert process.returncode == 130
        assert f"Resume with: geswarm-ui --no-ui --resume {part}" in err
    assert main(["--no-ui", "--resume", str(part)]) == 0
    assert rows(part) == rows(whole)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--no-ui", "--port", "80"], "--port is for the dashboard, not for --no-ui"),
        (["--generations", "5"], "--generations needs --no-ui"),
        (["--no-ui", "--resume", "x", "--seed", "1"], "--seed is fixed by the run"),
        (["--no-ui", "--resume", "nowhere"], "nowhere: expected a run directory"),
        (["--no-ui", "--scenario", "moon"], "moon"),
        (["--no-ui", "--population", "1"], "population: expected a whole number >= 2"),
        (["--no-ui", "--out", "/proc/nowhere"], "/proc/nowhere"),
        (["--port", "99999"], "expected 0 to 65535"),
        (["--rules", "evo9"], "evo9: neither a file"),
        (["--host", "not a host"], "not a host"),
    ],
)
def test_usage_errors_exit_2_with_one_clear_message(arguments, message, capsys):
    try:
        status = main(arguments)
    except SystemExit as error:
        status = error.code
    captured = capsys.readouterr()
    assert status == 2
    assert message in captured.err
    assert "Traceback" not in captured.err


def test_a_directory_with_a_run_is_not_overwritten(tmp_path, quick, capsys):
    out = tmp_path / "run"
    common = [*SMALL, *quick, "--generations", "1", "--out", str(out)]
    assert main(common) == 0
    before = (out / "history.csv").read_bytes()
    assert main(common) == 2
    assert "resume this run" in capsys.readouterr().err
    assert (out / "history.csv").read_bytes() == before
