"""The SQLite file of a run: its schema, and how it is made, recognised and opened."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

SCHEMA_VERSION = 1
_APPLICATION_ID = 0x47455357  # "GESW" in the file's header says whose database it is
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
    best_generation INTEGER NOT NULL,
    best_key INTEGER NOT NULL
);
CREATE TABLE individual (           -- everyone bred, with the fitness of then
    generation INTEGER NOT NULL REFERENCES generation,
    key INTEGER NOT NULL,
    parents TEXT NOT NULL,          -- JSON: [[generation, key], ...]
    fitness REAL NOT NULL,
    codons INTEGER NOT NULL,        -- that the mapping read
    phenotype TEXT,                 -- NULL: invalid
    PRIMARY KEY (generation, key)
) WITHOUT ROWID;
CREATE TABLE steering (
    number INTEGER PRIMARY KEY,
    generation INTEGER NOT NULL,    -- the first one that it acts on
    what TEXT NOT NULL              -- JSON: {{"inject": sentence}} or {{"settings": {{...}}}}
);
CREATE TABLE checkpoint (
    generation INTEGER PRIMARY KEY REFERENCES generation,
    state TEXT NOT NULL             -- JSON; only the latest is kept
);
PRAGMA application_id = {_APPLICATION_ID};
PRAGMA user_version = {SCHEMA_VERSION};
"""
_HEADER = 100  # bytes; format of the file: sqlite.org/fileformat.html, section 1.3
_MAGIC = b"SQLite format 3\0"
_TOUCH = "SELECT 1 FROM run"
_BESIDE = ("-wal", "-shm", "-journal")  # SQLite's own files beside a database
OWN_FILES = tuple(f"run.db{suffix}" for suffix in (*_BESIDE, ""))
"""What a database consists of, itself last."""


_MISREAD = (ValueError, KeyError, TypeError, OverflowError, RecursionError)
"""What reading a value raises that is not what should be there."""


class StoreError(OSError):
    """A run directory cannot be used; says which, what was found and what to do."""


def create(path: Path, config: str) -> None:
    """Make the database of a run that has not begun; it is there as a whole or not at all."""
    partial = path.with_name(path.name + ".part")
    _remove(partial)
    try:
        try:
            _make(partial, config, "WAL")
        except sqlite3.OperationalError:  # this file system cannot share memory
            _remove(partial)
            _make(partial, config, "DELETE")
        if _is_unfinished(partial):
            raise StoreError(f"{path}: could not be written as a whole: is the disk full?")
        partial.rename(path)
    except BaseException:
        _remove(partial)
        raise


def _make(path: Path, config: str, journal: str) -> None:
    """Make a database with a write-ahead log (WAL), or with a rollback journal (DELETE)."""
    with closing(connect(path, "rwc")) as connection:
        connection.execute(f"PRAGMA journal_mode = {journal}")
        connection.executescript(_SCHEMA)
        connection.execute("INSERT INTO run VALUES (?)", (config,))
        connection.execute("COMMIT")
        # Closing does it too, but would not say that the disk is full.
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchall()


def _is_unfinished(path: Path) -> bool:
    """Something that belongs into a database is still beside it."""
    beside = (path.with_name(path.name + suffix) for suffix in ("-wal", "-journal"))
    return any(file.exists() and file.stat().st_size > 0 for file in beside)


def _remove(path: Path) -> None:
    for suffix in ("", *_BESIDE):
        path.with_name(path.name + suffix).unlink(missing_ok=True)


def connect(path: Path, mode: str) -> sqlite3.Connection:
    """Connect to a database: `ro`, `rw`, or `rwc` to make it."""
    uri = f"{path.absolute().as_uri()}?mode={mode}"
    connection = sqlite3.connect(
        uri, uri=True, timeout=10.0, isolation_level=None, check_same_thread=False
    )
    connection.execute("PRAGMA foreign_keys = ON")
    return connection


