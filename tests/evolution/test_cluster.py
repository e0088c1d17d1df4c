"""Evaluation by any executor: the same history, whoever does the work and whoever dies."""

import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from types import SimpleNamespace

import pytest

from geswarm.app.main import main
from geswarm.evolution import (
    ClusterError,
    Composition,
    EvaluationError,
    EvolutionRun,
    RunConfig,
    cluster,
    cluster_executor,
)
from geswarm.evolution.fitness import simulate_share
from geswarm.ge import Settings
from geswarm.sim import Simulation, load_scenario

QUICK = load_scenario("paper").with_changes(duration=2000.0)
CONFIG = RunConfig(QUICK, Settings.preset("modern", population=20, generations=3), seed=5)


def rows(directory):
    lines = (directory / "history.csv").read_text().splitlines()
    return [line.rpartition(",")[0] for line in lines]


def evolved(directory, config=CONFIG, **options):
    run = EvolutionRun.create(config, directory)
    try:
        run.run(**options)
    finally:
        run.close()
    return rows(directory)


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return evolved(tmp_path_factory.mktemp("threads") / "run", workers=2)


def test_threads_of_an_executor(tmp_path, expected):
    with ThreadPoolExecutor(3) as executor:
        assert evolved(tmp_path / "run", executor=executor) == expected


@pytest.mark.slow
def test_processes(tmp_path, expected):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        assert evolved(tmp_path / "run", executor=executor) == expected


def test_an_executor_that_fails_loses_only_the_generation(tmp_path, expected):
    executor = ThreadPoolExecutor(2)
    run = EvolutionRun.create(CONFIG, tmp_path / "run")
    with pytest.raises(EvaluationError, match="could not be run: RuntimeError: cannot schedule"):
        run.run(on_generation=lambda _: executor.shutdown(), executor=executor)
    assert len(run.history) == 1
    run.close()
    again = EvolutionRun.resume(tmp_path / "run")
    again.run(workers=2)
    again.close()
    assert rows(tmp_path / "run") == expected


def test_stop_while_an_executor_works(tmp_path):
    stop = threading.Event()
    with ThreadPoolExecutor(1) as executor:
        run = EvolutionRun.create(CONFIG, tmp_path / "run")
        executor.submit(stop.set)
        run.run(stop=stop.is_set, executor=executor)
        assert not run.finished
        run.close()


def test_another_version_is_refused():
    with pytest.raises(RuntimeError, match=r"expected GESwarm 0\.0\.0 on every worker"):
        simulate_share("0.0.0", QUICK, Composition(), ["rule"], [Simulation(0, 0)])


def test_no_scheduler_or_no_dask_is_one_clear_message(capsys, monkeypatch):
    monkeypatch.setattr("geswarm.evolution.cluster._PATIENCE", 0.2)
    assert main(["--no-ui", "--cluster", "tcp://127.0.0.1:9", "--out", "nowhere"]) == 2
    error = capsys.readouterr().err
    assert "tcp://127.0.0.1:9: expected a Dask scheduler" in error or "pip install" in error
    assert "Traceback" not in error

    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr("geswarm.evolution.cluster.import_module", missing)
    words = "pip install 'geswarm"
    with pytest.raises(ClusterError, match=words), cluster_executor("tcp://x", print):
        pass


