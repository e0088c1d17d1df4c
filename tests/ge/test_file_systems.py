"""Runs where file systems lack what SQLite would like: shared memory, or locks."""

import errno
import json
import os
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from geswarm.analysis.reproduction import Campaign, CampaignError
from geswarm.ge.database import StoreError
from geswarm.ge.engine import Engine
from geswarm.ge.evolve import evolve
from geswarm.ge.store import RunStore

from .test_store import CONFIG, SMALL, objective, resume, rows

NO_SHARED_MEMORY = Path(__file__).parent / "no_shared_memory.c"


@pytest.fixture
def whole(grammar, tmp_path):
    with RunStore.create(tmp_path / "whole", CONFIG) as store:
        evolve(Engine(grammar, SMALL, 3), objective, store)
    return rows(tmp_path / "whole")


@pytest.fixture
def rollback_journal(monkeypatch):
    """SQLite as it is where there is no shared memory: a log cannot be, and nobody complains."""
    connect = sqlite3.connect
    monkeypatch.setattr(
        "geswarm.ge.database.sqlite3.connect",
        lambda file, **options: connect(f"{file}&vfs=unix-dotfile", **options),
    )


@pytest.mark.skipif(os.name != "posix", reason="needs a way of SQLite to lock that POSIX has")
def test_a_run_without_a_log_is_the_same(grammar, tmp_path, whole, rollback_journal):
    with RunStore.create(tmp_path / "run", CONFIG) as store:
        engine = Engine(grammar, SMALL, 3)
        evolve(engine, objective, store, stop=lambda: engine.generation == 3)
    resume(grammar, tmp_path / "run")
    assert rows(tmp_path / "run") == whole
    names = {path.name for path in (tmp_path / "run").iterdir()}
    assert names == {"run.db", "config.yaml", "history.csv"}


def test_what_a_killed_writer_left_in_a_journal_is_taken_back(grammar, tmp_path, whole):
    with RunStore.create(tmp_path / "run", CONFIG) as store:
        engine = Engine(grammar, SMALL, 3)
        evolve(engine, objective, store, stop=lambda: engine.generation == 3)
        store._connection.execute("PRAGMA journal_mode = DELETE")
        store._connection.execute("PRAGMA cache_size = 1")
        store._connection.execute("BEGIN IMMEDIATE")
        store._connection.execute("UPDATE checkpoint SET state = state || zeroblob(1000000)")
        shutil.copytree(tmp_path / "run", tmp_path / "killed")
    assert (tmp_path / "killed" / "run.db-journal").exists()
    with pytest.raises(StoreError, match="resume the run, which completes it"):
        RunStore.open(tmp_path / "killed", read_only=True)
    resume(grammar, tmp_path / "killed")
    assert rows(tmp_path / "killed") == whole


@pytest.mark.skipif(sys.platform == "win32", reason="SQLite has its own locks there")
@pytest.mark.parametrize("reason", [errno.ENOLCK, errno.ENOSYS])
def test_without_locks_the_reason_is_told_and_nothing_is_left(tmp_path, monkeypatch, reason):
    def refuse(file, command):
        raise OSError(reason, os.strerror(reason))

    monkeypatch.setattr("fcntl.lockf", refuse)
    words = "this file system cannot lock files .*; choose --out on a local disk"
    with pytest.raises(StoreError, match=words):
        RunStore.create(tmp_path / "new" / "run", CONFIG)
    with pytest.raises(CampaignError, match=words):
        Campaign.at(tmp_path / "campaign")
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_left_of_a_run_that_could_not_be_made(tmp_path, monkeypatch):
    monkeypatch.setattr("geswarm.ge.database._SCHEMA", "CREATE TABLE run (config); nonsense;")
    with pytest.raises(StoreError, match="cannot begin a run here"):
        RunStore.create(tmp_path / "run", CONFIG)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="SQLite has other limits there")
