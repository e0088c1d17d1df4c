"""A campaign end to end, in a tiny form: interrupted, refused, and read again."""

import csv
import random
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest

from geswarm import __version__
from geswarm.analysis.reproduction import Campaign, CampaignError, Plan, Verdict
from geswarm.cli import main
from geswarm.cli.reproduce import _duration
from geswarm.evolution import EvolutionRun
from geswarm.rules import load_rule_set
from geswarm.sim import EvaluationStopped

TINY = Plan(runs=2, generations=2, evaluations=3)


def ask(directory, plan=TINY):
    """Begin a campaign that the command then finds and goes on with."""
    directory.mkdir()
    (directory / "campaign.yaml").write_text(plan.to_yaml())
    return ["reproduce", "--out", str(directory)]


def made(directory):
    """All files that must not depend on interruptions."""
    paths = [directory / "report.html", *directory.glob("data/*"), *directory.glob("rules/*")]
    return {str(path.relative_to(directory)): path.read_bytes() for path in paths}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    directory = tmp_path_factory.mktemp("reproduction") / "whole"
    assert main(ask(directory)) == 0
    return directory


@pytest.mark.slow
def test_everything_is_there(whole):
    assert {path.name for path in whole.glob("data/*")} == {
        *("history.csv", "claims.csv", "contrasts.csv", "scaling.csv", "agreement.csv"),
        *("performance.csv", "scalability.csv", "flexibility.csv", "sensitivity.csv"),
    }
    rules = sorted(path.name for path in whole.glob("rules/*"))
    assert rules == ["best.yaml", "evo-8.yaml", "hand-coded.yaml", "seed-1.yaml", "seed-2.yaml"]
    assert load_rule_set(str(whole / "rules" / "evo-8.yaml")) == load_rule_set("evo8")
    best = load_rule_set(str(whole / "rules" / "best.yaml"))
    assert best.origin.run in ("evolution/seed-1", "evolution/seed-2")
    with (whole / "data" / "performance.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["rules"] for row in rows[::3]] == ["seed 1", "seed 2", "EVO 8", "hand-coded"]
    assert {row["scenario"] for row in rows} == {"paper"}
    with (whole / "data" / "claims.csv").open() as file:
        verdicts = {row["verdict"] for row in csv.DictReader(file)}
    assert verdicts <= {verdict.value for verdict in Verdict}


@pytest.mark.slow
def test_a_finished_campaign_is_read_and_not_run_again(whole, capsys):
    before = {path: path.stat().st_mtime_ns for path in whole.glob("data/performance.csv")}
    files = made(whole)
    assert main(["reproduce", "--out", str(whole)]) == 0
    captured = capsys.readouterr()
    assert len(captured.out.splitlines()) == 14
    assert str(whole / "report.html") in captured.err
    assert made(whole) == files
    assert {path: path.stat().st_mtime_ns for path in before} == before


@pytest.mark.slow
def test_runs_that_are_there_are_adopted(whole, tmp_path):
    place = tmp_path / "adopted" / "evolution"
    place.mkdir(parents=True)
    for seed, generations in ((1, 2), (2, 1)):
        run = EvolutionRun.create(TINY.run_config(seed), place / f"seed-{seed}")
        run.run(stop=lambda run=run, generations=generations: len(run.history) == generations)
        run.close()
    asked = {"runs": 2, "generations": 2, "evaluations": 3}
    Campaign.at(place.parent, **asked).run(workers=1)
    assert made(place.parent) == made(whole)


@pytest.mark.slow
def test_a_campaign_that_is_extended_is_the_one_that_was_larger_from_the_start(whole, tmp_path):
    directory = tmp_path / "part"
    assert main(ask(directory, Plan(runs=1, generations=1, evaluations=3))) == 0
    (directory / "campaign.yaml").write_text(
        (directory / "campaign.yaml").read_text().replace(__version__, "0.0.7")
    )
    asked = ["reproduce", "--out", str(directory), "--runs", "2", "--generations", "2"]
    kept = (directory / "data" / "sensitivity.csv").stat().st_mtime_ns
    assert main(asked) == 0
    assert made(directory) == made(whole)
    assert (directory / "data" / "sensitivity.csv").stat().st_mtime_ns == kept
    assert "began with GESwarm 0.0.7" in Campaign.at(directory).remarks[0]


def test_what_an_extension_makes_wrong_is_gone_before_it_begins(tmp_path):
    directory = tmp_path / "tiny"
    ask(directory)
    (directory / "data").mkdir()
    for name in ("report.html", "data/performance.csv", "data/sensitivity.csv"):
        (directory / name).write_text("of two generations")
    assert Campaign.at(directory, generations=3).plan == replace(TINY, generations=3)
    assert Campaign.at(directory).plan.generations == 3
    assert [path.name for path in (directory / "data").iterdir()] == ["sensitivity.csv"]
    assert not (directory / "report.html").exists()


def command(arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "geswarm.cli", *arguments], stderr=subprocess.PIPE, text=True
    )


