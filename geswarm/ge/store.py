"""The directory of a run: everything needed to look at it and to continue it exactly.

`run.db` (SQLite; a write-ahead log where the file system can share memory) is the truth: one
transaction per generation writes its row and the checkpoint, so a run that is killed at any moment
continues from its last complete generation, and others can read it while one process writes it.
`config.yaml` and `history.csv` are copies for people and are rebuilt from it.
"""

from __future__ import annotations

import json
import sqlite3
import threading
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import astuple, dataclass
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Any

from geswarm.drafts import draft_of
from geswarm.ge import database, locks, steering
from geswarm.ge.database import OWN_FILES, StoreError, kind_errors
from geswarm.ge.engine import State
from geswarm.ge.individual import Birth, Individual
from geswarm.ge.record import GenerationRecord
from geswarm.ge.steering import Steering, StoredSteering

_HISTORY = """
SELECT generation, best_so_far, best, mean, invalid, "distinct", seconds
FROM generation ORDER BY generation
"""
_FILES = (*OWN_FILES, "config.yaml", "history.csv")
_ADD_GENERATION = "INSERT INTO generation VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
_ANCESTORS = """
WITH RECURSIVE line (generation, key) AS (
    VALUES (?, ?)
    UNION
    SELECT json_extract(parent.value, '$[0]'), json_extract(parent.value, '$[1]')
    FROM line JOIN individual USING (generation, key), json_each(individual.parents) AS parent
)
SELECT individual.* FROM individual JOIN line USING (generation, key) ORDER BY generation, key
"""


@dataclass(frozen=True)
class StoredBest:
    """The best individual of a run so far.

    Attributes:
        phenotype: The sentence.
        generation: Generation in which it was bred.
        key: Its number among those bred then.
        fitness: Its fitness.
    """

    phenotype: str
    generation: int
    key: int
    fitness: float


@dataclass(frozen=True)
class StoredIndividual:
    """Somebody who was bred; see `Individual`.

    Attributes:
        generation: Generation for which it was bred.
        key: Its number among those.
        parents: Births of its parents, none, one or two.
        fitness: As it was told in its own generation.
        codons: Codons that the mapping read.
        phenotype: The sentence; None if it was invalid.
    """

    generation: int
    key: int
    parents: tuple[Birth, ...]
    fitness: float
    codons: int
    phenotype: str | None