def connect_to_write(path: Path) -> sqlite3.Connection:
    """Connect to a database that is there.

    What a killed writer left is completed. A run that was begun with a write-ahead log, and was
    brought where that cannot be, goes on with a rollback journal.
    """
    try:
        return _after(connect(path, "rw"), _TOUCH)
    except sqlite3.OperationalError:
        return _after(
            connect(path, "rw"),
            "PRAGMA locking_mode = EXCLUSIVE",  # the log of a single process needs no shared memory
            "PRAGMA journal_mode = DELETE",
            "PRAGMA locking_mode = NORMAL",
            _TOUCH,  # gives the lock back
        )


def _after(connection: sqlite3.Connection, *statements: str) -> sqlite3.Connection:
    """The connection once these statements are carried out; closed if one of them cannot be."""
    try:
        for statement in statements:
            connection.execute(statement).fetchall()
    except BaseException:
        connection.close()
        raise
    return connection


def connect_to_read(path: Path) -> sqlite3.Connection:
    """Connect to a database that is only read, also where nothing can be written beside it.

    Raises:
        sqlite3.OperationalError: Only `connect_to_write` can make it whole: a writer was killed.
    """
    beside = [path.with_name(path.name + suffix) for suffix in ("-wal", "-shm")]
    made = [file for file in beside if not file.exists()]
    try:
        return _after(connect(path, "ro"), _TOUCH)
    except sqlite3.OperationalError as error:
        if _is_unfinished(path) or "locked" in str(error):
            raise  # the latest generations are in there
        for file in made:  # by trying, where memory cannot be shared
            with suppress(OSError):
                file.unlink()
        return connect(path, "ro&immutable=1")


def require_run(path: Path) -> None:
    """Check whose file this is by its header alone, so that no foreign file is touched.

    Raises:
        StoreError: It is not a run.
    """
    with path.open("rb") as file:
        header = file.read(_HEADER)
    if len(header) < _HEADER or not header.startswith(_MAGIC):
        raise StoreError(f"{path}: expected a GESwarm run, found a file that is no database")
    identity = int.from_bytes(header[68:72], "big")
    if identity != _APPLICATION_ID:
        raise StoreError(f"{path}: expected a GESwarm run, found another kind of database")


def read_config(path: Path, read_only: bool) -> str:
    """The config text of a run, after a look at the whole database.

    Args:
        path: Of the database.
        read_only: Complete nothing that a killed writer left.

    Raises:
        StoreError: It is damaged, or of a newer version.
    """
    try:
        connection = connect_to_read(path)
    except sqlite3.OperationalError as error:
        if read_only:
            raise StoreError(
                f"{path}: cannot be read now: {error}; if the process that wrote it was killed, "
                "resume the run, which completes it"
            ) from error
        connection = connect_to_write(path)
    with closing(connection):
        return _checked_config(connection, path)


def _checked_config(connection: sqlite3.Connection, path: Path) -> str:
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if version > SCHEMA_VERSION:
        raise StoreError(
            f"{path}: expected format {SCHEMA_VERSION} or older, found {version}; "
            "this run was made by a newer GESwarm"
        )
    foreign = "SELECT name FROM sqlite_master WHERE type NOT IN ('table', 'index')"
    for (name,) in connection.execute(foreign):
        raise StoreError(f"{path}: expected nothing but tables in it, found {name!r}")
    (finding,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    if finding != "ok":
        raise StoreError(f"{path}: the database is damaged: {finding}")
    row = connection.execute("SELECT config FROM run").fetchone()
    if row is None:
        raise StoreError(f"{path}: the database is damaged: it has no configuration")
    return str(row[0])


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    """All that is done in it is committed, or nothing."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield connection
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def kind_errors(directory: Path, problem: str) -> Iterator[None]:
    """Turn what the system says into a StoreError that names the directory."""
    try:
        yield
    except StoreError:
        raise
    except (sqlite3.Error, OSError, *_MISREAD) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise StoreError(f"{directory}: {problem}: {reason}") from error
