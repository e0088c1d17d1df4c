"""Plane geometry of an arena's shapes, in double precision and plain Python; metres."""

from __future__ import annotations

import math
from itertools import product
from typing import NamedTuple

from geswarm.sim.arena.model import Box, Disc, HalfPlane, Point, Polygon


class Extent(NamedTuple):
    """A box along the axes."""

    west: float
    south: float
    east: float
    north: float

    @property
    def is_empty(self) -> bool:
        """Whether nothing is in it; a line or a point is not empty."""
        return self.east < self.west or self.north < self.south

    def intersection(self, other: Extent) -> Extent:
        """What is in both."""
        return Extent(
            max(self.west, other.west),
            max(self.south, other.south),
            min(self.east, other.east),
            min(self.north, other.north),
        )


def around_origin(half_width: float, half_length: float) -> Extent:
    """The box of these half sides around the origin."""
    return Extent(-half_width, -half_length, half_width, half_length)


def turn_of(box: Box) -> tuple[float, float]:
    """Cosine and sine of a box's angle."""
    angle = math.radians(box.angle)
    return math.cos(angle), math.sin(angle)


def corners_of(box: Box) -> tuple[Point, ...]:
    """The corners of a box, counter-clockwise."""
    cos, sin = turn_of(box)
    half_width, half_length = box.width / 2.0, box.length / 2.0
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    sides = [(i * half_width, j * half_length) for i, j in signs]
    return tuple((box.x + a * cos - b * sin, box.y + b * cos + a * sin) for a, b in sides)


def extent_of(shape: Disc | Box | Polygon | HalfPlane) -> Extent:
    """The smallest box along the axes around a shape."""
    if isinstance(shape, HalfPlane):
        far = math.inf
        return Extent(
            shape.at if shape.side == "east" else -far,
            shape.at if shape.side == "north" else -far,
            shape.at if shape.side == "west" else far,
            shape.at if shape.side == "south" else far,
        )
    if isinstance(shape, Disc):
        r = shape.radius
        return Extent(shape.x - r, shape.y - r, shape.x + r, shape.y + r)
    if isinstance(shape, Box) and not shape.angle % 180.0:
        half_width, half_length = shape.width / 2.0, shape.length / 2.0
        x, y = shape.x, shape.y
        return Extent(x - half_width, y - half_length, x + half_width, y + half_length)
    xs, ys = zip(*(shape.points if isinstance(shape, Polygon) else corners_of(shape)), strict=True)
    return Extent(min(xs), min(ys), max(xs), max(ys))


def is_inside(points: tuple[Point, ...], x: float, y: float) -> bool:
    """Whether a place is inside a polygon."""
    inside = False
    for k, (to_x, to_y) in enumerate(points):
        from_x, from_y = points[k - 1]
        if (from_y > y) != (to_y > y):
            inside ^= x < from_x + (to_x - from_x) * (y - from_y) / (to_y - from_y)
    return inside


def to_side(one: Point, other: Point, x: float, y: float) -> float:
    """Distance of a place from a line between two points."""
    along_x, along_y = other[0] - one[0], other[1] - one[1]
    dx, dy = x - one[0], y - one[1]
    share = (dx * along_x + dy * along_y) / (along_x * along_x + along_y * along_y)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(dx - share * along_x, dy - share * along_y)


def to_edge(points: tuple[Point, ...], x: float, y: float) -> float:
    """Distance of a place from the edge of a polygon, from within or without."""
    return min(to_side(points[k - 1], points[k], x, y) for k in range(len(points)))


def between_edges(one: tuple[Point, ...], other: tuple[Point, ...]) -> float:
    """Least distance between the edges of two polygons; 0 if they cross."""
    for i, j in product(range(len(one)), range(len(other))):
        if _cross(one[i - 1], one[i], other[j - 1], other[j]):
            return 0.0
    mine = min(to_edge(other, *point) for point in one)
    return min(mine, min(to_edge(one, *point) for point in other))


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    return _side(a, b, c) != _side(a, b, d) and _side(c, d, a) != _side(c, d, b)


def _side(a: Point, b: Point, c: Point) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])
