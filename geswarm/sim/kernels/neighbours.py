"""Who is near whom: avoidance between robots, pairs that may touch, objects within reach.

Few robots are compared each with each. Many are sorted into the cells of a grid that are at least
as wide as robots see, so that only neighbouring cells have to be compared and the time grows with
the number of robots, not with its square. Objects are always kept by cell.
"""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.state import Physics


@inlined
def _index(position: float, half_extent: float, cells: int) -> int:
    """Which of the cells between -half_extent and half_extent a position is in."""
    at = int((position + half_extent) * (cells / (2.0 * half_extent)))
    return min(max(at, 0), cells - 1)


@inlined
def avoid_robots(physics: Physics, robots: Any, slots: Any, starts: Any) -> bool:
    """Avoidance vector from the other robots, for all; True if some pair may touch in this step.

    Args:
        physics: Scenario in numbers.
        robots: Updated in place.
        slots: Of SLOT, shape (robots,), to be sorted by cell; empty to compare each with each.
        starts: Where each cell starts in `slots`, shape (columns, rows + 1); a column's last entry
            is its end.
    """
    for i in range(len(robots)):
        robots[i].away_x = 0.0
        robots[i].away_y = 0.0
        robots[i].may_touch = False
    may_touch = False
    if len(slots) == 0:
        for i in range(len(robots)):
            for j in range(i + 1, len(robots)):
                if _meet(physics, robots[i], robots[j]):
                    may_touch = True
        return may_touch
    _sort_into_cells(physics, robots, slots, starts)
    for a in range(len(slots)):
        i = slots[a].robot
        for side in range(2):
            first, end = _later_neighbours(slots, starts, a, side)
            for b in range(first, end):
                j = slots[b].robot
                if _meet(physics, robots[min(i, j)], robots[max(i, j)]):
                    may_touch = True
    return may_touch


@inlined
def _meet(physics: Physics, one: Any, other: Any) -> bool:
    """Two robots avoid each other if in range; True if they may touch in this step."""
    dx = one.x - other.x
    dy = one.y - other.y
    d2 = dx * dx + dy * dy
    touch = 2.0 * (physics.radius + physics.max_speed * physics.control_step) + 1e-9
    if d2 < physics.rab_range * physics.rab_range:
        d, dx, dy = apart(dx, dy)
        strength = 1.0 - d / physics.rab_range
        one.away_x += strength * dx
        one.away_y += strength * dy
        other.away_x -= strength * dx
        other.away_y -= strength * dy
    if d2 < touch * touch:
        one.may_touch = True
        other.may_touch = True
        return True
    return False


@inlined
def _sort_into_cells(physics: Physics, robots: Any, slots: Any, starts: Any) -> None:
    """Counting sort of the robots by cell, in their own order within a cell."""
    columns, rows = starts.shape[0], starts.shape[1] - 1
    starts[:] = 0
    for i in range(len(robots)):
        robot = robots[i]
        robot.column = _index(robot.x, physics.half_width, columns)
        robot.row = _index(robot.y, physics.half_length, rows)
        starts[robot.column, robot.row] += 1
    end = 0
    for column in range(columns):
        for row in range(rows + 1):
            end += starts[column, row]
            starts[column, row] = end
    for i in range(len(robots) - 1, -1, -1):
        robot = robots[i]
        starts[robot.column, robot.row] -= 1
        slot = slots[starts[robot.column, robot.row]]
        slot.robot, slot.column, slot.row = i, robot.column, robot.row


@inlined
def _later_neighbours(slots: Any, starts: Any, a: int, side: int) -> tuple[int, int]:
    """Slots whose robots are compared with that of slot a, so that each pair is compared once.

    Side 0: the rest of its own cell and the cell to the north. Side 1: the three to the east.
    """
    columns, rows = starts.shape[0], starts.shape[1] - 1
    column, row = slots[a].column, slots[a].row
    north = min(row + 2, rows)
    if side == 0:
        return a + 1, starts[column, north]
    if column + 1 == columns:
        return 0, 0
    return starts[column + 1, max(row - 1, 0)], starts[column + 1, north]


@inlined
def collide(physics: Physics, robots: Any, slots: Any, starts: Any, may_touch: bool) -> None:
    """Push overlapping pairs apart, pair after pair, then clamp everything inside the walls.

    In a large swarm only robots that may touch another one are looked at, with their neighbours at
    the start of the step.
    """
    if may_touch and len(slots) == 0:
        for i in range(len(robots)):
            for j in range(i + 1, len(robots)):
                _push_apart(robots[i], robots[j], physics.radius)
    elif may_touch:
        for a in range(len(slots)):
            robot = robots[slots[a].robot]
            for side in range(2):
                first, end = _later_neighbours(slots, starts, a, side)
                for b in range(first, end if robot.may_touch else 0):
                    _push_apart(robot, robots[slots[b].robot], physics.radius)
    reach_x = physics.half_width - physics.radius
    reach_y = physics.half_length - physics.radius
    for i in range(len(robots)):
        robot = robots[i]
        robot.x = min(max(robot.x, -reach_x), reach_x)
        robot.y = min(max(robot.y, -reach_y), reach_y)


