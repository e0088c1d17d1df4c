"""Where a robot may stand at the start: in double precision, by loops over what is in the arena."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.state import Places


@inlined
def is_free(places: Places, x: float, y: float) -> bool:
    """Whether a place is where robots start, and clear of walls and obstacles.

    Of the box from which places are drawn nothing is asked: they are in it.
    """
    at_x, at_y, radius = places.start_disc
    free = radius < 0.0 or math.hypot(x - at_x, y - at_y) <= radius
    if len(places.start_corners):
        free = free and is_inside(places.start_corners, x, y)
    return free and gap_around(places, x, y) >= places.radius


@inlined
def is_inside(corners: Any, x: float, y: float) -> bool:
    """Whether a place is inside a polygon; shape (corners, 2 or more)."""
    inside = False
    before_x, before_y = corners[-1, 0], corners[-1, 1]
    for k in range(len(corners)):
        to_x, to_y = corners[k, 0], corners[k, 1]
        if (before_y > y) != (to_y > y):
            crossing = before_x + (to_x - before_x) * (y - before_y) / (to_y - before_y)
            inside = inside != (x < crossing)
        before_x, before_y = to_x, to_y
    return inside


@inlined
def gap_around(places: Places, x: float, y: float) -> float:
    """Distance to the nearest wall or obstacle, those of a box outline left out.

    Negative outside the outline and inside an obstacle.
    """
    gap = math.inf
    if places.round >= 0.0:
        gap = places.round - math.hypot(x, y)
    if len(places.walls):
        for k in range(len(places.walls)):
            gap = min(gap, _to_wall(places.walls[k], x, y))
        gap = gap if is_inside(places.walls, x, y) else -gap
    for k in range(len(places.discs)):
        disc = places.discs[k]
        gap = min(gap, math.hypot(x - disc[0], y - disc[1]) - disc[2])
    for k in range(len(places.boxes)):
        gap = min(gap, _to_box(places.boxes[k], x, y))
    return gap


@inlined
def _to_wall(wall: Any, x: float, y: float) -> float:
    along_x, along_y = wall[2] - wall[0], wall[3] - wall[1]
    dx, dy = x - wall[0], y - wall[1]
    share = (dx * along_x + dy * along_y) / (along_x * along_x + along_y * along_y)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(dx - share * along_x, dy - share * along_y)


@inlined
def _to_box(box: Any, x: float, y: float) -> Any:
    dx, dy = x - box[0], y - box[1]
    across = abs(dx * box[4] + dy * box[5]) - box[2]
    along = abs(dy * box[4] - dx * box[5]) - box[3]
    if across < 0.0 and along < 0.0:
        return max(across, along)
    return math.hypot(max(across, 0.0), max(along, 0.0))
