"""Random numbers without state: `draw(key, step, purpose)`, the same for any batch, thread or order.

No two decisions of a robot share a purpose within a step, so no two decisions ever share bits:

| purpose         | key   | step          | decides                                              |
| --------------- | ----- | ------------- | ---------------------------------------------------- |
| ZONE_MISS       | robot | control step  | whether the zones go unnoticed in this step          |
| OUTCOME         | robot | control step  | the outcome of the control table                     |
| WALK_HEADING    | robot | control step  | a fresh heading of the random walk                   |
| WALK_TIME       | robot | control step  | how long that heading is kept                        |
| OBJECT_X, _Y    | robot | control step  | where the object that replaces a picked one appears  |
| START_X, _Y     | robot | attempt       | where a robot starts                                 |
| START_HEADING   | robot | 0             | its orientation at the start                         |
| START_WALK      | robot | 0             | its first random-walk heading                        |
| START_WALK_TIME | robot | 0             | how long that heading is kept                        |
| START_OBJECT_X, _Y | arena | object number | where an object lies at the start                 |
| ACTION + a      | robot | control step  | whether action a of the rule set happens             |

The arena's key is that of a robot numbered one past the last.
"""

from __future__ import annotations

import numpy as np
from numba import njit

ZONE_MISS, OUTCOME, WALK_HEADING, WALK_TIME, OBJECT_X, OBJECT_Y = 0, 1, 2, 3, 4, 5
START_X, START_Y, START_HEADING, START_WALK, START_WALK_TIME = 6, 7, 8, 9, 10
START_OBJECT_X, START_OBJECT_Y = 11, 12
ACTION = 16


@njit
def _mix(h: int) -> int:
    """Bijective mix of 32 bits: every input bit reaches every output bit (multiply-xorshift)."""
    h = np.uint32(h ^ np.uint32(h >> np.uint32(16)))
    h = np.uint32(h * np.uint32(0x7FEB352D))
    h = np.uint32(h ^ np.uint32(h >> np.uint32(15)))
    h = np.uint32(h * np.uint32(0x846CA68B))
    return np.uint32(h ^ np.uint32(h >> np.uint32(16)))


@njit
def _fold(h: int, number: int) -> int:
    """Mix a 64-bit number into 32 bits."""
    number = np.uint64(number)
    h = _mix(np.uint32(h ^ np.uint32(number & np.uint64(0xFFFFFFFF))))
    h = np.uint32(h + np.uint32(0x9E3779B9))
    return _mix(np.uint32(h ^ np.uint32(number >> np.uint64(32))))


@njit
def make_key(key: np.ndarray, seed: int, individual: int, replicate: int, robot: int) -> None:
    """Write the two words of a robot's key, uint32, shape (2,)."""
    for word in range(2):
        h = np.uint32(0x243F6A88 if word == 0 else 0x85A308D3)
        h = _fold(_fold(_fold(_fold(h, seed), individual), replicate), robot)
        key[word] = h


@njit
def draw(key: np.ndarray, step: int, purpose: int) -> float:
    """Uniform random number in [0, 1), a multiple of 2**-32.

    Args:
        key: The two words of `make_key`.
        step: Control step or other counter, modulo 2**32.
        purpose: What the number decides, see the table above.
    """
    h = _mix(np.uint32(np.uint32(np.uint32(step) * np.uint32(0x9E3779B9)) + key[0]))
    h = np.uint32(h ^ key[1])
    h = _mix(np.uint32(h + np.uint32(np.uint32(purpose) * np.uint32(0x85EBCA6B))))
    return h * (1.0 / 4294967296.0)
