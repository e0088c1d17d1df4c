"""LLVM's own remarks: every loop over lanes becomes vector instructions."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sim.assembly.arenas import KINDS

SCALAR = (
    "= U(classes[work.place[lane]])",  # a look-up
    "= rows[work.row[lane]]",
    "= thresholds[work.place[lane]]",
    "= outcomes[work.place[lane]]",
    "= kinds[work.place[lane]]",
    "= arguments[work.place[lane], 0]",
    "decisions[work.place[lane]] +=",
    "work.touch[lane] = I(0)",  # becomes a call of memset
    "to_light_x_here, to_light_y_here = ZERO, ZERO",  # no lamps: the same
    "brightness_here = ZERO",
    "if work.happens[lane]:",  # rare
    "if work.touch[lane]:",
    "if work.near[lane]:",
)
"""First lines of the loops that are meant to go through the lanes one by one."""


def loops_that_are_not_vectorised(*what):
    script = Path(__file__).with_name("remarks.py")
    done = subprocess.run(
        [sys.executable, script, *what], capture_output=True, text=True, timeout=600, check=True,
        env=os.environ,
    )  # fmt: skip
    file = Path(re.search(r"^file (.*)$", done.stdout, re.MULTILINE)[1])
    pattern = rf"{file.name}:(\d+):\d+: vectorized loop"
    vectorised = {int(line) for line in re.findall(pattern, done.stderr)}
    assert vectorised, done.stderr[-2000:]
    inside = re.search(r"^lines (.*)$", done.stdout, re.MULTILINE)[1]
    within = {int(line) for line in inside.split()}
    lines = file.read_text().splitlines()
    heads = [
        number
        for number, line in enumerate(lines, 1)
        if re.search(r"for lane in range\((width|LANES)\):", line)
        and not any(scalar in "\n".join(lines[number : number + 2]) for scalar in SCALAR)
    ]
    assert len(heads) > 10
    # LLVM names the head of a loop or, where it was turned round, its first line.
    missing = [
        head
        for head in heads
        if not vectorised & {head, head + 1, head + 2} and not within & {head, head + 1}
    ]
    return [f"{file.name}, line {head}: {lines[head].strip()}" for head in missing]


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["lanes", pytest.param("swarm", marks=pytest.mark.long)])
def test_every_loop_over_lanes_is_vectorised(layout):
    assert loops_that_are_not_vectorised(layout) == []


@pytest.mark.slow
def test_every_loop_of_aac_is_vectorised():
    assert loops_that_are_not_vectorised("lanes", "aac") == []


@pytest.mark.long
@pytest.mark.parametrize("scenario", ["aggregation", "homing", "xor", "epuck-aac"])
def test_every_loop_of_the_other_scenarios_is_vectorised(scenario):
    assert loops_that_are_not_vectorised("lanes", scenario) == []


@pytest.mark.long
@pytest.mark.parametrize("arena", KINDS)
def test_every_loop_is_vectorised_in_arenas_of_every_form(arena):
    assert loops_that_are_not_vectorised("lanes", arena) == []
