"""The way to a GPU stays open: a component runs under numba-cuda's simulator as it is."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import numpy as np
from numba import cuda
from geswarm.sim.terms.areas import areas

one = cuda.jit(device=True)(areas.function)


@cuda.jit
def sense(places, readings):
    at = cuda.grid(1)
    if at < len(places):
        readings[at] = one(places[at], np.float32(-0.6), np.float32(0.1))


places = np.linspace(-2.1, 2.1, 200, dtype=np.float32)
readings = np.zeros(200, dtype=np.int32)
sense[4, 64](places, readings)
expected = [areas.function(y, np.float32(-0.6), np.float32(0.1)) for y in places]
assert readings.tolist() == expected
assert set(expected) == {0, 1, 2}
"""


def in_simulator(script):
    environment = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1"}
    command = [sys.executable, "-c", script]
    return subprocess.run(command, env=environment, timeout=300, capture_output=True, text=True)


def test_a_component_runs_on_cudas_simulator():
    if in_simulator("from numba import cuda").returncode:
        pytest.skip("needs the extra cuda")
    done = in_simulator(SCRIPT)
    assert done.returncode == 0, done.stderr
