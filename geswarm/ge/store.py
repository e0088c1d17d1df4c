"""The directory of a run: everything needed to look at it and to continue it exactly.

`run.db` (SQLite, write-ahead log) is the truth: one transaction per generation writes its row and
the checkpoint, so a run that is killed at any moment continues from its last complete generation,
and others can read it while it is written. `config.yaml` and `history.csv` are copies for people
and are rebuilt from it.
"""

from __future__ import annotations

import json
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from types import TracebackType
from typing import Any

from geswarm.ge.engine import Individual, State
from geswarm.ge.record import GenerationRecord

SCHEMA_VERSION = 1
_APPLICATION_ID = 0x47455357  # "GESW" in the file's header says whose database it is
_COLUMNS = ", ".join(f'"{field.name}"' for field in fields(GenerationRecord))
_SCHEMA = f"""
BEGIN;
CREATE TABLE run (config TEXT NOT NULL);
CREATE TABLE generation (
    generation INTEGER PRIMARY KEY,
    best_so_far REAL NOT NULL,
    best REAL NOT NULL,
    mean REAL NOT NULL,
    invalid INTEGER NOT NULL,
    "distinct" INTEGER NOT NULL,
    seconds REAL NOT NULL,
    best_phenotype TEXT NOT NULL,   -- of the best individual so far
    best_generation INTEGER NOT NULL
);
CREATE TABLE checkpoint (
    generation INTEGER PRIMARY KEY REFERENCES generation,
    state TEXT NOT NULL             -- JSON; only the latest is kept
);
PRAGMA application_id = {_APPLICATION_ID};
PRAGMA user_version = {SCHEMA_VERSION};
"""


class StoreError(OSError):
    """A run directory cannot be used; says which, what was found and what to do."""


@dataclass(frozen=True)
class StoredBest:
    """The best individual of a run so far.

    Attributes:
        phenotype: The sentence.
        generation: Generation in which it was bred.
        fitness: Its fitness.
    """

    phenotype: str
    generation: int
    fitness: float


