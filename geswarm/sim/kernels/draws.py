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
| E_PUCK + n      | robot | control step  | noise of an e-puck's wheels and sensors              |
| MESSAGE + j     | robot | control step  | which messages between it and e-puck j are lost      |
| FIRST_CHANCE + k r + i | robot | control step | whether the i-th of k readings lets rule r |
|                 |       |               | act, where that is by chance                         |

The arena's key is that of a robot numbered one past the last.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import called, inlined

ZONE_MISS, OUTCOME, WALK_HEADING, WALK_TIME, OBJECT_X, OBJECT_Y = 0, 1, 2, 3, 4, 5
START_X, START_Y, START_HEADING, START_WALK, START_WALK_TIME = 6, 7, 8, 9, 10
START_OBJECT_X, START_OBJECT_Y = 11, 12
FIRST_ACTION = 16
E_PUCK, MESSAGE = 1 << 20, 1 << 21
FIRST_CHANCE = 1 << 22


@inlined
def _mix(h: np.uint32) -> np.uint32:
    """Bijective mix of 32 bits: every input bit reaches every output bit (multiply-xorshift)."""
    h = np.uint32(h ^ np.uint32(h >> np.uint32(16)))
    h = np.uint32(h * np.uint32(0x7FEB352D))
    h = np.uint32(h ^ np.uint32(h >> np.uint32(15)))
    h = np.uint32(h * np.uint32(0x846CA68B))
    return np.uint32(h ^ np.uint32(h >> np.uint32(16)))


@inlined
def _fold(h: np.uint32, number: int) -> Any:
    """Mix a 64-bit number into 32 bits."""
    wide = np.uint64(number)
    h = _mix(np.uint32(h ^ np.uint32(wide & np.uint64(0xFFFFFFFF))))
    h = np.uint32(h + np.uint32(0x9E3779B9))
    return _mix(np.uint32(h ^ np.uint32(wide >> np.uint64(32))))


@called
def make_key(seed: int, individual: int, replicate: int, robot: int) -> np.uint64:
    """Key of a robot's random numbers: two independent mixes of 32 bits."""
    low = _fold(_fold(_fold(_fold(np.uint32(0x243F6A88), seed), individual), replicate), robot)
    high = _fold(_fold(_fold(_fold(np.uint32(0x85A308D3), seed), individual), replicate), robot)
    return np.uint64(low) | (np.uint64(high) << np.uint64(32))


@inlined
def draw_bits(low: np.uint32, high: np.uint32, step: int, purpose: int) -> Any:
    """32 random bits; `low` and `high` are the halves of a key, the rest as for `draw`."""
    return thrown(dice_of(low, high, step), purpose)


@inlined
def dice_of(low: np.uint32, high: np.uint32, step: int) -> Any:
    """What all that is drawn for a robot in a step has in common, see `thrown`."""
    h = _mix(np.uint32(np.uint32(np.uint32(step) * np.uint32(0x9E3779B9)) + low))
    return np.uint32(h ^ high)


@inlined
def thrown(dice: np.uint32, purpose: int) -> Any:
    """The random bits of `draw_bits`, for one purpose."""
    return _mix(np.uint32(dice + np.uint32(np.uint32(purpose) * np.uint32(0x85EBCA6B))))


@called
def draw(key: np.uint64, step: int, purpose: int) -> float:
    """Uniform random number in [0, 1), a multiple of 2**-32.

    Args:
        key: From `make_key`.
        step: Control step or other counter, modulo 2**32.
        purpose: What the number decides, see the table above.
    """
    low = np.uint32(key & np.uint64(0xFFFFFFFF))
    high = np.uint32(key >> np.uint64(32))
    return float(draw_bits(low, high, step, purpose)) * (1.0 / 4294967296.0)
