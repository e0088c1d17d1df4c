"""Who may be near whom in a swarm: pairs within sight and a margin, listed now and then.

A list is good until some robot has moved half of the margin. Its pairs are in the order of the
robots, so that sums over them do not depend on when they were listed: what is out of range adds
nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.single import ZERO, F, I, fma
from geswarm.sim.kernels.state import LANES

_FAR, _TRIFLE = F(1e15), F(1e-12)


class Grid(NamedTuple):
    """Room for the search for neighbours and objects.

    Attributes:
        pairs: int32, shape (most, 2): robots i < j, sorted.
        listed: int64, shape (1,): how many pairs; negative if they must be listed anew, as many as
            that if there was no room for them.
        starts: int32, where each cell begins in `order`, shape (columns, rows + 1).
        order: int32, shape (robots,): the robots by cell.
        sorted_x: float32, shape (robots,): their positions, and so sorted_y.
        sorted_y: See sorted_x.
        heads: int32, the first object of each cell or -1, shape (columns, rows).
        following: int32, the next object in the same cell or -1, shape (objects,).
    """

    pairs: Any
    listed: Any
    starts: Any
    order: Any
    sorted_x: Any
    sorted_y: Any
    heads: Any
    following: Any


@inlined
def have_moved(robots: Any, margin: Any) -> Any:
    """Whether a pair that is not listed may be in sight."""
    limit = F(0.25) * margin * margin
    some = I(0)
    for i in range(len(robots)):
        robot = robots[i]
        for lane in range(LANES):
            dx = robot.x[lane] - robot.listed_x[lane]
            dy = robot.y[lane] - robot.listed_y[lane]
            far = I(fma(dx, dx, dy * dy) >= limit)
            some = I(some | I(far & robot.exists[lane]))
    return some != I(0)


@inlined
def _sort_into_cells(robots: Any, grid: Any, half_width: Any, half_length: Any) -> None:
    """Counting sort of the robots by cell, in their own order within a cell."""
    columns, rows = grid.starts.shape[0], grid.starts.shape[1] - 1
    starts = grid.starts.reshape(-1)
    starts[:] = 0
    per_x = F(columns) / (half_width + half_width)
    per_y = F(rows) / (half_length + half_length)
    for i in range(len(robots)):
        robot = robots[i]
        for lane in range(LANES):
            robot.listed_x[lane], robot.listed_y[lane] = robot.x[lane], robot.y[lane]
            column = I((robot.x[lane] + half_width) * per_x)
            row = I((robot.y[lane] + half_length) * per_y)
            column, row = min(max(column, I(0)), I(columns - 1)), min(max(row, I(0)), I(rows - 1))
            robot.cell[lane] = I(I(column * I(rows + 1)) + row)
    for k in range(len(grid.order)):
        starts[robots[k >> 6].cell[k & 63]] += 1
    end = 0
    for cell in range(len(starts)):
        end += starts[cell]
        starts[cell] = end
    for k in range(len(grid.order) - 1, -1, -1):
        cell = robots[k >> 6].cell[k & 63]
        starts[cell] -= 1
        at = starts[cell]
        grid.order[at] = k
        grid.sorted_x[at] = robots[k >> 6].x[k & 63]
        grid.sorted_y[at] = robots[k >> 6].y[k & 63]


@inlined
def list_pairs(robots: Any, grid: Any, half_width: Any, half_length: Any, reach: Any) -> None:
    """List the pairs that are nearer than `reach`; cells are at least as wide as that."""
    _sort_into_cells(robots, grid, half_width, half_length)
    columns, rows = grid.starts.shape[0], grid.starts.shape[1] - 1
    reach2 = reach * reach
    found = 0
    for i in range(len(grid.order)):
        x, y = robots[i >> 6].x[i & 63], robots[i >> 6].y[i & 63]
        column, row = divmod(int(robots[i >> 6].cell[i & 63]), rows + 1)
        begin = found
        for c in range(max(column - 1, 0), min(column + 2, columns)):
            for at in range(grid.starts[c, max(row - 1, 0)], grid.starts[c, min(row + 2, rows)]):
                j = grid.order[at]
                if j <= i:
                    continue
                dx, dy = x - grid.sorted_x[at], y - grid.sorted_y[at]
                if fma(dx, dx, dy * dy) < reach2:
                    _insert(grid.pairs, i, j, begin, found)
                    found += 1
    grid.listed[0] = found if found <= len(grid.pairs) else -found


@inlined
def _insert(pairs: Any, i: int, j: int, begin: int, end: int) -> None:
    """Insert pair (i, j) into those of robot i, begin..end-1; beyond the room nothing is kept."""
    if end < len(pairs):
        at = end
        while at > begin and pairs[at - 1, 1] > j:
            pairs[at, 0], pairs[at, 1] = i, pairs[at - 1, 1]
            at -= 1
        pairs[at, 0], pairs[at, 1] = i, j


@inlined
def gather_pairs(robots: Any, pairs: Any, begin: int, number: int, work: Any) -> None:
    """From the second to the first robot of up to 64 pairs; the lanes without a pair are far.

    Of two at the very same place the first one is taken to be a trifle to the east.
    """
    for lane in range(number):
        i, j = pairs[begin + lane, 0], pairs[begin + lane, 1]
        dx = robots[i >> 6].x[i & 63] - robots[j >> 6].x[j & 63]
        dy = robots[i >> 6].y[i & 63] - robots[j >> 6].y[j & 63]
        work.dx[lane] = dx if dx != ZERO or dy != ZERO else _TRIFLE
        work.dy[lane] = dy
    for lane in range(number, LANES):
        work.dx[lane], work.dy[lane] = _FAR, _FAR
