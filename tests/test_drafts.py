import os
import signal
import subprocess
import sys
import time

import pytest

from geswarm.drafts import DRAFTS, draft_of

DAY = 24 * 3600.0


def left(folder):
    return list(folder.glob(DRAFTS))


def write(path, fails=False):
    with draft_of(path) as draft:
        assert not draft.exists()
        draft.write_text("new")
        if fails:
            raise ZeroDivisionError


def test_a_draft_takes_the_place_of_the_file(tmp_path):
    path = tmp_path / ("x" * 200)
    path.write_text("old")
    write(path)
    assert path.read_text() == "new"
    assert left(tmp_path) == []


def test_a_failure_leaves_the_file_as_it_was(tmp_path):
    path = tmp_path / "rules.yaml"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError):
        write(path, fails=True)
    assert path.read_text() == "old"
    assert left(tmp_path) == []
    with pytest.raises(OSError, match="no folder"):
        write(tmp_path / "no folder" / "rules.yaml")


@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
def test_what_a_killed_process_left_goes_with_the_next_file_once_it_is_old(tmp_path):
    program = """
import os, pathlib, signal, sys
from geswarm.drafts import draft_of
with draft_of(pathlib.Path(sys.argv[1])) as draft:
    draft.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""
    path = tmp_path / "rules.yaml"
    process = subprocess.run([sys.executable, "-c", program, path])
    assert process.returncode == -signal.SIGKILL
    (draft,) = left(tmp_path)
    write(path)
    assert left(tmp_path) == [draft]  # somebody may be writing it
    old = time.time() - 1.1 * DAY
    os.utime(draft, (old, old))
    others = [tmp_path / name for name in (".deadbeef.part", "geswarm-deadbeef.part", "mine.part")]
    for other in others:
        other.write_text("of somebody else")
        os.utime(other, (old, old))
    write(path)
    assert left(tmp_path) == []
    assert all(other.exists() for other in others)


def test_what_cannot_be_taken_away_does_no_harm(tmp_path):
    folder = tmp_path / DRAFTS.replace("*", "deadbeef")
    folder.mkdir()
    os.utime(folder, (0, 0))
    write(tmp_path / "rules.yaml")
    assert left(tmp_path) == [folder]