class RunStore:
    """A run directory; use `create` or `open`, and close it (or use it in a `with` statement).

    It may be used from several threads.

    Attributes:
        directory: The run directory.
        config: The text of `config.yaml`, as given when the run was created.
    """

    def __init__(self, directory: Path, connection: sqlite3.Connection, config: str) -> None:
        self.directory = directory
        self.config = config
        self._connection = connection
        self._lock = threading.Lock()

    @classmethod
    def create(cls, directory: str | Path, config: str) -> RunStore:
        """Begin a run in a new directory, or in one that holds no run.

        Args:
            directory: Made if it is not there.
            config: Text of `config.yaml`, everything resolved.

        Raises:
            StoreError: The directory holds a run already, or cannot be written.
        """
        directory = Path(directory)
        for name in ("run.db", "config.yaml", "history.csv"):
            if (directory / name).exists():
                raise StoreError(
                    f"{directory}: expected a directory without a run, found {name}; "
                    "choose another one, or resume this run"
                )
        with _kind_errors(directory, "cannot begin a run here"):
            directory.mkdir(parents=True, exist_ok=True)
            connection = _connect(directory / "run.db", "rwc")
            try:
                connection.execute("PRAGMA journal_mode = WAL")
                connection.executescript(_SCHEMA)
                connection.execute("INSERT INTO run VALUES (?)", (config,))
                connection.execute("COMMIT")
                store = cls(directory, connection, config)
                store._rebuild_copies()
            except BaseException:
                connection.close()
                raise
        return store

    @classmethod
    def open(cls, directory: str | Path, read_only: bool = False) -> RunStore:
        """Open a run to continue it, or only to read it, perhaps while another process writes it.

        Nothing is changed in a file that is not a run of this or an earlier version.

        Raises:
            StoreError: There is no run, or it is damaged, foreign, or of a newer version.
        """
        directory = Path(directory)
        path = directory / "run.db"
        if not path.is_file():
            raise StoreError(f"{directory}: expected a run directory, found no run.db in it")
        with _kind_errors(directory, "cannot open this run"):
            with closing(_connect(path, "ro")) as connection:
                config = _checked_config(connection, path)
            connection = _connect(path, "ro" if read_only else "rw")
            store = cls(directory, connection, config)
            if not read_only:
                try:
                    store._rebuild_copies()
                except BaseException:
                    connection.close()
                    raise
        return store

    def append(self, record: GenerationRecord, best: Individual, state: State) -> None:
        """Commit a generation: its row, the best individual so far and the checkpoint.

        Raises:
            StoreError: It cannot be written (disk full), or is not the next one (another process
                writes this run); all generations before it are safe.
        """
        row = (*astuple(record), best.phenotype, best.generation)
        checkpoint = json.dumps(state, separators=(",", ":"), allow_nan=False)
        number = record.generation
        with _kind_errors(self.directory, f"cannot write generation {number}"), self._lock:
            with _transaction(self._connection) as connection:
                self._require_next(number)
                marks = ", ".join("?" * len(row))
                connection.execute(f"INSERT INTO generation VALUES ({marks})", row)
                connection.execute("DELETE FROM checkpoint")
                connection.execute("INSERT INTO checkpoint VALUES (?, ?)", (number, checkpoint))
            with (self.directory / "history.csv").open("a", encoding="utf-8", newline="") as file:
                file.write(record.csv_row() + "\n")

    def history(self) -> list[GenerationRecord]:
        """All generations so far."""
        rows = self._query(f"SELECT {_COLUMNS} FROM generation ORDER BY generation")
        return [GenerationRecord(*row) for row in rows]

    def checkpoint(self) -> State | None:
        """The engine's state after the last generation; None before the first one.

        Raises:
            StoreError: The checkpoint is damaged.
        """
        rows = self._query("SELECT state FROM checkpoint ORDER BY generation DESC LIMIT 1")
        if not rows:
            return None
        with _kind_errors(self.directory, "the checkpoint is damaged"):
            state: State = json.loads(rows[0][0])
        return state

    def best(self) -> StoredBest | None:
        """The best individual so far; None before the first generation."""
        rows = self._query(
            "SELECT best_phenotype, best_generation, best_so_far FROM generation "
            "ORDER BY generation DESC LIMIT 1"
        )
        return StoredBest(*rows[0]) if rows else None

    def close(self) -> None:
        """Close the database; the store cannot be used any more."""
        with self._lock:
            self._connection.close()

    def __enter__(self) -> RunStore:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _query(self, sql: str) -> list[tuple[Any, ...]]:
        with _kind_errors(self.directory, "cannot read this run"), self._lock:
            return self._connection.execute(sql).fetchall()

    def _require_next(self, number: int) -> None:
        (last,) = self._connection.execute("SELECT max(generation) FROM generation").fetchone()
        expected = (last or 0) + 1
        if number != expected:
            raise StoreError(
                f"{self.directory}: expected generation {expected} next, got {number}; another "
                "process writes this run, or one generation could not be written: resume the run"
            )

    def _rebuild_copies(self) -> None:
        """Write config.yaml and history.csv anew from the database."""
        lines = [GenerationRecord.csv_header(), *(row.csv_row() for row in self.history())]
        _write_atomically(self.directory / "config.yaml", self.config)
        _write_atomically(self.directory / "history.csv", "".join(f"{row}\n" for row in lines))


def _connect(path: Path, mode: str) -> sqlite3.Connection:
    uri = f"{path.absolute().as_uri()}?mode={mode}"
    connection = sqlite3.connect(
        uri, uri=True, timeout=10.0, isolation_level=None, check_same_thread=False
    )
    connection.execute("PRAGMA foreign_keys = ON")
    return connection


def _checked_config(connection: sqlite3.Connection, path: Path) -> str:
    """The config text of a database that is a whole run of a version known here."""
    (identity,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if identity != _APPLICATION_ID:
        raise StoreError(f"{path}: expected a GESwarm run, found another kind of database")
    if version > SCHEMA_VERSION:
        raise StoreError(
            f"{path}: expected format {SCHEMA_VERSION} or older, found {version}; "
            "this run was made by a newer GESwarm"
        )
    (finding,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    if finding != "ok":
        raise StoreError(f"{path}: the database is damaged: {finding}")
    row = connection.execute("SELECT config FROM run").fetchone()
    if row is None:
        raise StoreError(f"{path}: the database is damaged: it has no configuration")
    return str(row[0])


@contextmanager
def _transaction(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield connection
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def _kind_errors(directory: Path, problem: str) -> Iterator[None]:
    """Turn what the system says into a StoreError that names the directory."""
    try:
        yield
    except StoreError:
        raise
    except (sqlite3.Error, OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise StoreError(f"{directory}: {problem}: {reason}") from error


def _write_atomically(path: Path, text: str) -> None:
    """Readers see the old file or the new one, never a part."""
    partial = path.with_name(path.name + ".part")
    partial.write_text(text, encoding="utf-8", newline="")
    partial.replace(path)
