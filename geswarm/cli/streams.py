"""Standard input, output and error: in UTF-8 for other programs, and what happens if they fail.

What is written to standard output is what was asked for: if it gets lost, that is an error. What
is written to standard error is about the work, which goes on without.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import TextIO

_ESCAPE = "backslashreplace"  # rather \u2190 than an error where there is no ←


class OutputError(Exception):
    """Standard output cannot be written; says why. No OSError: argparse would pass over it."""


class _Output(TextIOWrapper):
    """Standard output, whose errors say whose they are."""

    def write(self, text: str) -> int:
        with _named():
            return super().write(text)

    def flush(self) -> None:
        with _named():
            super().flush()


class _Remarks(TextIOWrapper):
    """Standard error, whose own errors have nowhere to go."""

    def write(self, text: str) -> int:
        with suppress(OSError):
            super().write(text)
        return len(text)

    def flush(self) -> None:
        with suppress(OSError):
            super().flush()


@contextmanager
def _named() -> Iterator[None]:
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        reason = "it is closed" if error.errno == errno.EBADF else error.strerror
        raise OutputError(f"standard output cannot be written: {reason}") from error


def prepare_streams() -> None:
    """Make the standard streams fit for every command.

    Those that are closed are replaced, or the next file that is opened would be taken for them.
    """
    if sys.stdin is None:
        os.open(os.devnull, os.O_RDONLY)
    sys.stdout = _prepared(sys.stdout, sys.__stdout__, os.O_RDONLY, _Output)
    sys.stderr = _prepared(sys.stderr, sys.__stderr__, os.O_WRONLY, _Remarks)


def _prepared(
    stream: TextIO | None, original: TextIO | None, flags: int, kind: type[TextIOWrapper]
) -> TextIO:
    """A stream for the same file, if it is Python's own, in UTF-8 unless it is a terminal.

    One that is closed goes nowhere, opened with `flags`: if only to read, writing is an error.
    """
    if stream is None:
        return kind(os.fdopen(os.open(os.devnull, flags), "wb"), "utf-8", _ESCAPE)
    if not isinstance(stream, TextIOWrapper):
        return stream
    encoding = stream.encoding if stream.isatty() else "utf-8"
    if stream is not original:
        stream.reconfigure(encoding=encoding, errors=_ESCAPE)
        return stream
    return kind(
        stream.buffer,
        encoding,
        _ESCAPE,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )


def abandon_output() -> None:
    """Have what is still to be written go nowhere, or Python would try it once more at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