def test_a_path_that_is_too_long_for_sqlite(tmp_path):
    def directory(length):
        parent = tmp_path / ("x" * 200) / ("y" * 100)
        return parent / ("z" * (length - len(os.fsencode(parent)) - 1))

    RunStore.create(directory(492), CONFIG).close()
    words = r"the path is too long \(493 bytes\), SQLite takes 492; choose a shorter --out"
    with pytest.raises(StoreError, match=words):
        RunStore.create(directory(493), CONFIG)
    directory(492).rename(directory(493))
    with pytest.raises(StoreError, match=words):
        RunStore.open(directory(493))
    with pytest.raises(CampaignError, match="the path is too long"):
        Campaign.at(directory(480))
    assert not directory(480).exists()


ON_FULL_DISKS = """
import subprocess, sys
from pathlib import Path
from geswarm.ge import RunStore, StoreError
from tests.ge.test_store import CONFIG
begun = []
for free in range(4, 164, 4):
    disk = Path(sys.argv[1], str(free))
    disk.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={free}k", "none", disk], check=True)
    try:
        RunStore.create(disk / "run", CONFIG).close()
    except StoreError:
        assert list(disk.iterdir()) == [], (free, list((disk / "run").iterdir()))
    else:
        begun.append(free)
        assert len(list((disk / "run").iterdir())) == 3, (free, list((disk / "run").iterdir()))
        with RunStore.open(disk / "run", read_only=True) as store:
            assert store.config == CONFIG
print(4 not in begun and 160 in begun)
"""


def can_mount():
    try:
        command = ["unshare", "-rm", "mount", "-t", "tmpfs", "none", "/mnt"]
        return subprocess.run(command, capture_output=True).returncode == 0
    except OSError:
        return False


@pytest.mark.skipif(not can_mount(), reason="needs to mount small disks, as on Linux")
def test_a_run_begins_on_a_nearly_full_disk_or_leaves_nothing(tmp_path):
    command = ["unshare", "-rm", sys.executable, "-c", ON_FULL_DISKS, str(tmp_path)]
    said = subprocess.run(command, capture_output=True, text=True)
    assert (said.stdout, said.stderr) == ("True\n", "")


IN_A_SHARE = """
import json, sys
from pathlib import Path
from geswarm.evolution import rule_grammar
from geswarm.ge import Engine, RunStore, evolve
from tests.ge.test_store import CONFIG, SMALL, objective, resume
grammar = rule_grammar()
here = Path(sys.argv[1])
with RunStore.create(here / "begun", CONFIG) as store:
    evolve(Engine(grammar, SMALL, 3), objective, store)
    mode = store._connection.execute("PRAGMA journal_mode").fetchone()
resume(grammar, here / "brought")
RunStore.open(here / "finished", read_only=True).close()
print(json.dumps([mode, sorted(path.name for path in (here / "begun").iterdir())]))
"""


@pytest.mark.skipif(
    sys.platform != "linux" or shutil.which("gcc") is None, reason="needs Linux and gcc"
)
def test_a_run_begins_and_goes_on_where_memory_cannot_be_shared(grammar, tmp_path, whole):
    """Also one that was killed and whose log was brought along."""
    share = tmp_path / "share"
    shutil.copytree(tmp_path / "whole", share / "finished")
    with RunStore.create(tmp_path / "local", CONFIG) as store:
        engine = Engine(grammar, SMALL, 3)
        evolve(engine, objective, store, stop=lambda: engine.generation == 3)
        shutil.copytree(tmp_path / "local", share / "brought")
    assert (share / "brought" / "run.db-wal").exists()
    library = tmp_path / "no_shared_memory.so"
    build = ["gcc", "-shared", "-fPIC", "-o", str(library), str(NO_SHARED_MEMORY), "-ldl"]
    subprocess.run(build, check=True)
    environment = {**os.environ, "LD_PRELOAD": str(library), "NO_SHARED_MEMORY": str(share)}
    said = subprocess.run(
        [sys.executable, "-c", IN_A_SHARE, str(share)],
        env=environment,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    assert json.loads(said) == [["delete"], ["config.yaml", "history.csv", "run.db"]]
    assert len(list((share / "finished").iterdir())) == 3  # reading left nothing
    assert rows(share / "begun") == rows(share / "brought") == whole
