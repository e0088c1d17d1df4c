"""Where robots start, in an arena of any form."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import Extent, around_origin, corners, extent_of, turn_of
from geswarm.sim.arena.model import Arena, Box, Disc, Polygon
from geswarm.sim.arena.source_place import box_numbers, where_objects_lie
from geswarm.sim.arena.triangles import Triangles
from geswarm.sim.compiled import look_around
from geswarm.sim.kernels.free import BOX, CLOSED, DISC, ROUND, START_DISC, START_SIDE, WALL
from geswarm.sim.kernels.state import IN_BOX, IN_DISC, IN_TRIANGLES, IN_TURNED, NO_PLACE, Places
from geswarm.sim.terms.ground import GroundError

_MOST_SAMPLES = 1_000_000
_FINE = 8.0
"""Free places are looked for at distances of a robot's radius divided by this."""

Array = npt.NDArray[np.float64]


def room_for(arena: Arena, radius: float) -> int:
    """How many robots can start in an arena for certain, clear of each other and of all else.

    Args:
        arena: The arena.
        radius: Of a robot (m).
    """
    places = places_of(arena, radius)
    if places.start_half < 0.0 or places.start_depth < 0.0:
        return 0
    if places.columns:
        return places.columns * (1 + math.floor(places.start_depth / (2.0 * radius)))
    return len(spots_of(arena, radius))


@lru_cache(maxsize=64)
def places_of(arena: Arena, radius: float, margin: float | None = None) -> Places:
    """Where robots start and objects lie.

    Args:
        arena: The arena.
        radius: Of a robot (m).
        margin: Least distance of objects from walls and obstacles (m); None for no objects.

    Raises:
        GroundError: Objects cannot be placed in the area `source`.
    """
    region = None if arena.start is None else arena.resolved(arena.start)
    reach = around_origin(*_reach(arena, radius))
    extent = reach if region is None else extent_of(region).intersection(reach)
    box = box_numbers(extent)
    turned = isinstance(region, Box) and bool(region.angle % 180.0)
    shapes: list[tuple[float, ...]] = []
    if isinstance(region, Disc):
        shapes = [(START_DISC, region.x, region.y, region.radius)]
    elif region is not None and (turned or isinstance(region, Polygon)):
        shapes = _closed(START_SIDE, corners(region).tolist())
    shapes += [*_outline(arena), *(_obstacle(each) for each in arena.obstacles)]
    form, objects = _objects(arena, margin)
    return Places(
        half_width=arena.half_width,
        half_length=arena.half_length,
        radius=radius,
        start_x=box["x"],
        start_half=box["half_width"],
        start_south=box["south"],
        start_depth=box["depth"],
        columns=0 if shapes else _columns(arena, extent, radius),
        shapes=_rows(7, shapes) if shapes else None,
        object_form=form,
        objects=objects,
    )


def _reach(arena: Arena, radius: float) -> tuple[float, float]:
    return arena.half_width - radius, arena.half_length - radius


def _columns(arena: Arena, extent: Extent, radius: float) -> int:
    """How many robots fit side by side in a box, walls being where they are."""
    diameter = 2.0 * radius
    reach_x, _ = _reach(arena, radius)
    whole = (extent.west, extent.east) == (-reach_x, reach_x)
    width = 2.0 * arena.half_width - diameter if whole else extent.east - extent.west
    return 1 + max(0, math.floor(width / diameter))


def _outline(arena: Arena) -> list[tuple[float, ...]]:
    """An outline that is no box, as `kernels.free.is_free` takes it."""
    if isinstance(arena.outline, Disc):
        return [(ROUND, 0.0, 0.0, arena.outline.radius)]
    if isinstance(arena.outline, Polygon):
        return _closed(WALL, arena.outline.points)
    return []


