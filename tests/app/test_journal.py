"""Rules that are not saved survive whatever ends the dashboard, and are offered again."""

import os
import sqlite3
import stat
import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.journal import Journal, journal_directory
from geswarm.app.state.session import Session
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.wire import typed
from tests.robustness.test_faults import fill, small_disk

EVO8, HAND_CODED = load_preset("evo8"), load_preset("hand-coded")
R1_OFF = {"do": "set_enabled", "rule": 0, "enabled": False}


def wait_until(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.01)


def written(directory):
    """The rules in all journals, in spite of their locks; None where nothing is unsaved."""
    rows = []
    for path in directory.glob("*.db"):
        try:
            with closing(sqlite3.connect(f"file:{path}?immutable=1", uri=True)) as connection:
                rows.append(connection.execute("SELECT rules FROM unsaved").fetchone())
        except sqlite3.Error:
            pass  # it is being written
    return [row and row[0] for row in rows]


def killed(journal):
    """What a kill does: its thread ends, the lock goes, the file stays."""
    journal._writer.close()
    journal._connection.close()


def left_by_a_killed_one(directory, rule_set):
    journal = Journal(directory)
    journal.keep(rule_set)
    wait_until(lambda: any(written(directory)))
    killed(journal)


def test_rules_of_a_killed_dashboard_are_offered_once(tmp_path):
    left_by_a_killed_one(tmp_path, HAND_CODED)
    (unsaved,) = Journal(tmp_path).left
    assert unsaved.rule_set == HAND_CODED
    assert abs(unsaved.edited - time.time()) < 3600
    journal = Journal(tmp_path)
    journal.settle(journal.left[0], HAND_CODED)
    assert journal.left == ()
    wait_until(lambda: not unsaved.path.exists())
    assert Journal(tmp_path).left == ()  # now it is this one's, and this one lives
    killed(journal)
    assert [left.rule_set for left in Journal(tmp_path).left] == [HAND_CODED]


def test_dashboards_side_by_side_leave_one_another_alone(tmp_path):
    one, two = Journal(tmp_path), Journal(tmp_path)
    one.keep(EVO8)
    two.keep(HAND_CODED)
    wait_until(lambda: len([text for text in written(tmp_path) if text]) == 2)
    assert Journal(tmp_path).left == ()
    one.close()
    assert len(written(tmp_path)) == 1
    killed(two)
    assert [left.rule_set for left in Journal(tmp_path).left] == [HAND_CODED]


def test_nothing_is_left_after_a_clean_end_or_when_all_is_saved(tmp_path):
    journal = Journal(tmp_path)
    journal.keep(None)
    journal.keep(EVO8)
    wait_until(lambda: any(written(tmp_path)))
    journal.keep(None)
    wait_until(lambda: written(tmp_path) == [None])
    killed(journal)
    assert Journal(tmp_path).left == ()
    assert list(tmp_path.iterdir()) == []
    journal = Journal(tmp_path)
    journal.keep(EVO8)
    wait_until(lambda: any(written(tmp_path)))
    journal.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="permissions as POSIX has them")
def test_only_the_owner_may_read_it(tmp_path):
    directory = tmp_path / "made" / "here"
    journal = Journal(directory)
    journal.keep(EVO8)
    wait_until(lambda: any(written(directory)))
    for file in (directory, *directory.iterdir()):
        assert stat.S_IMODE(file.stat().st_mode) & 0o077 == 0
    journal.close()


@pytest.mark.parametrize("content", [b"", b"no database", b"SQLite format 3\x00" + bytes(500)])
def test_what_is_no_journal_is_left_alone(tmp_path, content):
    (tmp_path / "1.db").write_bytes(content)
    (tmp_path / "2.db").mkdir()
    (tmp_path / "notes.txt").write_text("x")
    assert Journal(tmp_path).left == ()
    assert len(list(tmp_path.iterdir())) == 3


def test_rules_that_cannot_be_read_are_left_alone(tmp_path):
    left_by_a_killed_one(tmp_path, EVO8)
    (path,) = tmp_path.glob("*.db")
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE unsaved SET rules = 'rules: ['")
    assert Journal(tmp_path).left == ()
    assert path.exists()


def test_a_place_that_cannot_be_written_is_a_problem_and_no_failure(tmp_path):
    (tmp_path / "file").write_text("")
    journal = Journal(tmp_path / "file" / "journal")
    assert journal.left == ()
    journal.keep(EVO8)
    wait_until(lambda: journal.problem)
    assert "file/journal" in journal.problem
    assert "\n" not in journal.problem
    journal.close()


@pytest.mark.parametrize("earlier", [False, True])
def test_a_disk_that_was_full_is_written_again(tmp_path, earlier):
    with small_disk(tmp_path / "disk") as disk:
        journal = Journal(disk / "journal")
        if earlier:
            journal.keep(HAND_CODED)
            wait_until(lambda: any(written(disk / "journal")))
        fill(disk / "room")
        journal.keep(replace(EVO8, name="x" * 9000))
        wait_until(lambda: "full" in journal.problem)
        (disk / "room").unlink()
        journal.keep(EVO8)
        wait_until(lambda: any("EVO 8" in (text or "") for text in written(disk / "journal")))
        wait_until(lambda: not journal.problem)
        journal.close()
        assert not list((disk / "journal").iterdir())


def test_without_a_directory_nothing_is_kept():
    journal = Journal(None)
    journal.keep(EVO8)
    journal.close()
    assert (journal.left, journal.problem) == ((), "")


def test_where_journals_are(monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", "/state")
    assert journal_directory() == Path("/state/geswarm/journal")
    monkeypatch.delenv("XDG_STATE_HOME")
    assert journal_directory() == Path.home() / ".local/state/geswarm/journal"


@pytest.fixture
def session(tmp_path):
    left_by_a_killed_one(tmp_path, HAND_CODED)
    quick = load_scenario("paper").with_changes(duration=50.0)
    session = Session(quick, EVO8, EvolutionThread(workers=1), journal=Journal(tmp_path))
    yield session
    session.close()


def test_every_edit_is_kept_until_it_is_saved_or_taken_back(session, tmp_path):
    def kept():
        return {text for text in written(tmp_path) if text and "EVO 8" in text}

    session.edit(typed(R1_OFF))
    wait_until(lambda: any("enabled: false" in text for text in kept()))
    session.undo()
    wait_until(lambda: not kept())
    session.redo()
    wait_until(kept)
    session.saved()
    wait_until(lambda: not kept())
    session.edit(typed({"do": "remove_rule", "rule": 1}))
    wait_until(kept)
    session.load_preset("hand-coded")
    wait_until(lambda: not kept())


def test_rules_brought_back_can_be_taken_out_again(session):
    (unsaved,) = session.journal.left
    session.bring_back(unsaved)
    assert session.document.rule_set == session.world.rule_set == HAND_CODED
    assert session.document.loaded == EVO8
    assert session.journal.left == ()
    session.undo()
    assert session.document.rule_set == EVO8
