"""Whatever comes in, it is taken or refused in one clear way, soon, and without a trace."""

import os
import random
import signal
import time
from contextlib import contextmanager

import pytest
from hypothesis import HealthCheck, given, seed, settings

from tests.robustness import commands, doors, more_pages, pages, runs

SMALL = 60
LARGE = int(os.environ.get("GESWARM_FUZZ_INPUTS", "6000"))
SEED = int(os.environ.get("GESWARM_FUZZ_SEED", "0"))
PATIENCE = 120  # s for one input: only what hangs takes so long
KINDS = (doors, runs, commands, pages, more_pages)
DOORS = {door.name: door for kind in KINDS for door in kind.doors()}


@contextmanager
def watched(what):
    """What takes too long fails."""

    def give_up(*_):
        pytest.fail(f"took more than {PATIENCE} s: {what!r:.500}")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def attempt(door, given_, name):
    """True if the door took the input, False if it refused it as it should."""
    with watched(given_):
        try:
            door.call(given_)
        except door.allowed as error:
            assert str(error).strip(), f"{name}: no reason for {given_!r:.500}"
            return False
        except Exception as error:
            raise AssertionError(f"{name}: {error!r:.300} for {given_!r:.1000}") from error
    return True


def fuzz(door, inputs):
    """Inputs made from nothing and from examples; each can be made again from its name."""
    taken, began = 0, time.perf_counter()
    for number in range(inputs):
        name = f"{door.name}, seed {SEED}, input {number}"
        taken += attempt(door, door.raw(random.Random(name)), name)
    shaped = max(inputs // 10, 20)

    @seed(SEED)
    @settings(max_examples=shaped, database=None, suppress_health_check=list(HealthCheck))
    @given(door.structured)
    def of_about_the_right_shape(value):
        attempt(door, value, f"{door.name}, shaped")

    of_about_the_right_shape()
    seconds = time.perf_counter() - began
    print(f"{door.name}: {inputs} + {shaped} inputs, {taken} taken, {seconds:.0f} s, seed {SEED}")
    return taken


@pytest.fixture(params=DOORS)
def door(request, tmp_path, monkeypatch):
    """A door, with the working directory where it may write; beside it nothing may change.

    The directory above it may be chosen too: `--out ..`.
    """
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    (inside / "here").mkdir(parents=True)
    outside.mkdir()
    (outside / "kept").write_text("kept")
    monkeypatch.chdir(inside / "here")
    yield DOORS[request.param]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["inside", "outside"]
    assert [path.read_text() for path in outside.iterdir()] == ["kept"]


@pytest.mark.slow
def test_a_few_of_everything(door):
    taken = fuzz(door, SMALL)
    assert taken < SMALL


@pytest.mark.long
def test_a_hundred_thousand_of_everything(door):
    fuzz(door, int(LARGE * door.share))
