"""The list of the runs that are kept, and deleting one of them."""

import shutil
import sqlite3

import pytest

from geswarm.app.state.run_folder import RunError, RunFolder
from geswarm.evolution import EvolutionRun, RunConfig
from geswarm.ge import Settings
from geswarm.sim import load_scenario

TINY = RunConfig(
    load_scenario("paper").with_changes(duration=20.0),
    Settings(population=4, generations=2, evaluations=1),
    seed=3,
)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    run = EvolutionRun.create(TINY, tmp_path_factory.mktemp("kept") / "run")
    run.run(workers=1)
    run.close()
    return run


@pytest.fixture
def folder(tmp_path, finished):
    """A folder with one run, and other things beside it."""
    path = tmp_path / "runs"
    shutil.copytree(finished.directory, path / "good")
    (path / "notes").mkdir()
    (path / "notes" / "config.yaml").write_text("mine: true\n")
    (path / "run.db").write_text("a file")
    return RunFolder(path)


def test_runs_are_read_once_and_again_when_they_change(folder, finished):
    (summary,) = folder.scan()
    assert (summary.name, summary.problem, summary.finished) == ("good", "", True)
    assert summary.config == TINY
    assert summary.best_so_far == tuple(record.best_so_far for record in finished.history)
    folder.scan()
    (again,) = folder.scan()
    assert again is folder.scan()[0]
    with sqlite3.connect(folder.path / "good" / "run.db") as connection:
        connection.execute("UPDATE generation SET best_so_far = 9 WHERE generation = 2")
    assert folder.scan(unread=folder.path / "good")[0] is again
    assert folder.scan()[0].best_so_far[-1] == 9


def test_there_need_not_be_a_folder(tmp_path):
    assert RunFolder(tmp_path / "none").scan() == ()


@pytest.mark.parametrize(
    ("damage", "problem"),
    [
        (lambda path: path.write_text("not a database" * 20), "no database"),
        (lambda path: path.write_bytes(b""), "no database"),
        (lambda path: path.write_bytes(path.read_bytes()[:5000]), "good"),
        (lambda path: other_database(path), "another kind of database"),
        (lambda path: execute(path, "UPDATE run SET config = 'seed: 1'"), "not the configuration"),
        (lambda path: execute(path, "DELETE FROM run"), "no configuration"),
        (lambda path: execute(path, "DROP TABLE generation"), "cannot read"),
    ],
)
def test_a_damaged_run_is_listed_with_its_reason(folder, damage, problem):
    directory = folder.path / "good"
    for suffix in ("-wal", "-shm"):
        (directory / f"run.db{suffix}").unlink(missing_ok=True)
    damage(directory / "run.db")
    (summary,) = folder.scan()
    assert problem in summary.problem
    assert (summary.config, summary.finished) == (None, False)


def execute(path, command):
    with sqlite3.connect(path) as connection:
        connection.execute(command)


def other_database(path):
    path.unlink()
    execute(path, "CREATE TABLE mine (x)")


def test_deleting_removes_the_run_and_nothing_else(folder):
    (folder.path / "good" / ".geswarm-0123abcd.part").write_text("of a process that was killed")
    assert folder.delete("good") == ""
    assert sorted(path.name for path in folder.path.iterdir()) == ["notes", "run.db"]
    assert (folder.path / "notes" / "config.yaml").exists()


def test_what_is_no_part_of_the_run_is_left(folder):
    (folder.path / "good" / "thoughts.txt").write_text("keep me")
    assert folder.delete("good") == "thoughts.txt"
    assert [path.name for path in (folder.path / "good").iterdir()] == ["thoughts.txt"]
    assert folder.scan() == ()


@pytest.mark.parametrize("name", ["notes", "", ".", "..", "run.db", "../runs/good", "good/", "x"])
def test_only_runs_directly_below_the_folder_are_deleted(folder, name):
    with pytest.raises(RunError, match="there is no run"):
        folder.delete(name)
    assert (folder.path / "good" / "run.db").exists()


def test_links_and_foreign_databases_are_left_alone(folder, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    shutil.copytree(folder.path / "good", elsewhere)
    (folder.path / "link").symlink_to(elsewhere, target_is_directory=True)
    (folder.path / "other").mkdir()
    execute(folder.path / "other" / "run.db", "CREATE TABLE mine (x)")
    with pytest.raises(RunError, match="there is no run 'link'"):
        folder.delete("link")
    with pytest.raises(RunError, match="another kind of database"):
        folder.delete("other")
    assert (elsewhere / "run.db").exists()
    assert (folder.path / "other" / "run.db").exists()
