"""Drafts: files written beside the one whose place they take, so that nobody reads half of it.

A process that is killed leaves its draft; whoever next writes in that folder takes it away.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

DRAFTS = ".geswarm-*.part"
"""Pattern of their names, which are short, however long the file's is."""

_STALE_SECONDS = 24 * 3600.0  # by then its writer is gone: writing takes a second


@contextmanager
def draft_of(path: Path) -> Iterator[Path]:
    """The name of a new draft, which takes the place of the file at the end.

    If anything is raised in between, the draft goes and the file stays as it was.

    Raises:
        OSError: It cannot take the file's place.
    """
    _remove_stale(path.parent)
    draft = path.with_name(DRAFTS.replace("*", secrets.token_hex(4)))
    try:
        yield draft
        draft.replace(path)
    except BaseException:
        with suppress(OSError):
            draft.unlink(missing_ok=True)
        raise


def _remove_stale(folder: Path) -> None:
    """Take away what killed processes left; what cannot be is left."""
    newest = time.time() - _STALE_SECONDS
    with suppress(OSError):
        for draft in list(folder.glob(DRAFTS)):
            with suppress(OSError):  # another process was faster
                if draft.lstat().st_mtime < newest:
                    draft.unlink()
