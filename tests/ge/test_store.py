import csv
import json
import os
import sqlite3
import threading
from dataclasses import replace

import pytest

from geswarm.ge.database import StoreError
from geswarm.ge.engine import Engine
from geswarm.ge.evolve import Stopped, evolve
from geswarm.ge.locks import is_written
from geswarm.ge.settings import Settings
from geswarm.ge.store import RunStore

SMALL = Settings(population=12, generations=8)
CONFIG = "seed: 3\nscenario: toy\n"


def objective(generation, individuals):
    return [len(set(one.phenotype.split())) + (one.key + generation) % 3 for one in individuals]


def rows(directory):
    """history.csv without the seconds."""
    lines = (directory / "history.csv").read_bytes().decode().splitlines()
    return [line.rsplit(",", 1)[0] for line in lines]


@pytest.fixture
def finished(grammar, tmp_path):
    with RunStore.create(tmp_path / "whole", CONFIG) as store:
        evolve(Engine(grammar, SMALL, 3), objective, store)
    return tmp_path / "whole"


def resume(grammar, directory):
    with RunStore.open(directory) as store:
        state = store.checkpoint()
        engine = Engine.restore(grammar, SMALL, 3, state) if state else Engine(grammar, SMALL, 3)
        evolve(engine, objective, store)
        return store.checkpoint()


def test_what_a_run_leaves(finished):
    assert {path.name for path in finished.iterdir()} == {"run.db", "config.yaml", "history.csv"}
    assert (finished / "config.yaml").read_text() == CONFIG
    with (finished / "history.csv").open() as file:
        table = list(csv.DictReader(file))
    header = "generation,best_so_far,best,mean,invalid,distinct,seconds"
    assert ",".join(table[0]) == header
    assert [int(row["generation"]) for row in table] == list(range(1, 9))
    with RunStore.open(finished) as store:
        assert store.config == CONFIG
        assert [record.csv_row() for record in store.history()] == (
            (finished / "history.csv").read_text().splitlines()[1:]
        )
        best = store.best()
        assert best.fitness == float(table[-1]["best_so_far"])
        assert best.phenotype == store.checkpoint()["best"]["phenotype"]
        assert 1 <= best.generation <= 8
    with sqlite3.connect(finished / "run.db") as database:
        assert database.execute("SELECT generation FROM checkpoint").fetchall() == [(8,)]
        assert database.execute("SELECT count(*), max(best) FROM generation").fetchone()[0] == 8


@pytest.mark.parametrize("after", range(9))
def test_an_interrupted_run_resumes_exactly(grammar, finished, tmp_path, after):
    directory = tmp_path / "interrupted"

    def interrupted(generation, individuals):
        if generation > after:
            raise Stopped
        return objective(generation, individuals)

    with RunStore.create(directory, CONFIG) as store:
        evolve(Engine(grammar, SMALL, 3), interrupted, store)
        assert len(store.history()) == after
        assert (store.best() is None) == (after == 0)
    state = resume(grammar, directory)
    assert rows(directory) == rows(finished)
    with RunStore.open(finished) as store:
        assert json.dumps(state) == json.dumps(store.checkpoint())


def run_and_die(grammar, directory, moment):
    """Die in generation 5 without closing anything, as by kill -9."""

    def dies_at_work(generation, individuals):
        if moment == "in the objective" and generation == 5:
            os._exit(9)
        return objective(generation, individuals)

    def dies_when_told(record):
        if moment == "after the commit" and record.generation == 5:
            os._exit(9)

    store = RunStore.create(directory, CONFIG)
    evolve(Engine(grammar, SMALL, 3), dies_at_work, store, dies_when_told)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")
@pytest.mark.parametrize("moment", ["in the objective", "after the commit"])
def test_a_killed_run_resumes_exactly(grammar, finished, tmp_path, moment):
    directory = tmp_path / "killed"
    child = os.fork()
    if child == 0:
        try:
            run_and_die(grammar, directory, moment)
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    (directory / "history.csv").write_text("generation,bes")  # a torn copy is rebuilt
    (directory / "config.yaml").unlink()
    resume(grammar, directory)
    assert rows(directory) == rows(finished)
    assert (directory / "config.yaml").read_text() == CONFIG


def test_readers_see_whole_generations_while_it_is_written(grammar, tmp_path):
    with RunStore.create(tmp_path, CONFIG) as store:
        reader = RunStore.open(tmp_path, read_only=True)
        seen = []

        def look(record):
            seen.append((len(reader.history()), reader.checkpoint()["generation"]))

        writer = threading.Thread(
            target=evolve, args=(Engine(grammar, SMALL, 3), objective, store, look)
        )
        writer.start()
        writer.join()
        reader.close()
    assert seen == [(generation, generation) for generation in range(1, 9)]


def test_a_second_writer_is_refused(grammar, tmp_path):
    with RunStore.create(tmp_path, CONFIG) as store:
        for second in (RunStore.open, lambda path: RunStore.create(path, CONFIG)):
            with pytest.raises(StoreError, match="another process is at work on this run"):
                second(tmp_path)
        assert is_written(tmp_path)
        with RunStore.open(tmp_path, read_only=True) as reader:
            assert reader.config == CONFIG
        evolve(Engine(grammar, SMALL, 3), objective, store)
    assert not is_written(tmp_path)
    RunStore.open(tmp_path).close()


