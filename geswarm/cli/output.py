"""Where the verbs put what they made, and how they show that they work."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

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
            reason = getattr(error, "strerror", None) or str(error)
            raise UsageError(f"{path}: cannot be written: {reason}") from error


@contextmanager
def progress_bar() -> Iterator[Callable[[int, int], None]]:
    """A progress bar on stderr that is gone when the work is done."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("simulating", total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