@inlined
def _push_apart(robot: Any, other: Any, radius: float) -> None:
    """Move both by half of their overlap."""
    dx = robot.x - other.x
    dy = robot.y - other.y
    if dx * dx + dy * dy < 4.0 * radius * radius:
        d, dx, dy = apart(dx, dy)
        push = radius - d / 2.0
        robot.x += push * dx
        robot.y += push * dy
        other.x -= push * dx
        other.y -= push * dy


@inlined
def apart(dx: float, dy: float) -> tuple[float, float, float]:
    """Distance and unit vector of (dx, dy); east for robots at the very same place."""
    d = math.sqrt(dx * dx + dy * dy)
    if d == 0.0:
        return 0.0, 1.0, 0.0
    return d, dx / d, dy / d


@inlined
def enter(physics: Physics, robots: Any, slots: Any, starts: Any, i: int) -> None:
    """Enter a robot of a large swarm that is being placed into its cell.

    Until all robots are placed, a cell's entry in `starts` is the robot entered last or -1, and the
    robot's slot names the one before it.
    """
    if len(slots) > 0:
        column = _index(robots[i].x, physics.half_width, starts.shape[0])
        row = _index(robots[i].y, physics.half_length, starts.shape[1] - 1)
        slots[i].robot = starts[column, row]
        starts[column, row] = i


@inlined
def is_clear(physics: Physics, robots: Any, slots: Any, starts: Any, i: int) -> bool:
    """Whether a robot being placed is clear of those placed before."""
    clear = True
    if len(slots) == 0:
        for j in range(i):
            clear = clear and not _overlap(physics, robots[i], robots[j])
        return clear
    columns, rows = starts.shape[0], starts.shape[1] - 1
    column = _index(robots[i].x, physics.half_width, columns)
    row = _index(robots[i].y, physics.half_length, rows)
    for c in range(max(column - 1, 0), min(column + 2, columns)):
        for r in range(max(row - 1, 0), min(row + 2, rows)):
            j = int(starts[c, r])
            while j >= 0:
                clear = clear and not _overlap(physics, robots[i], robots[j])
                j = slots[j].robot
    return clear


@inlined
def _overlap(physics: Physics, one: Any, other: Any) -> bool:
    """Whether two bodies overlap."""
    return math.hypot(one.x - other.x, one.y - other.y) < 2.0 * physics.radius


@inlined
def sort_objects(physics: Physics, objects: Any, heads: Any, following: Any) -> None:
    """Enter all objects into their cells.

    Args:
        physics: Scenario in numbers.
        objects: Shape (objects, 2).
        heads: The first object of each cell of the source or -1, int32, shape (columns, rows).
        following: For each object the next one in its cell or -1, int32, shape (objects,).
    """
    heads[:] = -1
    for o in range(len(objects)):
        insert_object(physics, objects, heads, following, o)


@inlined
def _source_row(physics: Physics, y: float, rows: int) -> Any:
    """Which row of the source's grid a position is in."""
    half_length = (physics.half_length - physics.source_edge) / 2.0
    return _index(y - physics.source_edge - half_length, half_length, rows)


@inlined
def insert_object(physics: Physics, objects: Any, heads: Any, following: Any, o: int) -> None:
    """Enter an object into the cell in which it lies."""
    column = _index(objects[o, 0], physics.half_width, heads.shape[0])
    row = _source_row(physics, objects[o, 1], heads.shape[1])
    following[o] = heads[column, row]
    heads[column, row] = o


@inlined
def remove_object(physics: Physics, objects: Any, heads: Any, following: Any, o: int) -> None:
    """Take an object out of its cell; it must not have moved since it was entered."""
    column = _index(objects[o, 0], physics.half_width, heads.shape[0])
    row = _source_row(physics, objects[o, 1], heads.shape[1])
    if heads[column, row] == o:
        heads[column, row] = following[o]
        return
    before = heads[column, row]
    while following[before] != o:
        before = following[before]
    following[before] = following[o]


@inlined
def nearest_object(
    physics: Physics, objects: Any, heads: Any, following: Any, x: float, y: float
) -> int:
    """The nearest object within reach, the first one of several; -1 if there is none."""
    reach = physics.grip_reach
    columns, rows = heads.shape
    nearest = -1
    nearest_d2 = reach * reach
    first_column = _index(x - reach, physics.half_width, columns)
    first_row = _source_row(physics, y - reach, rows)
    for column in range(first_column, _index(x + reach, physics.half_width, columns) + 1):
        for row in range(first_row, _source_row(physics, y + reach, rows) + 1):
            o = int(heads[column, row])
            while o >= 0:
                dx = objects[o, 0] - x
                dy = objects[o, 1] - y
                d2 = dx * dx + dy * dy
                if d2 < nearest_d2 or (d2 == nearest_d2 and (nearest < 0 or o < nearest)):
                    nearest, nearest_d2 = o, d2
                o = int(following[o])
    return nearest
