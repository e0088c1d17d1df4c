"""Where a robot may stand at the start, in double precision: by a loop over what there is."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined

START_DISC, START_SIDE, WALL, CLOSED, ROUND, DISC, BOX = range(7)
"""What there may be in an arena, see `is_free`."""


@inlined
def is_free(shapes: Any, radius: float, x: float, y: float) -> bool:
    """Whether a place is where robots start, and clear of walls and obstacles.

    Nothing is asked of a box outline, nor of the box from which places are drawn.

    Args:
        shapes: float64, shape (shapes, 7); the first number says what a row is, the others are of
            START_DISC, in which robots start: x, y, radius;
            START_SIDE, of the polygon in which they start: from x, y to x, y;
            WALL, of the outline: from x, y to x, y;
            CLOSED, what the sides or walls before it make: none;
            ROUND, the outline: x, y, radius;
            DISC, an obstacle: x, y, radius;
            BOX, an obstacle: x, y, half width, half length, cos, sin.
        radius: Of a robot (m).
        x: Eastward (m).
        y: Northward (m).
    """
    inside = False
    for k in range(len(shapes)):
        kind, gap = shapes[k, 0], math.inf
        dx, dy = x - shapes[k, 1], y - shapes[k, 2]
        if kind == CLOSED:
            gap, inside = math.inf if inside else -math.inf, False
        elif kind == BOX:
            across = abs(dx * shapes[k, 5] + dy * shapes[k, 6]) - shapes[k, 3]
            along = abs(dy * shapes[k, 5] - dx * shapes[k, 6]) - shapes[k, 4]
            gap = math.hypot(max(across, 0.0), max(along, 0.0))
        elif START_SIDE <= kind <= WALL:
            end_x, end_y = shapes[k, 3] - shapes[k, 1], shapes[k, 4] - shapes[k, 2]
            if (dy < 0.0) != (shapes[k, 4] > y):
                inside = inside != (x < shapes[k, 1] + end_x * dy / end_y)
            if kind == WALL:
                share = (dx * end_x + dy * end_y) / (end_x * end_x + end_y * end_y)
                share = min(max(share, 0.0), 1.0)
                gap = math.hypot(dx - share * end_x, dy - share * end_y)
        elif kind == START_DISC:
            gap = math.inf if math.hypot(dx, dy) <= shapes[k, 3] else -math.inf
        else:
            gap = math.hypot(dx, dy) - shapes[k, 3]
            gap = -gap if kind == ROUND else gap
        if gap < radius:
            return False
    return True
