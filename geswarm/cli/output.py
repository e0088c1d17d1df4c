"""Where the verbs put what they made, and how they show that they work."""

from __future__ import annotations

import errno
import os
import sys
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from geswarm.cli.arguments import UsageError

if TYPE_CHECKING:
    from rich.progress import ProgressColumn
    from rich.table import Column

_STANDARD_OUTPUT = ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")
"""Opened by name it would be cut to nothing where it is a file, and never closed."""

_NARROWEST_NAME = 10
_LONGEST_STEM = 100  # bytes; file systems take 143 to 255


def write_files(files: Mapping[str | None, str]) -> None:
    """Write each text to its file, as a whole, or to standard output, also by one of its names.

    Raises:
        UsageError: A file cannot be written.
        OutputError: Standard output cannot be.
    """
    from geswarm.rules.library import write_whole

    for path, text in files.items():
        if path is None or path in _STANDARD_OUTPUT:
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


def shortened(stem: str) -> str:
    """A name to which a file's name can add more: long ones become their beginning and a number."""
    name = os.fsencode(stem)
    if len(name) <= _LONGEST_STEM:
        return stem
    number = f"-{zlib.crc32(name):08x}"
    return name[: _LONGEST_STEM - len(number)].decode(errors="ignore") + number


def _cannot_be_written(path: str, error: Exception) -> UsageError:
    reason = getattr(error, "strerror", None) or str(error)
    return UsageError(f"{path}: cannot be written: {reason}")


def print_table(
    title: str, names: Sequence[str], figures: Sequence[str], rows: Sequence[Sequence[str]]
) -> None:
    """Print a table in which nothing is cut: long names are folded, figures are whole.

    Args:
        title: What it shows.
        names: Headings of the first columns.
        figures: Headings of the other columns.
        rows: A text for each column.
    """
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(
        title=Text(title), box=SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), pad_edge=False
    )
    headings = [*names, *figures]
    least = 2 * (len(headings) - 1)  # between the columns
    for at, (heading, *texts) in enumerate(zip(headings, *rows, strict=True)):
        whole = max(map(len, [*heading.split(), *texts]))
        if at < len(names):
            table.add_column(heading, overflow="fold")
            least += min(whole, _NARROWEST_NAME)
        else:
            table.add_column(heading.replace(" ", "\n"), justify="right", no_wrap=True)
            least += whole
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console()
    console.width = max(console.width, least)
    console.print(table)


def print_texts(title: str, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table of texts, which wrap where the terminal ends; lines of a text are kept.

    Args:
        title: What it shows.
        headings: Of the columns.
        rows: A text for each column.
    """
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(
        title=Text(title), box=SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), pad_edge=False
    )
    for heading in headings:
        table.add_column(heading, overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    Console().print(table)


def progress_columns(count: Callable[..., ProgressColumn], text: str) -> list[ProgressColumn]:
    """A count, a bar, a text and the time left, for an expanded `Progress`.

    In a narrow terminal the bar gives way, then the text is folded; no number is cut.

    Args:
        count: Kind of column.
        text: In rich's form, such as `{task.description}`.
    """
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.table import Column

    def whole() -> Column:
        return Column(no_wrap=True)

    return [
        count(table_column=whole()),
        BarColumn(bar_width=None, table_column=Column(ratio=1)),
        TextColumn(text, markup=False, table_column=Column(overflow="fold")),
        TimeRemainingColumn(compact=True, table_column=whole()),
        TextColumn("left", table_column=whole()),
    ]


@contextmanager
def progress_bar() -> Iterator[Callable[[int, int], None]]:
    """A progress bar on stderr that is gone when the work is done."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("simulating", total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
