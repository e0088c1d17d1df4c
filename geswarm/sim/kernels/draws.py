"""Random numbers without state: `draw(key, step, purpose)`, whatever the batch, thread or order.

No two decisions of a robot share a purpose within a step, so no two decisions ever share bits:

| purpose         | key   | step          | decides                                              |
| --------------- | ----- | ------------- | ---------------------------------------------------- |
| ZONE_MISS       | robot | control step  | whether the zones go unnoticed; not with a table     |
| OUTCOME         | robot | control step  | the outcome of the control table                     |
| WALK_HEADING    | robot | control step  | a fresh heading of the random walk                   |
| WALK_TIME       | robot | control step  | how long that heading is kept                        |
| OBJECT_X, _Y    | robot | control step  | where the object that replaces a picked one appears  |
| START_X, _Y     | robot | attempt       | where a robot starts; the last one: in its cell      |
| START_HEADING   | robot | 0             | its orientation at the start                         |
| START_WALK      | robot | 0             | its first random-walk heading                        |
| START_WALK_TIME | robot | 0             | how long that heading is kept                        |
| START_OBJECT_X, _Y | arena | object number | where an object lies at the start                 |
| FIRST_ACTION + a | robot | control step  | whether action a of the rule set happens             |

The arena's key is that of a robot numbered one past the last.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.sim.kernels.jit import inlined

ZONE_MISS, OUTCOME, WALK_HEADING, WALK_TIME, OBJECT_X, OBJECT_Y = 0, 1, 2, 3, 4, 5
START_X, START_Y, START_HEADING, START_WALK, START_WALK_TIME = 6, 7, 8, 9, 10
START_OBJECT_X, START_OBJECT_Y = 11, 12
FIRST_ACTION = 16

Keys: TypeAlias = npt.NDArray[np.uint64]
Halves: TypeAlias = npt.NDArray[np.uint32]

@inlined
def _mix(h: np.uint32) -> np.uint32:
    """Bijective mix of 32 bits: every input bit reaches every output bit (multiply-xorshift)."""
    h = np.uint32(h ^ np.uint32(h >> np.uint32(16)))
    h = np.uint32(h * np.uint32(0x7FEB352D))
    h = np.uint32(h ^ np.uint32(h >> np.uint32(15)))
    h = np.uint32(h * np.uint32(0x846CA68B))
    return np.uint32(h ^ np.uint32(h >> np.uint32(16)))


@inlined
def draw_bits(low: np.uint32, high: np.uint32, step: int, purpose: int) -> Any:
    """32 random bits, in kernels; `low` and `high` are the halves of a key, the rest as for `draw`."""
    h = _mix(np.uint32(np.uint32(np.uint32(step) * np.uint32(0x9E3779B9)) + low))
    h = np.uint32(h ^ high)
    return _mix(np.uint32(h + np.uint32(np.uint32(purpose) * np.uint32(0x85EBCA6B))))


def make_keys(simulations: npt.NDArray[np.int64], robots: int) -> Keys:
    """Keys of robots' random numbers: two independent mixes of 32 bits each.

    Args:
        simulations: Shape (simulations, 4): anything, seed, individual, replicate.
        robots: How many.

    Returns:
        Shape (simulations, robots).
    """
    halves = np.empty((2, len(simulations)), dtype=np.uint32)
    halves[0], halves[1] = 0x243F6A88, 0x85A308D3
    for numbers in simulations.T[1:]:
        halves = _folded(halves, numbers)
    low, high = _folded(halves[:, :, None], np.arange(robots)).astype(np.uint64)
    keys: Keys = low | (high << np.uint64(32))
    return keys


def draw(keys: Keys, step: npt.ArrayLike, purpose: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Uniform random numbers in [0, 1), multiples of 2**-32.

    Args:
        keys: From `make_keys`.
        step: Control step or other counter, modulo 2**32; of a shape that goes with `keys`.
        purpose: What the numbers decide, see the table above; of such a shape, too.
    """
    by_step, by_purpose = np.array([0x9E3779B9], np.uint32), np.array([0x85EBCA6B], np.uint32)
    h = keys.astype(np.uint32) + np.asarray(step).astype(np.uint32) * by_step
    h = _mixed(h) ^ (keys >> np.uint64(32)).astype(np.uint32)
    bits = _mixed(h + np.asarray(purpose).astype(np.uint32) * by_purpose)
    return bits * (1.0 / 4294967296.0)


def _mixed(h: Halves) -> Halves:
    """`_mix` of each, in place."""
    h ^= h >> np.uint32(16)
    h *= np.uint32(0x7FEB352D)
    h ^= h >> np.uint32(15)
    h *= np.uint32(0x846CA68B)
    h ^= h >> np.uint32(16)
    return h


def _folded(h: Halves, numbers: npt.NDArray[np.int64]) -> Halves:
    """Mix 64-bit numbers into 32 bits each."""
    wide = numbers.astype(np.uint64)
    h = _mixed(h ^ wide.astype(np.uint32))
    h += np.uint32(0x9E3779B9)
    h ^= (wide >> np.uint64(32)).astype(np.uint32)
    return _mixed(h)
