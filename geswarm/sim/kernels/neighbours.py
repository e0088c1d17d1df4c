"""Who stands where while robots are placed: few are compared all, many are kept by cell."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.state import Places


@inlined
def _index(position: float, half_extent: float, cells: int) -> int:
    """Which of the cells between -half_extent and half_extent a position is in."""
    at = int((position + half_extent) * (cells / (2.0 * half_extent)))
    return min(max(at, 0), cells - 1)


@inlined
def enter(places: Places, robots: Any, slots: Any, starts: Any, i: int) -> None:
    """Enter a robot of a large swarm that is being placed into its cell.

    Until all robots are placed, a cell's entry in `starts` is the robot entered last or -1, and the
    robot's slot names the one before it.
    """
    if len(slots) > 0:
        column = _index(robots[i].x, places.half_width, starts.shape[0])
        row = _index(robots[i].y, places.half_length, starts.shape[1] - 1)
        slots[i].robot = starts[column, row]
        starts[column, row] = i


@inlined
def is_clear(places: Places, robots: Any, slots: Any, starts: Any, i: int) -> bool:
    """Whether a robot being placed is clear of those placed before."""
    clear = True
    if len(slots) == 0:
        for j in range(i):
            clear = clear and not _overlap(places, robots[i], robots[j])
        return clear
    columns, rows = starts.shape[0], starts.shape[1] - 1
    column = _index(robots[i].x, places.half_width, columns)
    row = _index(robots[i].y, places.half_length, rows)
    for c in range(max(column - 1, 0), min(column + 2, columns)):
        for r in range(max(row - 1, 0), min(row + 2, rows)):
            j = int(starts[c, r])
            while j >= 0:
                clear = clear and not _overlap(places, robots[i], robots[j])
                j = slots[j].robot
    return clear


@inlined
def _overlap(places: Places, one: Any, other: Any) -> bool:
    """Whether two bodies overlap."""
    return math.hypot(one.x - other.x, one.y - other.y) < 2.0 * places.radius
