"""What simulations start from: places, robots; how many make a block."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Places(NamedTuple):
    """Where robots may start and objects lie, in double precision; metres, x east, y north.

    Attributes:
        half_width: Greatest distance from the origin, along x; half_length along y.
        half_length: See half_width.
        radius: Of a robot.
        start_x: Robots start in a box, from its middle `start_half` to the east and west ...
        start_half: See start_x.
        start_south: ... and from here `start_depth` to the north ...
        start_depth: See start_south.
        columns: How many robots fit side by side if nothing but the box limits where they start;
            else 0.
        shapes: What else limits where they start, shape (shapes, 7), see `free.is_free`;
            None for nothing.
        object_form: Where objects lie: NO_PLACE, IN_BOX, IN_TURNED, IN_DISC or IN_TRIANGLES.
        objects: Its numbers: middle x, half width, south, depth; or x, y, half width, half length,
            cos, sin; or x, y, radius; or shape (triangles, 8), see `geometry.place_in_triangles`.
    """

    half_width: float
    half_length: float
    radius: float
    start_x: float
    start_half: float
    start_south: float
    start_depth: float
    columns: int
    shapes: Any
    object_form: int
    objects: Any


NO_PLACE, IN_BOX, IN_TURNED, IN_DISC, IN_TRIANGLES = range(5)


class Beginning(NamedTuple):
    """What robots start with, wherever that is.

    Attributes:
        behaviour: Number of the instance of a behaviour.
        state: Bits of the registers.
        walk_min: Shortest time of a random heading (s); walk_max the longest one.
        walk_max: See walk_min.
        control_step: s.
    """

    behaviour: int
    state: int
    walk_min: float
    walk_max: float
    control_step: float


ROBOT = np.dtype(
    [
        ("key", np.uint64),  # of the random numbers
        ("x", np.float64),
        ("y", np.float64),
        ("cos", np.float64),  # of the orientation
        ("sin", np.float64),
        ("walk_x", np.float64),  # unit vector of the random walk
        ("walk_y", np.float64),
        ("walk_until", np.float64),  # control steps since the start at which it is over
        ("behaviour", np.uint8),
        ("states", np.uint8),  # internal-state bits
        ("carried", np.bool_),
    ],
    align=True,
)
"""State of a robot at the start."""

LANES = 64
"""Simulations side by side, or robots of one swarm, in one block."""
