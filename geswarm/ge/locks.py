"""What a run needs of its file system: files that can be locked, and one writer at a time."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile

from geswarm.ge.database import StoreError

try:
    import fcntl
except ImportError:  # Windows, whose locks SQLite knows by itself
    fcntl = None  # type: ignore[assignment]

_LONGEST_PATH = 504  # bytes: SQLite takes 512, with "-journal" at the end
_PATIENCE = 0.5  # seconds: somebody may just be asking `is_written`


@contextmanager
def new_directory(directory: Path) -> Iterator[None]:
    """Make a directory unless it is there; if what follows fails, nothing of it is left."""
    missing = [path for path in (directory, *directory.parents) if not path.exists()]
    try:
        directory.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:
        for path in missing:
            with suppress(OSError):  # not there, or others have put something in
                path.rmdir()
        raise


def require_locks(directory: Path) -> None:
    """Check that files in a directory can be locked, without which SQLite cannot write there.

    Raises:
        StoreError: They cannot; says why and what to do.
        OSError: The directory cannot be written.
    """
    if fcntl is None:
        return
    with TemporaryFile(dir=directory) as file:
        try:
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise StoreError(
                f"{directory}: this file system cannot lock files ({error.strerror}); choose --out "
                "on a local disk (the dashboard keeps its runs where it is started, in runs/)"
            ) from error


def require_short_path(directory: Path) -> None:
    """Check that SQLite, which does not take every path, takes that of a run.

    Raises:
        StoreError: It is too long.
    """
    name = "/run.db.part"
    length, longest = len(os.fsencode(os.path.realpath(directory))), _LONGEST_PATH - len(name)
    if os.name == "posix" and length > longest:
        raise StoreError(
            f"{directory}: the path is too long ({length} bytes), SQLite takes {longest}; "
            "choose a shorter --out"
        )


class Claim:
    """The right to write a run, held until it is given up or the process ends, however it ends.

    Raises:
        StoreError: Somebody else has it.
    """

    def __init__(self, directory: Path) -> None:
        self._descriptor = _open(directory)
        deadline = time.monotonic() + _PATIENCE
        while not _lock(self._descriptor, shared=False):
            if time.monotonic() > deadline:
                self.give_up()
                raise StoreError(
                    f"{directory}: another process is at work on this run, a dashboard or a "
                    "headless evolution: stop it there first"
                )
            time.sleep(0.01)

    def give_up(self) -> None:
        """Let others write."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None


def is_written(directory: Path) -> bool:
    """Somebody has the right to write the run of a directory, this process included."""
    descriptor = _open(directory)
    try:
        return not _lock(descriptor, shared=True)
    finally:
        if descriptor is not None:
            os.close(descriptor)


def _open(directory: Path) -> int | None:
    """A descriptor that can be locked; None where directories cannot be."""
    if fcntl is None:
        return None
    with suppress(OSError):
        return os.open(directory, os.O_RDONLY)
    return None


def _lock(descriptor: int | None, shared: bool) -> bool:
    """Lock at once, unless somebody else has; where there are no such locks nobody has.

    There the database still takes each generation only once, see `RunStore.append`.
    """
    if descriptor is None:
        return True
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True