@pytest.fixture
def scheduler(monkeypatch):
    """A Dask scheduler in this process that has no workers yet."""
    distributed = pytest.importorskip("distributed", reason="needs the extra: geswarm[cluster]")
    monkeypatch.setattr("geswarm.evolution.cluster._LOOK_SECONDS", 0.1)
    monkeypatch.setattr("geswarm.evolution.cluster._AGAIN_SECONDS", 0.3)
    with distributed.LocalCluster(
        n_workers=0, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        yield cluster


def test_something_that_listens_and_is_no_scheduler_is_given_up(monkeypatch):
    pytest.importorskip("distributed", reason="needs the extra: geswarm[cluster]")
    monkeypatch.setattr("geswarm.evolution.cluster._PATIENCE", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        words = f"{address}: expected a Dask scheduler"
        with pytest.raises(ClusterError, match=words), cluster_executor(address, print):
            pass


class Heard(list):
    """What was said; `wait` until something is said so often."""

    def wait(self, words, times=1):
        deadline = time.monotonic() + 60
        while sum(words in one for one in self) < times:
            assert time.monotonic() < deadline, f"not heard: {words}, but {self}"
            time.sleep(0.02)


def test_without_workers_it_says_so_again_and_again_and_uses_those_that_come(
    tmp_path, expected, scheduler
):
    heard, found = Heard(), []
    address = scheduler.scheduler_address
    with cluster_executor(address, heard.append) as executor:
        work = threading.Thread(
            target=lambda: found.append(evolved(tmp_path / "run", executor=executor))
        )
        work.start()
        heard.wait(f"no workers yet at {address}, waiting", times=3)
        scheduler.scale(1)
        work.join(60)
        heard.wait(f"1 worker at {address}, going on")
    assert found == [expected]


def test_paused_workers_are_told_and_used_when_they_go_on(tmp_path, expected, scheduler):
    heard, found = Heard(), []
    address = scheduler.scheduler_address
    scheduler.scale(1)
    with cluster_executor(address, heard.append) as executor:
        executor.client.wait_for_workers(1, timeout=60)
        (worker,) = scheduler.workers.values()

        def set_status(status):  # the worker itself would go on at once, as it has memory left
            change = scheduler.scheduler.handle_worker_status_change
            scheduler.loop.add_callback(change, status, worker.address, "test")

        set_status("paused")
        work = threading.Thread(
            target=lambda: found.append(evolved(tmp_path / "run", executor=executor))
        )
        work.start()
        words = f"1 worker at {address}, but none takes work (1 paused), waiting"
        heard.wait(words, times=2)
        set_status("running")
        work.join(60)
        heard.wait(f"1 worker at {address}, going on")
    assert found == [expected]


@pytest.mark.parametrize(
    ("workers", "words"),
    [
        ([("paused", 1), ("running", 0), ("paused", 2)], "3 workers .*2 paused, 1 without threads"),
        ([("closing_gracefully", 4)], r"1 worker .*\(1 closing_gracefully\)"),
        ([], "no workers yet"),
        ([("paused", 1), ("running", 1)], None),
    ],
)
def test_workers_that_take_no_work_are_no_workers(workers, words, monkeypatch):
    monkeypatch.setattr(cluster, "_LOOK_SECONDS", 0.01)
    listed = {str(n): {"status": s, "nthreads": t} for n, (s, t) in enumerate(workers)}
    client = SimpleNamespace(
        status="running",
        scheduler=SimpleNamespace(identity=None),
        sync=lambda *_, **__: {"workers": listed},
        get_executor=lambda pure: None,
    )
    executor, heard, ended = cluster._ClusterExecutor(client), Heard(), threading.Event()
    executor._waiting.add("something")
    watch = threading.Thread(target=cluster._watch, args=(executor, "here", heard.append, ended))
    watch.start()
    if words is None:
        time.sleep(0.1)
    else:
        heard.wait("waiting")
    ended.set()
    watch.join(60)
    assert heard == [] if words is None else re.search(words, heard[0])


def test_a_scheduler_that_goes_away_ends_the_wait(tmp_path, scheduler):
    heard, run = Heard(), EvolutionRun.create(CONFIG, tmp_path / "run")
    with cluster_executor(scheduler.scheduler_address, heard.append) as executor:
        end = threading.Thread(target=lambda: (heard.wait("no workers yet"), scheduler.close()))
        end.start()
        with pytest.raises(EvaluationError, match="the scheduler of the cluster is gone"):
            run.run(executor=executor)
        end.join(60)
    run.close()


WORKER = """
import sys
sys.modules["geswarm"] = None  # as if it were not installed
from distributed.cli.dask_worker import main
main()
"""


def test_a_worker_without_geswarm_is_an_error_and_lives(tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        options = ["--no-nanny", "--nthreads", "1", "--no-dashboard"]
        worker = subprocess.Popen([sys.executable, "-c", WORKER, address, *options])
        run = EvolutionRun.create(CONFIG, tmp_path / "run")
        try:
            words = "a worker cannot import what it needs, GESwarm .*: ModuleNotFoundError"
            with (
                cluster_executor(address, print) as executor,
                pytest.raises(EvaluationError, match=words),
            ):
                run.run(executor=executor)
            assert worker.poll() is None
        finally:
            run.close()
            worker.kill()
            worker.wait()


@pytest.mark.slow
def test_a_dask_worker_that_is_killed_loses_nothing(tmp_path):
    distributed = pytest.importorskip("distributed", reason="needs the extra: geswarm[cluster]")
    config = RunConfig(
        load_scenario("paper").with_changes(robots=20),
        Settings.preset("modern", population=30, generations=3),
        seed=6,
    )
    whole = evolved(tmp_path / "threads", config, workers=2)
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, cluster_executor(cluster.scheduler_address, print) as executor:
        victim = next(iter(cluster.workers.values())).pid

        def kill(record):
            if record.generation == 1:  # in the middle of generation 2
                timer = threading.Timer(0.15, os.kill, (victim, signal.SIGKILL))
                timer.start()

        assert evolved(tmp_path / "dask", config, executor=executor, on_generation=kill) == whole
        with pytest.raises(ProcessLookupError):
            os.kill(victim, 0)