def interrupted(directory, kills, moments):
    """Interrupt the command at random moments, by turns cleanly and by force; how often it was."""
    arguments = ask(directory)
    hits = 0
    for kill in range(kills):
        process = command(arguments)
        before = len(made_or_evolved(directory))
        early = moments.random() < 0.3
        while process.poll() is None and not early and len(made_or_evolved(directory)) == before:
            time.sleep(0.01)
        time.sleep(moments.uniform(0.0, 0.4))
        process.send_signal(signal.SIGKILL if kill % 2 else signal.SIGTERM)
        _, err = process.communicate(timeout=120)
        if process.returncode == 130:
            assert f"Go on with: geswarm reproduce --out {directory}" in err
        assert "Traceback" not in err
        hits += process.returncode != 0
    assert main(arguments) == 0
    return hits


def made_or_evolved(directory):
    return [*directory.glob("data/*.csv"), *directory.glob("evolution/*/history.csv")]


@pytest.mark.parametrize(
    "kills",
    [pytest.param(4, marks=pytest.mark.slow), pytest.param(25, marks=pytest.mark.long)],
)
def test_interrupted_at_random_moments_it_ends_the_same(whole, tmp_path, kills):
    directory = tmp_path / "part"
    assert interrupted(directory, kills, random.Random(kills)) >= 2
    assert made(directory) == made(whole)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.2, "0 s"), (59, "59 s"), (90, "2 min"), (5399, "90 min"), (9000, "2.5 h")],
)
def test_the_time_left_is_short(seconds, words):
    assert _duration(seconds) == words


def test_stop_keeps_what_is_done(tmp_path):
    campaign = Campaign.at(tmp_path / "new", runs=2, generations=2)
    shares = []
    with pytest.raises(EvaluationStopped):
        campaign.run(
            on_progress=lambda share, doing: shares.append((share, doing)),
            stop=lambda: len(shares) > 1,
        )
    assert shares[0] == (0.0, "reading what is done")
    assert shares[1][1].startswith("seed 1, generation 1, best ")
    assert campaign.parts()[0].done == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--runs", "1"], "holds a campaign with runs 2 and not 1; choose another directory"),
        (["--runs", "3", "--generations", "1"], "runs 2 and not 3, generations 2 and not 1"),
        (["--runs", "10001"], "runs: expected at most 10000, got 10001"),
        (["--generations", "1000001"], "generations: expected at most 1000000, got 1000001"),
        (["--quick"], "generations 2 and not 50, evaluations 3 and not 20"),
        (["--seed", "2"], "seed 1 and not 2"),
        (["--workers", "2", "--cluster", "x"], "--workers is for this machine"),
        (["--runs", "0"], "expected a whole number >= 1"),
    ],
)
def test_another_campaign_is_refused(tmp_path, arguments, message, capsys):
    arguments = [*ask(tmp_path / "tiny"), *arguments]
    try:
        status = main(arguments)
    except SystemExit as error:
        status = error.code
    assert status == 2
    assert message in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "tiny").iterdir()] == ["campaign.yaml"]


