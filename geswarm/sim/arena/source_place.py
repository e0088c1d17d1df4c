"""Where objects lie: in the area `source`, where robots reach them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from geswarm.sim.arena.geometry import (
    Extent,
    Points,
    around_origin,
    between,
    corners,
    extent_of,
    is_within,
)
from geswarm.sim.arena.model import Arena, Box, Disc, HalfPlane, Polygon
from geswarm.sim.terms.ground import GroundError

_TRIFLE = 1e-9


@dataclass(frozen=True)
class SourcePlace:
    """Where objects lie: a box along the axes, a disc, or a turned box."""

    shape: Extent | Disc | Box

    @property
    def extent(self) -> Extent:
        """The smallest box along the axes around it."""
        return self.shape if isinstance(self.shape, Extent) else extent_of(self.shape)


def where_objects_lie(arena: Arena, margin: float) -> SourcePlace | None:
    """The part of the area `source` in which objects lie; None if there is no such area.

    Of a box or a half-plane in a box outline, and of a disc in the middle of a disc outline, it is
    what is far enough from the walls; any other source must be it as a whole.

    Args:
        arena: The arena.
        margin: Least distance of objects from walls and obstacles (m).

    Raises:
        GroundError: It is something else than one disc, box or, in a box, band; it reaches too far;
            or nothing is left of it.
    """
    shapes = arena.area("source")
    if not shapes:
        return None
    shape = shapes[0]
    if len(shapes) > 1 or not isinstance(shape, Disc | Box | HalfPlane):
        found = "several patches" if len(shapes) > 1 else "a polygon"
        raise GroundError(f"source: expected one band, box or disc for objects to lie in: {found}")
    if isinstance(arena.outline, Box) and not isinstance(shape, Disc) and not _is_turned(shape):
        extent = _in_box(arena, shape, margin, float)
        if extent.west >= extent.east or extent.south >= extent.north:
            raise GroundError(
                f"source: a margin of {margin:g} m from the walls leaves no room for objects"
            )
        place = SourcePlace(extent)
    elif isinstance(shape, HalfPlane):
        raise GroundError("source: a band is only for a rectangular arena: expected a box or disc")
    else:
        place = SourcePlace(_far_from_outline(arena, shape, margin))
    _require_far_from_obstacles(arena, place, margin)
    return place


def in_single(arena: Arena, margin: float) -> Extent:
    """Where objects lie, if it is a box along the axes; all of it in single precision."""
    (shape,) = arena.area("source")
    if isinstance(arena.outline, Box):
        return _in_box(arena, shape, margin, np.float32)
    return Extent(*map(float, map(np.float32, extent_of(_resolved(shape)))))


def box_numbers(extent: Extent) -> dict[str, float]:
    """A box as places in it are drawn: its middle along x, half of its width, south, depth."""
    west, south, east, north = extent
    middle, half = (east + west) / 2.0, (east - west) / 2.0
    numbers = {"x": middle, "half_width": half, "south": south, "depth": north - south}
    return {name: float(value) for name, value in numbers.items()}


def _resolved(shape: Any) -> Disc | Box | Polygon | HalfPlane:
    assert isinstance(shape, Disc | Box | Polygon | HalfPlane)
    return shape


def _is_turned(shape: Box | HalfPlane) -> bool:
    return isinstance(shape, Box) and bool(shape.angle % 180.0)


def _in_box(arena: Arena, shape: Any, margin: float, kind: type) -> Extent:
    """What of a shape along the axes is far enough from the walls of a box outline.

    All of it is worked out in one precision, `kind`.
    """
    reach_x = kind(arena.half_width) - kind(margin)
    reach_y = kind(arena.half_length) - kind(margin)
    own = Extent(*map(kind, extent_of(_resolved(shape))))
    return own.intersection(around_origin(reach_x, reach_y))


def _far_from_outline(arena: Arena, shape: Disc | Box, margin: float) -> Extent | Disc | Box:
    """The shape, which must be far enough from the outline."""
    outline = arena.outline
    if isinstance(outline, Disc) and isinstance(shape, Disc) and (shape.x, shape.y) == (0.0, 0.0):
        radius = min(shape.radius, outline.radius - margin)
        if radius <= 0.0:
            raise GroundError(
                f"source: a margin of {margin:g} m from the wall leaves no room for objects"
            )
        return Disc(0.0, 0.0, radius)
    points, own = _rounded(shape)
    if isinstance(outline, Disc):
        gap = outline.radius - float(np.hypot(*points.T).max())
    else:
        walls = corners(outline)
        gap = between(points, walls) if is_within(walls, points[:1])[0] else -math.inf
    if gap - own < margin - _TRIFLE:
        raise GroundError(
            f"source: expected all of it at least {margin:g} m from the walls, where robots reach"
        )
    straight = isinstance(shape, Box) and not _is_turned(shape)
    return extent_of(shape) if straight else shape


def _require_far_from_obstacles(arena: Arena, place: SourcePlace, margin: float) -> None:
    for number, gap in enumerate(_gaps_to_obstacles(arena, place), 1):
        if gap < margin - _TRIFLE:
            raise GroundError(
                f"source: expected it at least {margin:g} m from obstacles, where robots reach, "
                f"got {max(gap, 0.0):.3g} m from obstacle {number}"
            )


def _gaps_to_obstacles(arena: Arena, place: SourcePlace) -> Iterator[float]:
    for obstacle in arena.obstacles:
        (own, around), (that, reach) = _rounded(place.shape), _rounded(obstacle)
        apart = not is_within(own, that[:1])[0] and not is_within(that, own[:1])[0]
        yield between(own, that) - around - reach if apart else -math.inf


def _rounded(shape: Extent | Disc | Box) -> tuple[Points, float]:
    """A shape as a point or polygon and how far it reaches around that."""
    if isinstance(shape, Disc):
        return np.array([(shape.x, shape.y)]), shape.radius
    if isinstance(shape, Box):
        return corners(shape), 0.0
    west, south, east, north = shape
    return np.array([(west, south), (east, south), (east, north), (west, north)]), 0.0