def test_a_second_writer_is_noticed_where_nothing_can_be_claimed(grammar, tmp_path, monkeypatch):
    monkeypatch.setattr("geswarm.ge.locks._open", lambda directory: None)
    with RunStore.create(tmp_path, CONFIG) as store, RunStore.open(tmp_path) as other:
        engine = Engine(grammar, SMALL, 3)
        evolve(engine, objective, store, stop=lambda: engine.generation == 2)
        with pytest.raises(StoreError, match="expected generation 3 next, got 1; another process"):
            evolve(Engine(grammar, SMALL, 3), objective, other)
        evolve(engine, objective, store)
        assert len(store.history()) == 8


def test_another_configuration_is_kept_and_what_was_written_over_is_known(finished):
    with RunStore.open(finished) as store:
        assert not store.config_differed
        store.change_config("seed: 4\n")
        assert (finished / "config.yaml").read_text() == store.config == "seed: 4\n"
    (finished / "config.yaml").write_bytes(b"seed: 4\r\n")
    with RunStore.open(finished) as store:
        assert not store.config_differed
    (finished / "config.yaml").write_text("seed: 5\n")
    with RunStore.open(finished) as store:
        assert store.config_differed
    assert (finished / "config.yaml").read_text() == "seed: 4\n"


def test_a_run_is_not_overwritten(finished):
    before = {path.name: path.read_bytes() for path in finished.iterdir()}
    with pytest.raises(StoreError, match=r"without a run, found run\.db"):
        RunStore.create(finished, "other")
    assert {path.name: path.read_bytes() for path in finished.iterdir()} == before


def test_no_run_there(tmp_path):
    with pytest.raises(StoreError, match=r"found no run\.db"):
        RunStore.open(tmp_path)
    with pytest.raises(StoreError, match=r"found no run\.db"):
        RunStore.open(tmp_path / "nowhere")


def test_a_directory_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(StoreError, match="cannot begin a run here"):
        RunStore.create(tmp_path / "file" / "run", CONFIG)


def foreign(path):
    with sqlite3.connect(path) as database:
        database.execute("CREATE TABLE generation (generation INTEGER)")


def newer(path):
    with sqlite3.connect(path) as database:
        database.execute("PRAGMA user_version = 99")


def text(path):
    path.write_text("this is no database, but it is long enough to look like one. " * 20)


def cut_off(path):
    path.write_bytes(path.read_bytes()[:6000])


def scrambled(path):
    data = bytearray(path.read_bytes())
    data[4096:16384] = b"\x5a" * 12288
    path.write_bytes(data)


def empty(path):
    path.write_bytes(b"")


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (text, "found a file that is no database"),
        (empty, "found a file that is no database"),
        (newer, "made by a newer GESwarm"),
        (cut_off, "damaged|malformed"),
        (scrambled, "damaged|malformed"),
    ],
)
def test_a_file_that_is_no_whole_run_is_refused_and_left_alone(finished, damage, message):
    path = finished / "run.db"
    damage(path)
    before = path.read_bytes()
    with pytest.raises(StoreError, match=message) as caught:
        RunStore.open(finished)
    assert str(finished) in str(caught.value)
    assert path.read_bytes() == before


def test_a_foreign_database_is_refused_and_left_alone(tmp_path):
    foreign(tmp_path / "run.db")
    before = (tmp_path / "run.db").read_bytes()
    with pytest.raises(StoreError, match="found another kind of database"):
        RunStore.open(tmp_path)
    assert (tmp_path / "run.db").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["run.db"]


def test_a_full_disk_loses_nothing_that_was_committed(grammar, tmp_path):
    with RunStore.create(tmp_path, CONFIG) as store:
        engine = Engine(grammar, SMALL, 3)
        records = evolve(engine, objective, store, stop=lambda: engine.generation == 3).records
        # SQLite's own way to simulate a full disk: no page more than now.
        store._connection.execute("PRAGMA max_page_count = 1")
        too_much = {**engine.state(), "padding": "x" * 100_000}
        with pytest.raises(StoreError, match="cannot write generation 4: database or disk is full"):
            store.append(replace(records[-1], generation=4), engine.best, too_much)
        assert store.checkpoint() == engine.state()
        evolve(engine, objective, stop=lambda: engine.generation == 4)  # as if it had failed
        with pytest.raises(StoreError, match=r"expected generation 4 next, got 5; .* resume"):
            evolve(engine, objective, store)
    resume(grammar, tmp_path)
    with RunStore.open(tmp_path) as store:
        assert [record.generation for record in store.history()] == list(range(1, 9))


def test_a_run_that_was_killed_while_it_was_made_can_be_made_again(grammar, tmp_path):
    (tmp_path / "run.db.part").write_bytes(b"SQLite format 3\0 and nothing else")
    with pytest.raises(StoreError, match=r"found no run\.db"):
        RunStore.open(tmp_path)
    with RunStore.create(tmp_path, CONFIG) as store:
        evolve(Engine(grammar, SMALL, 3), objective, store)
    assert not list(tmp_path.glob("*.part"))


def test_a_finished_run_can_be_read_where_nothing_can_be_written(finished):
    before = {path.name: path.read_bytes() for path in finished.iterdir()}
    for path in (finished, *finished.parents):
        if not path.stat().st_mode & 0o005:  # others may look into it, and into nothing else
            path.chmod(0o755)
    child = os.fork()
    if child == 0:
        status = 1
        try:
            if os.geteuid() == 0:
                os.setuid(65534)
            with RunStore.open(finished, read_only=True) as store:
                status = int(len(store.history()) != 8 or store.best(3) is None)
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert {path.name: path.read_bytes() for path in finished.iterdir()} == before