def test_no_scheduler_is_one_clear_message(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("geswarm.evolution.cluster._PATIENCE", 0.2)
    assert main([*ask(tmp_path / "tiny"), "--cluster", "tcp://127.0.0.1:9"]) == 2
    error = capsys.readouterr().err
    assert "tcp://127.0.0.1:9: expected a Dask scheduler" in error or "pip install" in error


def test_a_directory_with_something_else_is_refused(tmp_path, capsys):
    (tmp_path / "thesis.tex").write_text("x")
    assert main(["reproduce", "--out", str(tmp_path)]) == 2
    assert "expected an empty directory or a campaign, found thesis.tex" in capsys.readouterr().err
    assert main(["reproduce", "--out", str(tmp_path / "thesis.tex")]) == 2
    assert "thesis.tex" in capsys.readouterr().err
    assert main(["reproduce", "--out", "/proc/nowhere"]) == 2
    assert "/proc/nowhere" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize(
    "text", ["", "runs: 3", "[1, 2", "geswarm: 1\nruns: x\ngenerations: 1\nevaluations: 2\nseed: 1"]
)
def test_a_damaged_campaign_file_is_refused(tmp_path, text):
    (tmp_path / "campaign.yaml").write_text(text)
    with pytest.raises(CampaignError, match=r"campaign\.yaml: "):
        Campaign.at(tmp_path)


def test_a_campaign_of_another_version_says_so(tmp_path):
    assert Campaign.at(tmp_path, runs=1, generations=2).remarks == ()
    plan = tmp_path / "campaign.yaml"
    plan.write_text(plan.read_text().replace(f"geswarm: {__version__}", "geswarm: 0.0.7"))
    (remark,) = Campaign.at(tmp_path).remarks
    assert f"began with GESwarm 0.0.7 and goes on with {__version__}" in remark
    plan.write_text(plan.read_text() + "castes: 2\n")
    with pytest.raises(CampaignError, match=r"expected the keys .* got .*castes"):
        Campaign.at(tmp_path)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda config: replace(config, settings=replace(config.settings, generations=3)),
        lambda config: replace(
            config, settings=replace(config.settings, generations=1, mutation=0)
        ),
        lambda config: replace(config, seed=2),
    ],
)
def test_a_foreign_run_is_refused(tmp_path, wrong):
    campaign = Campaign.at(tmp_path, runs=1, generations=2)
    config = wrong(Plan(generations=2).run_config(1))
    EvolutionRun.create(config, tmp_path / "evolution" / "seed-1").close()
    with pytest.raises(CampaignError, match="expected a run in the scenario paper with the preset"):
        campaign.run()


@pytest.mark.slow
def test_damaged_data_are_refused_and_nothing_is_overwritten(whole, tmp_path, capsys):
    damaged = whole / "data" / "performance.csv"
    text = damaged.read_text()
    for wrong in ("", text[:-9], text.replace("seed 1", "seed 3"), text + "x,y\n"):
        damaged.write_text(wrong)
        assert main(["reproduce", "--out", str(whole)]) == 1
        assert "not the performance runs of this campaign; delete it" in capsys.readouterr().err
        assert damaged.read_text() == wrong
    damaged.write_text(text)


@pytest.mark.slow
def test_what_cannot_be_written_is_said_and_can_be_mended(tmp_path, capsys):
    arguments = ask(tmp_path / "full", Plan(runs=1, generations=1, evaluations=2))
    obstacle = tmp_path / "full" / "data"
    obstacle.write_text("in the way")
    assert main(arguments) == 1
    err = capsys.readouterr().err
    assert f"{obstacle / 'performance.csv'}: cannot be written" in err
    assert f"Go on with: geswarm reproduce --out {tmp_path / 'full'}" in err
    obstacle.unlink()
    assert main(arguments) == 0
