"""Rules that are not saved, kept on disk: after a crash they can be brought back."""

from __future__ import annotations

import contextlib
import os
import secrets
import sqlite3
import time
from dataclasses import dataclass
from pathlib import Path

from geswarm.rules import RuleSet, RuleSetError, format_yaml, parse_yaml
from geswarm.rules.anything import ANYTHING

from .background import Newest, Stop

_TABLE = "CREATE TABLE IF NOT EXISTS unsaved (edited REAL, rules TEXT)"


@dataclass(frozen=True)
class Unsaved:
    """Rules as they stood when a dashboard was killed.

    Attributes:
        path: Its journal.
        edited: When they were last changed, seconds since 1970.
        rule_set: The rules.
    """

    path: Path
    edited: float
    rule_set: RuleSet


@dataclass(frozen=True)
class _Entry:
    rule_set: RuleSet | None  # None: nothing is unsaved
    settled: tuple[Path, ...]  # journals of others that are not needed once this one is written


class Journal:
    """The unsaved rules of one dashboard, in a file of its own, written off the loop.

    The file is a SQLite database that stays locked as long as its dashboard lives: those that are
    not locked were left by dashboards that were killed.

    Args:
        directory: Where the journals of this user's dashboards are; None keeps nothing.

    Attributes:
        left: What killed dashboards left, newest first.
        problem: Why nothing can be kept, else empty; replaced by the journal's thread.
    """

    def __init__(self, directory: Path | None) -> None:
        self.left = () if directory is None else _left_in(directory)
        self.problem = ""
        name = f"{os.getpid()}-{secrets.token_hex(4)}.db"
        self._path = None if directory is None else directory / name
        self._entry = _Entry(None, ())
        self._connection: sqlite3.Connection | None = None
        self._writer: Newest[_Entry] = Newest("journal", self._write)

    def keep(self, rule_set: RuleSet | None) -> None:
        """From now on these rules are unsaved; None if nothing is."""
        self._put(_Entry(rule_set, self._entry.settled))

    def find(self, name: str) -> Unsaved:
        """What was left in the file of that name.

        Raises:
            KeyError: Nothing, or it has been settled.
        """
        return {unsaved.path.name: unsaved for unsaved in self.left}[name]

    def settle(self, unsaved: Unsaved, rule_set: RuleSet | None) -> None:
        """Forget what was left, and keep these rules (see `keep`) from now on."""
        self.left = tuple(one for one in self.left if one is not unsaved)
        self._put(_Entry(rule_set, (*self._entry.settled, unsaved.path)))

    def close(self) -> None:
        """A clean end: nothing of this dashboard is left."""
        self._writer.close()
        if self._connection is not None and self._path is not None:
            self._connection.close()
            with contextlib.suppress(OSError):
                _remove(self._path)

    def _put(self, entry: _Entry) -> None:
        if entry != self._entry and self._path is not None:
            self._writer.ask(entry)
        self._entry = entry

    def _write(self, entry: _Entry, _stop: Stop) -> None:
        assert self._path is not None
        try:
            if self._connection is None:
                self._connection = _open_own(self._path)
            with self._connection:
                self._connection.execute("DELETE FROM unsaved")
                if entry.rule_set is not None:
                    row = (time.time(), format_yaml(entry.rule_set))
                    self._connection.execute("INSERT INTO unsaved VALUES (?, ?)", row)
            for path in entry.settled:
                _remove(path)
            self.problem = ""
        except (OSError, sqlite3.Error) as error:
            self.problem = f"{self._path}: {error}"


def journal_directory() -> Path | None:
    """$XDG_STATE_HOME/geswarm/journal, by default in ~/.local/state; None without a home."""
    try:
        home = Path.home() / ".local" / "state"
    except RuntimeError:
        return None
    return Path(os.environ.get("XDG_STATE_HOME") or home) / "geswarm" / "journal"


def _open_own(path: Path) -> sqlite3.Connection:
    """A new journal that only its owner may read, locked until it is closed."""
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    path.touch(mode=0o600)
    connection = sqlite3.connect(path, check_same_thread=False)
    try:
        connection.execute("PRAGMA locking_mode = EXCLUSIVE")
        connection.execute(_TABLE)
    except sqlite3.Error:  # the disk is full: it is tried again with the next change
        connection.close()
        _remove(path)
        raise
    return connection


def _left_in(directory: Path) -> tuple[Unsaved, ...]:
    try:
        found = [_read(path) for path in directory.glob("*.db")]
    except OSError:
        return ()
    left = [unsaved for unsaved in found if unsaved is not None]
    return tuple(sorted(left, key=lambda unsaved: unsaved.edited, reverse=True))


def _read(path: Path) -> Unsaved | None:
    """What a journal holds; None if its dashboard lives, or if there is nothing in it."""
    try:
        with contextlib.closing(sqlite3.connect(path, timeout=0.0)) as connection:
            row = connection.execute("SELECT edited, rules FROM unsaved").fetchone()
        if row is None:
            _remove(path)
            return None
        return Unsaved(path, float(row[0]), parse_yaml(row[1], vocabulary=ANYTHING))
    except (OSError, sqlite3.Error, RuleSetError, TypeError, ValueError):
        return None


def _remove(path: Path) -> None:
    for file in (path, path.with_name(f"{path.name}-journal")):  # the second is SQLite's
        file.unlink(missing_ok=True)
