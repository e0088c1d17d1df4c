"""The kernels that find places for robots at the start of simulations.

They are built by functions so that `geswarm.sim.compiled` can tell numba's cache about all sources:
a kernel that mentions `version` has it in its cache key. That is why they return it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geswarm.sim.kernels.draws import START_X, START_Y, draw_bits
from geswarm.sim.kernels.free import is_free
from geswarm.sim.kernels.jit import called, kernel

PLACEMENT_ATTEMPTS = 200
"""At how many random places a robot may overlap another one before all are placed by cells."""
_SHARE = 1.0 / 4294967296.0  # of random bits


@called
def _is_clear(places: Any, i: int, heads: Any, following: Any, column: int, row: int, apart: float) -> bool:
    """Whether a robot being placed, in a cell, is clear of those placed before.

    A cell's head is the robot placed last in it or -1; each robot names the one before it.
    """
    for c in range(column, column + 3):
        for r in range(row, row + 3):
            j = heads[c, r]
            while j >= 0:
                dx, dy = places[i, 0] - places[j, 0], places[i, 1] - places[j, 1]
                if math.hypot(dx, dy) < apart:
                    return False
                j = following[j]
    return True


def build_scatter(version: int) -> Any:
    """The kernel that places robots at random; `version` becomes part of its cache key."""

    @kernel
    def scatter(
        keys: Any, box: Any, radius: float, shapes: Any, heads: Any, following: Any, places: Any, placed: Any
    ) -> int:
        """Place the robots of each simulation at random, clear of each other.

        Each in turn takes the first of its PLACEMENT_ATTEMPTS places that is clear of those before;
        if none is, that simulation's robots have no places.

        Args:
            keys: uint64, shape (simulations, robots), see `draws.make_keys`.
            box: float64, where places are drawn (m): the middle x, half the width, the southern
                end, the depth; half the width and length of the arena.
            radius: Of a robot (m).
            shapes: What else limits where robots may be, see `free.is_free`.
            heads: Working space, int32, shape (columns + 2, rows + 2): cells of the arena at least
                two radii wide and long, and a border.
            following: Working space, int32, shape (robots,).
            places: float64, shape (simulations, robots, 2): x and y.
            placed: bool, shape (simulations,): whether all robots have a place.
        """
        columns, rows = heads.shape[0] - 2, heads.shape[1] - 2
        per_x, per_y = columns / (2.0 * box[4]), rows / (2.0 * box[5])
        for s in range(len(keys)):
            for column in range(columns + 2):
                for row in range(rows + 2):
                    heads[column, row] = -1
            attempt, i = 0, 0
            while i < keys.shape[1] and attempt < PLACEMENT_ATTEMPTS:
                low, high = np.uint32(keys[s, i]), np.uint32(keys[s, i] >> np.uint64(32))
                u = draw_bits(low, high, attempt, START_X) * _SHARE
                v = draw_bits(low, high, attempt, START_Y) * _SHARE
                x, y = box[0] + box[1] * (2.0 * u - 1.0), box[2] + box[3] * v
                places[s, i, 0], places[s, i, 1] = x, y
                column = min(max(int((x + box[4]) * per_x), 0), columns - 1)
                row = min(max(int((y + box[5]) * per_y), 0), rows - 1)
                attempt += 1
                if is_free(shapes, radius, x, y) and _is_clear(
                    places[s], i, heads, following, column, row, 2.0 * radius
                ):
                    following[i] = heads[column + 1, row + 1]
                    heads[column + 1, row + 1] = i
                    attempt, i = 0, i + 1
            placed[s] = i == keys.shape[1]
        return version

    return scatter


def build_point(version: int) -> Any:
    """The kernel that gives directions; `version` becomes part of its cache key."""

    @kernel
    def point(angles: Any, cosines: Any, sines: Any) -> int:
        """Give cosines and sines of angles (rad), float64, shape (angles,) each."""
        for number in range(len(angles)):
            cosines[number] = math.cos(angles[number])
            sines[number] = math.sin(angles[number])
        return version

    return point


def build_look_around(version: int) -> Any:
    """The kernel that says where robots may stand; `version` becomes part of its cache key."""

    @kernel
    def look_around(shapes: Any, radius: float, points: Any, free: Any) -> int:
        """Look around at some points.

        Args:
            shapes: What there is, see `free.is_free`.
            radius: Of a robot (m).
            points: float64, shape (points, 2).
            free: bool, shape (points,): whether a robot may start there.
        """
        for number in range(len(points)):
            free[number] = is_free(shapes, radius, points[number, 0], points[number, 1])
        return version

    return look_around
