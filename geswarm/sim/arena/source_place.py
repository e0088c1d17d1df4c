"""Where objects lie: in the area `source`, where robots reach them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
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
from geswarm.sim.arena.model import Arena, Box, Disc, HalfPlane, Outline, Plain, Polygon
from geswarm.sim.arena.triangles import Triangles, common, pieces
from geswarm.sim.terms.ground import GroundError

_TRIFLE = 1e-9


@dataclass(frozen=True)
class SourcePlace:
    """Where objects lie: a box along the axes, a disc, a turned box, or triangles."""

    shape: Extent | Disc | Box | Triangles

    @property
    def extent(self) -> Extent:
        """The smallest box along the axes around it."""
        if isinstance(self.shape, Extent):
            return self.shape
        return self.shape.extent if isinstance(self.shape, Triangles) else extent_of(self.shape)


@lru_cache(maxsize=64)
def where_objects_lie(arena: Arena, margin: float) -> SourcePlace | None:
    """The part of the area `source` in which objects lie; None if there is no such area.

    In a box outline it is what of bands, boxes and polygons is far enough from the walls (of a
    single turned box only all of it), and so of a disc in the middle of a disc outline. Any other
    source must be far enough as a whole, and all that is left must be far enough from obstacles.

    Args:
        arena: The arena.
        margin: Least distance of objects from walls and obstacles (m).

    Raises:
        GroundError: Bands are not in a box, or one of several patches is a disc or overlaps
            another one; it reaches too far; or nothing is left of it.
    """
    shapes = arena.area("source")
    if not shapes:
        return None
    if not isinstance(arena.outline, Box) and any(isinstance(each, HalfPlane) for each in shapes):
        raise GroundError("source: a band is only for a rectangular arena: expected other shapes")
    shape = shapes[0]
    if len(shapes) > 1 or isinstance(shape, Polygon):
        place = SourcePlace(_cut(arena, shapes, margin))
    elif isinstance(arena.outline, Box) and not isinstance(shape, Disc) and not _is_turned(shape):
        extent = _in_box(arena, shape, margin, float)
        if extent.west >= extent.east or extent.south >= extent.north:
            raise _no_room(margin)
        place = SourcePlace(extent)
    else:
        assert not isinstance(shape, HalfPlane)
        place = SourcePlace(_far_from_outline(arena, shape, margin))
    _require_far_from_obstacles(arena, place, margin)
    return place


def _no_room(margin: float) -> GroundError:
    return GroundError(
        f"source: a margin of {margin:g} m from the walls leaves no room for objects"
    )


def _cut(arena: Arena, shapes: tuple[Plain, ...], margin: float) -> Triangles:
    """What of patches with straight sides is far enough from the outline."""
    patches: list[Triangles] = []
    for number, shape in enumerate(shapes, 1):
        if isinstance(shape, Disc):
            raise GroundError(
                "source: expected boxes, bands or polygons where it has several patches, "
                f"got a disc as number {number}"
            )
        patch = Triangles.of(_reached(arena.outline, shape, margin))
        for other, before in enumerate(patches, 1):
            if patch.share_area_with(before):
                raise GroundError(
                    "source: expected patches that do not overlap for objects to lie in, "
                    f"got numbers {other} and {number}"
                )
        patches.append(patch)
    found = Triangles(np.concatenate([patch.corners for patch in patches]))
    if not len(found.corners):
        raise _no_room(margin)
    return found


def _reached(outline: Outline, shape: Box | HalfPlane | Polygon, margin: float) -> list[Points]:
    """Convex pieces of what is far enough from a box; of any other outline all of it must be."""
    if not isinstance(outline, Box):
        assert not isinstance(shape, HalfPlane)
        _require_far_from_outline(outline, shape, margin)
        return pieces(shape)
    width, length = outline.width - 2.0 * margin, outline.length - 2.0 * margin
    inner = [corners(Box(0.0, 0.0, width, length))] if min(width, length) > 0.0 else []
    return common(shape, inner)


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
            raise _no_room(margin)
        return Disc(0.0, 0.0, radius)
    _require_far_from_outline(outline, shape, margin)
    straight = isinstance(shape, Box) and not _is_turned(shape)
    return extent_of(shape) if straight else shape


def _require_far_from_outline(outline: Outline, shape: Disc | Box | Polygon, margin: float) -> None:
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


def _require_far_from_obstacles(arena: Arena, place: SourcePlace, margin: float) -> None:
    for number, gap in enumerate(_gaps_to_obstacles(arena, place, margin), 1):
        if gap < margin - _TRIFLE:
            raise GroundError(
                f"source: expected it at least {margin:g} m from obstacles, where robots reach, "
                f"got {max(gap, 0.0):.3g} m from obstacle {number}"
            )


def _gaps_to_obstacles(arena: Arena, place: SourcePlace, margin: float) -> Iterator[float]:
    """How far each obstacle is away (m); infinity where it is beyond the margin at first sight."""
    shape = place.shape
    parts = (
        [(each, 0.0) for each in shape.corners]
        if isinstance(shape, Triangles)
        else [_rounded(shape)]
    )
    low = np.array([own.min(axis=0) - around for own, around in parts])
    high = np.array([own.max(axis=0) + around for own, around in parts])
    for obstacle in arena.obstacles:
        that, reach = _rounded(obstacle)
        apart = np.maximum(low - that.max(axis=0), that.min(axis=0) - high).max(axis=1) - reach
        near = [parts[k] for k in np.flatnonzero(apart < margin)]
        gaps = (_gap(own, that) - around - reach for own, around in near)
        yield min(gaps, default=math.inf)


def _gap(one: Points, other: Points) -> float:
    """How far apart two polygons or points are (m); less than any number if one holds the other."""
    apart = not is_within(one, other[:1])[0] and not is_within(other, one[:1])[0]
    return between(one, other) if apart else -math.inf


def _rounded(shape: Extent | Disc | Box | Polygon) -> tuple[Points, float]:
    """A shape as a point or polygon and how far it reaches around that."""
    if isinstance(shape, Disc):
        return np.array([(shape.x, shape.y)]), shape.radius
    if isinstance(shape, Box | Polygon):
        return corners(shape), 0.0
    west, south, east, north = shape
    return np.array([(west, south), (east, south), (east, north), (west, north)]), 0.0
