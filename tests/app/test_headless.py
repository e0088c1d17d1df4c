"""`geswarm-ui --no-ui` as a user calls it."""

import json
import os
import random
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing

import pytest

from geswarm.app.main import main
from geswarm.evaluation import shown
from geswarm.evolution import EvolutionRun, RunConfig
from geswarm.ge import Settings
from geswarm.rules import find_rule_set, first_difference, load_rule_set, parse_text
from geswarm.sim import load_scenario, vocabulary_of

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


def command(*arguments, **options):
    return subprocess.Popen(
        [sys.executable, "-m", "geswarm.app.main", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
        **options,
    )


def outcome(directory):
    """All that a run leaves, without the seconds: rows, population, everyone who was bred."""
    with closing(sqlite3.connect(directory / "run.db")) as database:
        tables = [
            database.execute(f"SELECT * FROM {name}").fetchall()
            for name in ("checkpoint", "individual", "steering")
        ]
    return rows(directory), tables, (directory / "config.yaml").read_bytes()


def generations(directory):
    history = directory / "history.csv"
    return len(history.read_text().splitlines()) if history.exists() else 0


def killed_again_and_again(common, directory, kills, seed):
    """Run to the end though it is killed at random moments; returns how often it was."""
    moments = random.Random(seed)
    killed = 0
    while killed < kills:
        begun = (directory / "run.db").exists()
        process = command(*(["--no-ui", "--resume", str(directory)] if begun else common))
        before = generations(directory)
        starting = time.monotonic() + moments.uniform(0.2, 1.5)
        early = moments.random() < 0.2  # perhaps before anything is written
        while process.poll() is None and not (
            time.monotonic() > starting if early else generations(directory) > before
        ):
            time.sleep(0.002)
        time.sleep(moments.uniform(0.0, 0.2))
        process.kill()
        process.communicate()
        if process.returncode == 0:
            break
        killed += 1
    begun = (directory / "run.db").exists()
    assert main(["--no-ui", "--resume", str(directory)] if begun else common) == 0
    return killed


@pytest.mark.parametrize(
    ("preset", "kills"),
    [
        pytest.param("modern", 3, marks=pytest.mark.slow),
        pytest.param("paper", 25, marks=pytest.mark.long),
        pytest.param("modern", 25, marks=pytest.mark.long),
    ],
)
def test_killed_at_random_moments_it_ends_the_same(tmp_path, preset, kills):
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: paper\nduration: 500\n")
    common = [*SMALL, "--scenario", str(scenario), "--preset", preset]
    common += ["--generations", str(20 * kills), "--out"]
    assert main([*common, str(tmp_path / "whole")]) == 0
    part = tmp_path / "part"
    assert killed_again_and_again([*common, str(part)], part, kills, seed=kills) >= 0.8 * kills
    assert outcome(part) == outcome(tmp_path / "whole")


def limit_files():
    """Files cannot grow beyond 200 kB, as if the disk were full."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))


def test_a_full_disk_is_said_and_costs_nothing(tmp_path, quick):
    common = [*SMALL, *quick, "--generations", "60", "--out"]
    assert main([*common, str(tmp_path / "whole")]) == 0
    part = tmp_path / "part"
    process = command(*common, str(part), preexec_fn=limit_files)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "cannot write" in err
    assert f"--resume {part}" in err
    assert "Traceback" not in err
    assert 1 < len(rows(part)) < 61
    assert main(["--no-ui", "--resume", str(part)]) == 0
    assert outcome(part) == outcome(tmp_path / "whole")


@pytest.mark.skipif(os.geteuid() != 0, reason="needs root to become another user")
def test_a_directory_that_may_not_be_written_is_said(tmp_path, quick):
    out = tmp_path / "run"
    assert main([*SMALL, *quick, "--generations", "2", "--out", str(out)]) == 0
    for path in (out, *out.parents):
        if not path.stat().st_mode & 0o005:  # others may look into it, and into nothing else
            path.chmod(0o755)
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    said = tmp_path / "said"
    child = os.fork()
    if child == 0:
        os.dup2(os.open(said, os.O_CREAT | os.O_WRONLY), 2)
        sys.stderr = os.fdopen(2, "w")
        os.setuid(65534)
        status = main(["--no-ui", "--resume", str(out)])
        sys.stderr.flush()
        os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 2
    assert str(out) in said.read_text()
    assert "Traceback" not in said.read_text()
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


def test_a_finished_run_goes_on_to_another_end(tmp_path, quick, capsys):
    part, whole = tmp_path / "part", tmp_path / "whole"
    assert main([*SMALL, *quick, "--generations", "6", "--out", str(whole)]) == 0
    assert main([*SMALL, *quick, "--generations", "3", "--out", str(part)]) == 0
    resume = ["--no-ui", "--resume", str(part)]
    assert main([*resume, "--generations", "2"]) == 2
    assert "generations: 3 are done, expected as many or more, got 2" in capsys.readouterr().err
    assert main([*resume, "--generations", "6"]) == 0
    assert outcome(part) == outcome(whole)
    config = part / "config.yaml"
    config.write_text(config.read_text().replace("generations: 6", "generations: 60"))
    assert main(resume) == 0
    assert "config.yaml had been changed; what counts is run.db" in capsys.readouterr().err
    assert outcome(part) == outcome(whole)


def test_a_run_that_another_process_writes_is_refused(tmp_path, quick, capsys):
    out = tmp_path / "run"
    common = [*SMALL, *quick, "--generations", "100000", "--out", str(out)]
    process = command(*common)
    while generations(out) < 3:
        assert process.poll() is None
        time.sleep(0.01)
    assert main(["--no-ui", "--resume", str(out)]) == 2
    assert main(common) == 2
    assert capsys.readouterr().err.count("another process is at work on this run") == 2
    done = generations(out)
    while generations(out) < done + 3:
        assert process.poll() is None
        time.sleep(0.01)
    process.kill()
    process.communicate()
    assert main(["--no-ui", "--resume", str(out), "--generations", str(generations(out) + 3)]) == 0


def test_the_best_does_not_fall_without_a_word(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("geswarm.app.headless._LOG_SECONDS", 0.0)
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: paper\nduration: 300\n")
    arguments = ["--preset", "modern", "--population", "20", "--generations", "20", "--seed", "2"]
    out = tmp_path / "run"
    assert main(["--no-ui", "--scenario", str(scenario), *arguments, "--out", str(out)]) == 0
    best = [float(row.split(",")[1]) for row in rows(out)[1:]]
    fell = [at for at, value in enumerate(best) if shown(value) != shown(max(best[: at + 1]))]
    assert fell, "expected a seed with which the best falls"
    said = capsys.readouterr().err
    for at in fell:
        words = f"re-evaluated: {shown(max(best[: at + 1]))} → {shown(best[at])}"
        assert f"generation {at + 1}: best {shown(best[at])} ({words})" in said


def test_presets(tmp_path, quick, capsys):
    out = tmp_path / "run"
    assert (
        main([*SMALL, *quick, "--preset", "modern", "--generations", "2", "--out", str(out)]) == 0
    )
    assert "selection: tournament" in (out / "config.yaml").read_text()
    with sqlite3.connect(out / "run.db") as database:
        parents = database.execute("SELECT parents FROM individual WHERE generation = 2").fetchall()
    assert all(1 <= len(json.loads(one)) <= 2 for (one,) in parents)


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
        (["--no-ui", "--preset", "best"], "preset: expected paper or modern, got 'best'"),
        (["--no-ui", "--resume", "x", "--preset", "paper"], "--preset is fixed by the run"),
        (["--no-ui", "--cluster", "x", "--workers", "2"], "--workers is for this machine"),
        (["--cluster", "x"], "--cluster needs --no-ui"),
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


def test_the_help_tells_the_defaults_of_the_presets(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    told = " ".join(capsys.readouterr().out.split())
    paper, modern = Settings.preset("paper"), Settings.preset("modern")
    assert f"default: {paper.population}, in modern {modern.population}" in told
    assert f"default: {paper.evaluations}, in modern {modern.evaluations}" in told


def test_a_directory_with_a_run_is_not_overwritten(tmp_path, quick, capsys):
    out = tmp_path / "run"
    common = [*SMALL, *quick, "--generations", "1", "--out", str(out)]
    assert main(common) == 0
    before = (out / "history.csv").read_bytes()
    assert main(common) == 2
    assert "resume this run" in capsys.readouterr().err
    assert (out / "history.csv").read_bytes() == before


def test_messages_speak_of_the_objective_in_its_own_sign(tmp_path, capsys):
    path = tmp_path / "away.yaml"
    path.write_text(
        "extends: aac\nduration: 5\nobjective: {minimise: on_black, unit: robot-steps}\n"
    )
    out = tmp_path / "run"
    common = ["--scenario", str(path), "--preset", "modern", "--generations", "2"]
    assert main([*SMALL, *common, "--out", str(out)]) == 0
    said = capsys.readouterr().err
    assert "to minimise on_black (robot-steps)" in said
    assert "Finished: on_black (robot-steps) of " in said
    assert f"--rules {out / 'best.yaml'} --scenario {path}" in said
    assert "best -" not in said
    assert ": -" not in said
    best = find_rule_set(str(out / "best.yaml"))
    assert best.scenario == "away"
    rules = best.read(vocabulary_of(load_scenario(path)))
    assert rules.origin.fitness >= 0


def test_it_starts_from_given_rules_and_resumes_so(tmp_path, quick, capsys):
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    given = [*SMALL, *quick, "--seed", "3", "--start-from", "evo8", "--generations", "3"]
    assert main([*given, "--out", str(whole)]) == 0
    with closing(sqlite3.connect(whole / "run.db")) as database:
        query = "SELECT phenotype FROM individual WHERE generation = 1"
        first = [parse_text(text) for (text,) in database.execute(query)]
    evo8 = load_rule_set("evo8")
    assert sum(first_difference(each, evo8) is None for each in first) == 1
    assert len(first) == 9  # in place of the worst
    config = RunConfig(load_scenario(quick[1]), EvolutionRun.read(whole).config.settings, 3)
    EvolutionRun.create(config, cut, evo8).close()  # killed before the first generation was done
    assert main(["--no-ui", "--resume", str(cut)]) == 0
    assert rows(cut) == rows(whole)


def test_numbers_that_do_not_evolve_start_as_the_nearest(tmp_path, capsys):
    scenario = tmp_path / "quick.yaml"
    scenario.write_text("extends: aac\nduration: 2\n")
    rules = tmp_path / "mine.rules"
    rules.write_text("rule do p = 0.1, ATTRACTION(2.2)\nrule while ATTRACTION(2.2) do p = 1, STOP")
    given = [
        *SMALL,
        "--scenario",
        str(scenario),
        "--generations",
        "1",
        "--out",
        str(tmp_path / "r"),
    ]
    assert main([*given, "--start-from", str(rules)]) == 0
    told = capsys.readouterr().err
    assert f"Starts from {rules} with the nearest numbers that evolve: ATTRACTION(2.2) as " in told


@pytest.mark.parametrize(
    ("rules", "problem"),
    [
        ("rule do p = 0.3, RANDOM_WALK", "--start-from {}: rule 1: p = 0.3 cannot evolve"),
        ("rule do p = 0.1, STOP", "STOP"),
        ("rule off do p = 0.1, PHOTOTAXIS", "expected more than 0 rules switched on"),
    ],
)
def test_rules_that_cannot_be_started_from_are_told(tmp_path, quick, capsys, rules, problem):
    file, out = tmp_path / "mine.rules", tmp_path / "run"
    file.write_text(rules)
    given = [*SMALL, *quick, "--generations", "1", "--out", str(out), "--start-from", str(file)]
    assert main(given) == 2
    assert problem.format(file) in capsys.readouterr().err
    assert not out.exists()
