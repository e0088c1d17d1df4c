"""The kernels that find places for robots at the start of simulations.

They are built by functions so that `geswarm.sim.compiled` can tell numba's cache about all sources:
a kernel that mentions `version` has it in its cache key. That is why they return it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geswarm.sim.kernels.draws import (
    START_HEADING,
    START_OBJECT_X,
    START_OBJECT_Y,
    START_WALK,
    START_WALK_TIME,
    START_X,
    START_Y,
    draw,
    make_key,
)
from geswarm.sim.kernels.free import is_free
from geswarm.sim.kernels.jit import called, kernel

PLACEMENT_ATTEMPTS = 200
"""At how many random places a robot may overlap another one before all are placed by cells."""


@called
def _place(
    keys: Any, first: int, box: Any, radius: float, shapes: Any, heads: Any, behind: Any, drawn: Any
) -> bool:
    """Place the robots of a simulation, of which `first` is one; whether all have a place.

    The head of a cell is the robot placed last in it or -1; each names the one placed before it.
    """
    columns, rows = heads.shape[0] - 2, heads.shape[1] - 2
    for c in range(columns + 2):
        for r in range(rows + 2):
            heads[c, r] = -1
    attempt, i = 0, 0
    while i < len(behind) and attempt < PLACEMENT_ATTEMPTS:
        u = draw(keys[first + i], attempt, START_X)
        v = draw(keys[first + i], attempt, START_Y)
        x, y = box[0] + box[1] * (2.0 * u - 1.0), box[2] + box[3] * v
        column, row = np.int64(u * columns), np.int64(v * rows)
        attempt += 1
        clear = True
        for c in range(column, column + 3):
            for r in range(row, row + 3):
                j = heads[c, r]
                while j >= 0 and clear:
                    dx, dy = x - drawn[0, first + j], y - drawn[1, first + j]
                    clear = math.hypot(dx, dy) >= 2.0 * radius
                    j = behind[j]
        if shapes is not None:
            clear = clear and is_free(shapes, radius, x, y)
        if clear:
            drawn[0, first + i], drawn[1, first + i] = x, y
            behind[i] = heads[column + 1, row + 1]
            heads[column + 1, row + 1] = i
            attempt, i = 0, i + 1
    return i == len(behind)


@called
def _turn(share: float, to: Any, at: int, number: int) -> None:
    """Put the direction of a share of a full turn at `at`."""
    angle = 2.0 * math.pi * share
    to[at, number], to[at + 1, number] = math.cos(angle), math.sin(angle)


def build_begin(version: int) -> Any:
    """The kernel that begins simulations; `version` becomes part of its cache key."""

    @kernel
    def begin(
        simulations: Any,
        box: Any,
        radius: float,
        shapes: Any,
        heads: Any,
        behind: Any,
        keys: Any,
        placed: Any,
        robots: Any,
        objects: Any,
    ) -> int:
        """Place the robots of each simulation at random, and draw what else it begins with.

        Each robot in turn takes the first of its PLACEMENT_ATTEMPTS places that is free and clear
        of those before; if one finds none, that simulation's robots have no places.

        Args:
            simulations: int64, shape (simulations, 4): anything, seed, individual, replicate.
            box: float64, where places are drawn (m): the middle x, half the width, the southern
                end, the depth.
            radius: Of a robot (m).
            shapes: What else limits where robots may be, see `free.is_free`; None for nothing.
            heads: Working space, int32, shape (columns + 2, rows + 2): cells of that box at least
                two radii wide and deep if they are not all of it, and a border of -1.
            behind: Working space, int32, shape (robots,).
            keys: uint64, shape (simulations * robots,), of random numbers.
            placed: bool, shape (simulations,): whether all robots have a place.
            robots: float64, shape (9, simulations * robots): x and y (m); cosine and sine of the
                orientation, and of the random walk; in [0, 1) how long that is kept, and two
                numbers for a place in a cell.
            objects: float64, shape (4, simulations * objects): two numbers in [0, 1), cosine and
                sine of the second one's share of a full turn.
        """
        count, items = len(behind), objects.shape[1] // len(simulations)
        for s in range(len(simulations)):
            seed, individual, replicate = simulations[s, 1], simulations[s, 2], simulations[s, 3]
            for i in range(count):
                n, key = s * count + i, make_key(seed, individual, replicate, i)
                keys[n] = key
                _turn(draw(key, 0, START_HEADING), robots, 2, n)
                _turn(draw(key, 0, START_WALK), robots, 4, n)
                robots[6, n] = draw(key, 0, START_WALK_TIME)
                robots[7, n] = draw(key, PLACEMENT_ATTEMPTS, START_X)
                robots[8, n] = draw(key, PLACEMENT_ATTEMPTS, START_Y)
            placed[s] = _place(keys, s * count, box, radius, shapes, heads, behind, robots)
            key = make_key(seed, individual, replicate, count)
            for o in range(items):
                n = s * items + o
                objects[0, n] = draw(key, o, START_OBJECT_X)
                objects[1, n] = draw(key, o, START_OBJECT_Y)
                _turn(objects[1, n], objects, 2, n)
        return version

    return begin


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
