"""The way to a GPU stays open: a component runs under numba-cuda's simulator as it is."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import numpy as np
from numba import cuda
from geswarm.sim.terms.light import light_level

one = cuda.jit(device=True)(light_level.function)


@cuda.jit
def sense(places, readings):
    at = cuda.grid(1)
    if at < len(places):
        readings[at] = one(places[at])


places = np.linspace(0, 9, 200, dtype=np.float32)
readings = np.zeros(200, dtype=np.int32)
sense[4, 64](places, readings)
expected = [light_level.function(place) for place in places]
assert readings.tolist() == expected
assert set(expected) == set(range(8))
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