class RunStore:
    """A run directory; use `create` or `open`, and close it (or use it in a `with` statement).

    It may be used from several threads.

    Attributes:
        directory: The run directory.
        config: The text of `config.yaml`, as given when the run was created or changed since.
        config_differed: The file `config.yaml` said something else when the run was opened.
    """

    def __init__(
        self, directory: Path, connection: sqlite3.Connection, config: str, resources: ExitStack
    ) -> None:
        self.directory = directory
        self.config = config
        self.config_differed = False
        self._connection = connection
        self._resources = resources  # closed with the store: its connection and its claim
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
        with (
            kind_errors(directory, "cannot begin a run here"),
            locks.new_directory(directory),
            ExitStack() as resources,
        ):
            claim = locks.Claim(directory)
            resources.callback(claim.give_up)
            for name in _FILES:
                if (directory / name).exists():
                    raise StoreError(
                        f"{directory}: expected a directory without a run, found {name}; "
                        "choose another one, or resume this run"
                    )
            locks.require_locks(directory)
            locks.require_short_path(directory)
            try:
                database.create(directory / "run.db", config)
                return cls._open(directory, False, resources)
            except BaseException:
                for name in _FILES:
                    (directory / name).unlink(missing_ok=True)
                raise

    @classmethod
    def open(cls, directory: str | Path, read_only: bool = False) -> RunStore:
        """Open a run to continue it, or only to read it, perhaps while another process writes it.

        Nothing is changed in a file that is not a run of this or an earlier version.

        Raises:
            StoreError: There is no run, or it is damaged, foreign, or of a newer version; or it is
                to be continued and another process is at work on it.
        """
        directory = Path(directory)
        with kind_errors(directory, "cannot open this run"), ExitStack() as resources:
            if not (directory / "run.db").is_file():
                raise StoreError(f"{directory}: expected a run directory, found no run.db in it")
            locks.require_short_path(directory)
            database.require_run(directory / "run.db")
            if not read_only:
                claim = locks.Claim(directory)
                resources.callback(claim.give_up)
                locks.require_locks(directory)
            return cls._open(directory, read_only, resources)

    @classmethod
    def _open(cls, directory: Path, read_only: bool, resources: ExitStack) -> RunStore:
        """Open it once nothing stands in the way; the store takes the resources over."""
        path = directory / "run.db"
        config = database.read_config(path, read_only)
        connect = database.connect_to_read if read_only else database.connect_to_write
        connection = resources.enter_context(closing(connect(path)))
        store = cls(directory, connection, config, resources.pop_all())
        if not read_only:
            try:
                store._rebuild_copies()
            except BaseException:
                store.close()
                raise
        return store

    def change_config(self, config: str) -> None:
        """Commit another text of `config.yaml`.

        Raises:
            StoreError: It cannot be written.
        """
        with kind_errors(self.directory, "cannot change its configuration"), self._lock:
            with database.transaction(self._connection) as connection:
                connection.execute("UPDATE run SET config = ?", (config,))
            self.config = config
            _write_atomically(self.directory / "config.yaml", config)

    def append(
        self,
        record: GenerationRecord,
        best: Individual,
        state: State,
        offspring: Sequence[Individual] = (),
    ) -> None:
        """Commit a generation: its row, the best so far, who was bred, and the checkpoint.

        Raises:
            StoreError: It cannot be written (disk full), or is not the next one (another process
                writes this run); all generations before it are safe.
        """
        number = record.generation
        row = (*astuple(record), best.phenotype, *best.birth)
        bred = [
            (*one.birth, json.dumps(one.parents), one.value, one.used, one.phenotype)
            for one in offspring
        ]
        checkpoint = json.dumps(state, separators=(",", ":"), allow_nan=False)
        with kind_errors(self.directory, f"cannot write generation {number}"), self._lock:
            with database.transaction(self._connection) as connection:
                self._require_next(number)
                connection.execute(_ADD_GENERATION, row)
                connection.executemany("INSERT INTO individual VALUES (?, ?, ?, ?, ?, ?)", bred)
                connection.execute("DELETE FROM checkpoint")
                connection.execute("INSERT INTO checkpoint VALUES (?, ?)", (number, checkpoint))
            with (self.directory / "history.csv").open("a", encoding="utf-8", newline="") as file:
                file.write(record.csv_row() + "\n")

    def record_steering(self, generation: int, what: Steering) -> None:
        """Commit what a person changed before a generation was bred.

        Raises:
            StoreError: It cannot be written, or another process writes this run.
        """
        row = (generation, json.dumps(steering.to_json(what)))
        with (
            kind_errors(self.directory, "cannot write the change"),
            self._lock,
            database.transaction(self._connection) as connection,
        ):
            self._require_next(generation)
            connection.execute("INSERT INTO steering (generation, what) VALUES (?, ?)", row)

    def steering(self) -> list[StoredSteering]:
        """All that was changed, in order."""
        rows = self._query("SELECT generation, what FROM steering ORDER BY number")
        with kind_errors(self.directory, "the record of changes is damaged"):
            return [
                StoredSteering(int(at), steering.from_json(json.loads(what))) for at, what in rows
            ]

    def individuals(self, generation: int) -> list[StoredIndividual]:
        """Who was bred for a generation."""
        return self._individuals(
            "SELECT * FROM individual WHERE generation = ? ORDER BY key", (generation,)
        )

    def ancestors(self, birth: Birth) -> list[StoredIndividual]:
        """An individual and everyone it descends from, oldest first."""
        return self._individuals(_ANCESTORS, birth)

    def history(self) -> list[GenerationRecord]:
        """All generations so far.

        Raises:
            StoreError: The record is damaged.
        """
        rows = self._query(_HISTORY)
        for row in rows:
            if not all(isinstance(value, int | float) and isfinite(value) for value in row):
                raise StoreError(f"{self.directory}: expected finite numbers of generations")
        return [GenerationRecord(*row) for row in rows]

    def checkpoint(self) -> State | None:
        """The engine's state after the last generation; None before the first one.

        Raises:
            StoreError: The checkpoint is damaged.
        """
        rows = self._query("SELECT state FROM checkpoint ORDER BY generation DESC LIMIT 1")
        if not rows:
            return None
        with kind_errors(self.directory, "the checkpoint is damaged"):
            state: State = json.loads(rows[0][0])
        return state

    def best(self, generation: int | None = None) -> StoredBest | None:
        """The best individual after a generation, by default the last; None if it is not done."""
        rows = self._query(
            "SELECT best_phenotype, best_generation, best_key, best_so_far FROM generation "
            "WHERE ?1 IS NULL OR generation = ?1 ORDER BY generation DESC LIMIT 1",
            (generation,),
        )
        return StoredBest(*rows[0]) if rows else None

    def close(self) -> None:
        """Close the database; the store cannot be used any more."""
        with self._lock:
            self._resources.close()

    def __enter__(self) -> RunStore:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _individuals(self, sql: str, values: Sequence[int]) -> list[StoredIndividual]:
        rows = self._query(sql, values)
        with kind_errors(self.directory, "the record of individuals is damaged"):
            return [
                StoredIndividual(at, key, tuple((g, k) for g, k in json.loads(parents)), *rest)
                for at, key, parents, *rest in rows
            ]

    def _query(self, sql: str, values: Sequence[int | None] = ()) -> list[tuple[Any, ...]]:
        with kind_errors(self.directory, "cannot read this run"), self._lock:
            return self._connection.execute(sql, values).fetchall()

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
        path = self.directory / "config.yaml"
        self.config_differed = _says_something_else(path, self.config)
        lines = [GenerationRecord.csv_header(), *(row.csv_row() for row in self.history())]
        _write_atomically(path, self.config)
        _write_atomically(self.directory / "history.csv", "".join(f"{row}\n" for row in lines))


def _says_something_else(path: Path, text: str) -> bool:
    """A file is there and holds another text, whatever its ends of lines."""
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        found = file.read(2 * len(text.encode()) + 1)
    return found.replace(b"\r\n", b"\n") != text.encode()


def _write_atomically(path: Path, text: str) -> None:
    """Readers see the old file or the new one, never a part."""
    with draft_of(path) as draft, draft.open("x", encoding="utf-8", newline="") as file:
        file.write(text)