def _closed(kind: int, points: Iterable[Sequence[float]]) -> list[tuple[float, ...]]:
    """The sides of a polygon."""
    points = list(points)
    ends = [*points[1:], points[0]]
    sides = [(kind, *one, *other) for one, other in zip(points, ends, strict=True)]
    return [*sides, (CLOSED,)]


def _obstacle(each: Disc | Box) -> tuple[float, ...]:
    return (DISC, each.x, each.y, each.radius) if isinstance(each, Disc) else (BOX, *_box(each))


def _rows(width: int, rows: list[tuple[float, ...]]) -> Array:
    """Rows filled up with zeros."""
    filled = [(*row, *[0.0] * (width - len(row))) for row in rows]
    return np.array(filled, dtype=np.float64).reshape(-1, width)


def _box(box: Box) -> tuple[float, ...]:
    return box.x, box.y, box.width / 2.0, box.length / 2.0, *turn_of(box)


def _objects(arena: Arena, margin: float | None) -> tuple[int, Array]:
    """How the places of objects are drawn, and its numbers."""
    place = None if margin is None else where_objects_lie(arena, margin)
    if place is None:
        return NO_PLACE, np.zeros(6)
    shape = place.shape
    if isinstance(shape, Triangles):
        return IN_TRIANGLES, shape.rows
    if isinstance(shape, Disc):
        return IN_DISC, np.array([shape.x, shape.y, shape.radius, 0.0, 0.0, 0.0])
    if isinstance(shape, Box):
        return IN_TURNED, np.array(_box(shape))
    return IN_BOX, np.array([*box_numbers(shape).values(), 0.0, 0.0])


@lru_cache(maxsize=16)
def spots_of(arena: Arena, radius: float) -> Array:
    """Places for robots that are clear of each other and of all else, shape (spots, 2).

    Rows two radii apart, and in each of them as many as there is room for; the best of some
    beginnings.
    """
    places = places_of(arena, radius)
    if places.start_half < 0.0 or places.start_depth < 0.0:
        return np.zeros((0, 2))
    found = [_rows_of_spots(places, share / 8.0) for share in range(8)]
    return max(found, key=len)


def _rows_of_spots(places: Places, share: float) -> Array:
    """The free places of rows that begin `share` of their distance from the southern end."""
    diameter = 2.0 * places.radius * (1.0 + 1e-9)
    width, depth = 2.0 * places.start_half, places.start_depth
    first = min(share * diameter, depth)
    rows = first + diameter * np.arange(1 + math.floor((depth - first) / diameter))
    least = max(places.radius / _FINE, width * len(rows) / _MOST_SAMPLES)
    columns = np.linspace(-1.0, 1.0, 2 + math.floor(width / least))
    x, y = np.meshgrid(places.start_x + places.start_half * columns, places.start_south + rows)
    points = np.column_stack((x.ravel(), y.ravel()))
    free = free_of(places, points)
    spots: list[tuple[float, float]] = []
    for row_x, row_y, row_free in zip(x, y, free.reshape(x.shape), strict=True):
        last = -math.inf
        for at in row_x[row_free].tolist():
            if at - last >= diameter:
                spots.append((at, row_y[0].item()))
                last = at
    return np.array(spots).reshape(-1, 2)


def free_of(places: Places, points: Array) -> npt.NDArray[np.bool_]:
    """Where robots may start, shape (points,).

    Args:
        places: From `places_of`.
        points: Shape (points, 2), in the box from which places are drawn.
    """
    free = np.ones(len(points), dtype=np.bool_)
    if places.shapes is None:
        return free
    look_around(places.shapes, places.radius, np.ascontiguousarray(points), free)
    return free


def require_room(arena: Arena, radius: float, robots: int) -> Array:
    """The spots of an arena.

    Raises:
        GroundError: They are not enough.
    """
    spots = spots_of(arena, radius)
    if len(spots) < robots:
        raise GroundError(
            f"{robots} robots do not fit where they start, which has room for {len(spots)}"
        )
    return spots
