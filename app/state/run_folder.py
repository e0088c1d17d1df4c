"""The runs that are kept: what is in their directory, and how one is removed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

from geswarm.drafts import DRAFTS
from geswarm.evolution import RunConfig, RunConfigError
from geswarm.ge import RunStore, StoreError
from geswarm.ge.database import OWN_FILES, require_run
from geswarm.ge.locks import Claim, is_written

Stamp: TypeAlias = tuple[tuple[int, int], ...]
"""Time (ns) and size of the files that a run is written to."""

MOST_RUNS = 500
"""Shown at most, the newest."""

_OWN = ("best.yaml", "config.yaml", "history.csv", *OWN_FILES)
"""What a run consists of; `run.db` is removed last, so that a run removed in part is still one."""


class RunError(ValueError):
    """A run cannot be found, opened or deleted; says why."""


@dataclass(frozen=True)
class RunSummary:
    """A line of the list of runs.

    Attributes:
        name: Of its directory.
        stamp: When it was written.
        config: How it began; None if it cannot be read.
        best_so_far: Of every generation that is done.
        problem: Why it cannot be read, else empty.
        written_now: A process is at work on it, perhaps this one.
    """

    name: str
    stamp: Stamp
    config: RunConfig | None = None
    best_so_far: tuple[float, ...] = ()
    problem: str = ""
    written_now: bool = False

    @property
    def written(self) -> float:
        """When it was written last, in seconds of the clock (`time.time`)."""
        return max((time for time, _ in self.stamp), default=0) / 1e9

    @property
    def finished(self) -> bool:
        """All its generations are done."""
        config = self.config
        return config is not None and len(self.best_so_far) >= config.settings.generations


class RunFolder:
    """The run directories directly below a folder; files are read again only if they changed.

    Attributes:
        path: The folder; it need not exist.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known: dict[str, RunSummary] = {}

    def scan(self, unread: Path | None = None) -> tuple[RunSummary, ...]:
        """All runs, the one written last first.

        Args:
            unread: A run that is being written: what was known of it before will do.
        """
        found = []
        for directory in self._directories():
            stamp = stamp_of(directory)
            known = self._known.get(directory.name)
            if known is None or (known.stamp != stamp and directory != unread):
                known = read_summary(directory, stamp)
            if known.written_now != (now := is_written(directory)):
                known = replace(known, written_now=now)
            found.append(known)
        self._known = {summary.name: summary for summary in found}
        found.sort(key=lambda summary: (-summary.written, summary.name))
        return tuple(found[:MOST_RUNS])

    def directory(self, name: str) -> Path:
        """The directory of a run.

        Raises:
            RunError: There is no run of that name directly below the folder.
        """
        for directory in self._directories():
            if directory.name == name:
                return directory
        raise RunError(f"there is no run {name!r} in {self.path}")

    def delete(self, name: str) -> str:
        """Remove a run's own files, and its directory if nothing else is in it.

        Returns:
            What was left because it is no part of a run; usually empty.

        Raises:
            RunError: There is no run of that name, or it cannot be removed.
        """
        directory = self.directory(name)
        try:
            require_run(directory / "run.db")
            claim = Claim(directory)
            try:
                for own in (*directory.glob(DRAFTS), *(directory / name for name in _OWN)):
                    own.unlink(missing_ok=True)
            finally:
                claim.give_up()
            left = sorted(path.name for path in directory.iterdir())
            if not left:
                directory.rmdir()
        except OSError as error:
            raise RunError(f"{name} was not deleted: {error}") from error
        return ", ".join(left)

    def _directories(self) -> Iterator[Path]:
        try:
            entries = sorted(self.path.iterdir())
        except OSError:
            return
        for entry in entries:
            database = entry / "run.db"
            if not entry.is_symlink() and database.is_file() and not database.is_symlink():
                yield entry


def stamp_of(directory: Path) -> Stamp:
    """When the files of a run were written; differs after every generation."""
    stamp = []
    for name in ("run.db", "run.db-wal"):
        try:
            status = (directory / name).stat()
        except OSError:
            continue
        stamp.append((status.st_mtime_ns, status.st_size))
    return tuple(stamp)


def read_summary(directory: Path, stamp: Stamp) -> RunSummary:
    """Look into a run; what is wrong with it is part of the answer."""
    try:
        with RunStore.open(directory, read_only=True) as store:
            config = RunConfig.from_yaml(store.config)
            best_so_far = tuple(record.best_so_far for record in store.history())
    except Exception as error:  # damaged in whatever way: the others are listed all the same
        known = isinstance(error, StoreError | RunConfigError)
        return RunSummary(directory.name, stamp, problem=str(error) if known else repr(error))
    return RunSummary(directory.name, stamp, config, best_so_far)
