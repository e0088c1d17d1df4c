"""Where the verbs put what they made, and how they show that they work."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from geswarm.cli.arguments import UsageError


def write_files(files: Mapping[str | None, str]) -> None:
    """Write each text to its file, as a whole, or to standard output.

    Raises:
        UsageError: A file cannot be written.
    """
    from geswarm.rules.library import write_whole

    for path, text in files.items():
        if path is None:
            sys.stdout.write(text)
            continue
        try:
            write_whole(text, path)
        except (OSError, ValueError) as error:
            raise _cannot_be_written(path, error) from error


def require_writable(path: str) -> None:
    """Refuse a file that could not be written after the work before it.

    Raises:
        UsageError: It is a directory, or nothing can be written where it lies.
    """
    from tempfile import TemporaryFile

    place = Path(path)
    try:
        if place.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if place.is_file() or not place.exists():
            with TemporaryFile(dir=place.parent):
                pass
    except (OSError, ValueError) as error:
        raise _cannot_be_written(path, error) from error


def _cannot_be_written(path: str, error: Exception) -> UsageError:
    reason = getattr(error, "strerror", None) or str(error)
    return UsageError(f"{path}: cannot be written: {reason}")


@contextmanager
def progress_bar() -> Iterator[Callable[[int, int], None]]:
    """A progress bar on stderr that is gone when the work is done."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("simulating", total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
