"""Objects within reach: few are compared each with each, those of a swarm are kept by cell."""

from __future__ import annotations

from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.single import ONE, F, I, fma

FAR = F(1e30)
"""Square of a distance (m2) beyond all."""

_SLACK = F(1.001)  # what is found must not hang on the rounding of a cell's edge


@inlined
def distance2(item: Any, robot: Any, lane: int) -> Any:
    """Squared distance between an object and a robot of the same lane."""
    dx = item.x[lane] - robot.x[lane]
    dy = item.y[lane] - robot.y[lane]
    return fma(dx, dx, dy * dy)


@inlined
def is_near(x: Any, y: Any, reach: Any, west: Any, south: Any, east: Any, north: Any) -> Any:
    """Whether something may be within reach in a box."""
    reach = _SLACK * reach
    across = I(I(x >= west - reach) & I(x <= east + reach))
    return I(across & I(I(y >= south - reach) & I(y <= north + reach)))


@inlined
def _index(place: Any, low: Any, high: Any, cells: int) -> int:
    """Which of the cells between low and high a coordinate is in, or is nearest to."""
    extent = high - low
    share = (place - low) / extent if extent > F(0.0) else F(0.0)
    share = share if share > F(0.0) else F(0.0)
    share = share if share < ONE else ONE
    return min(int(share * F(cells)), cells - 1)


@inlined
def sort_objects(objects: Any, grid: Any, west: Any, south: Any, east: Any, north: Any) -> None:
    """Enter all objects into their cells.

    Args:
        objects: float32, shape (objects, 2).
        grid: Its `heads` are the first object of each cell or -1, `following` the next one of each.
        west: The box in which objects lie, and so south, east and north.
        south: See west.
        east: See west.
        north: See west.
    """
    grid.heads[:] = -1
    for o in range(len(objects)):
        insert_object(objects, grid, o, west, south, east, north)


@inlined
def insert_object(
    objects: Any, grid: Any, o: int, west: Any, south: Any, east: Any, north: Any
) -> None:
    """Enter an object into the cell in which it lies."""
    column = _index(objects[o, 0], west, east, grid.heads.shape[0])
    row = _index(objects[o, 1], south, north, grid.heads.shape[1])
    grid.following[o] = grid.heads[column, row]
    grid.heads[column, row] = o


@inlined
def remove_object(
    objects: Any, grid: Any, o: int, west: Any, south: Any, east: Any, north: Any
) -> None:
    """Take an object out of its cell; it must not have moved since it was entered."""
    column = _index(objects[o, 0], west, east, grid.heads.shape[0])
    row = _index(objects[o, 1], south, north, grid.heads.shape[1])
    if grid.heads[column, row] == o:
        grid.heads[column, row] = grid.following[o]
        return
    before = grid.heads[column, row]
    while grid.following[before] != o:
        before = grid.following[before]
    grid.following[before] = grid.following[o]


@inlined
def nearest_object(
    objects: Any,
    grid: Any,
    x: Any,
    y: Any,
    reach: Any,
    west: Any,
    south: Any,
    east: Any,
    north: Any,
) -> int:
    """The nearest object within reach, the first one of several; -1 if there is none."""
    columns, rows = grid.heads.shape
    far = _SLACK * reach
    nearest, nearest_d2 = -1, reach * reach
    first_row, last_row = _index(y - far, south, north, rows), _index(y + far, south, north, rows)
    last_column = _index(x + far, west, east, columns)
    for column in range(_index(x - far, west, east, columns), last_column + 1):
        for row in range(first_row, last_row + 1):
            o = int(grid.heads[column, row])
            while o >= 0:
                dx, dy = objects[o, 0] - x, objects[o, 1] - y
                d2 = fma(dx, dx, dy * dy)
                if d2 < nearest_d2 or (d2 == nearest_d2 and (nearest < 0 or o < nearest)):
                    nearest, nearest_d2 = o, d2
                o = int(grid.following[o])
    return nearest
