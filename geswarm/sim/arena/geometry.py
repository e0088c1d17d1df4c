"""Plane geometry of an arena's shapes: extents, corners, what they have in common, distances.

Points are float64 of shape (n, 2), in metres. For checks, not for the kernels: discs are polygons
of many corners where they are compared with others.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.model import Box, Disc, HalfPlane, Plain, Polygon

Points = npt.NDArray[np.float64]

_CORNERS_OF_A_DISC = 64
_FAR = 1e5
"""Half-planes end so far away (m)."""
_GRID = 32
"""Points along each side of a grid."""


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


def extent_of(shape: Plain) -> Extent:
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
    points = corners(shape)
    return Extent(*points.min(axis=0).tolist(), *points.max(axis=0).tolist())


def corners(shape: Plain) -> Points:
    """The corners of a shape, counter-clockwise unless it is a polygon that is not."""
    if isinstance(shape, Polygon):
        return np.array(shape.points, dtype=np.float64)
    if isinstance(shape, Disc):
        angles = np.arange(_CORNERS_OF_A_DISC) * (2.0 * math.pi / _CORNERS_OF_A_DISC)
        circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return circle * shape.radius + (shape.x, shape.y)
    unit = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    if isinstance(shape, Box):
        cos, sin = turn_of(shape)
        rotation: Points = np.array([(cos, sin), (-sin, cos)])
        return unit * (shape.width / 2.0, shape.length / 2.0) @ rotation + (shape.x, shape.y)
    along = 1 if shape.side in ("south", "north") else 0
    found = unit * _FAR
    cut = found[:, along] < 0 if shape.side in ("north", "east") else found[:, along] > 0
    found[cut, along] = shape.at
    return found


def signed_area(points: Points) -> float:
    """Area within a closed line (m2); negative if it goes clockwise."""
    moved = points - points[0]
    following = np.roll(moved, -1, axis=0)
    crossed = moved[:, 0] * following[:, 1] - moved[:, 1] * following[:, 0]
    return float(crossed.sum()) / 2.0


def crosses_itself(points: Points) -> bool:
    """Whether sides of a closed line that are no neighbours meet, or neighbours turn back."""
    count = len(points)
    meet = _meeting(points, points)
    beside = np.arange(count)
    for step in (-1, 0, 1):
        meet[beside, (beside + step) % count] = False
    before, after = np.roll(points, 1, axis=0) - points, np.roll(points, -1, axis=0) - points
    straight = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] == 0.0
    back = straight & ((before * after).sum(axis=1) >= 0.0)
    return bool(meet.any() or back.any())


def overlap(one: Plain, other: Plain) -> bool:
    """Whether two shapes have points in common, their borders included."""
    first, second = corners(one), corners(other)
    return bool(
        _meeting(first, second).any()
        or (distances(one, second[:1]) <= 0.0).any()
        or (distances(other, first[:1]) <= 0.0).any()
    )


def distances(shape: Plain, points: Points) -> npt.NDArray[np.float64]:
    """How far points are from a shape (m); 0 within it."""
    x, y = points[:, 0], points[:, 1]
    if isinstance(shape, Disc):
        return np.maximum(np.hypot(x - shape.x, y - shape.y) - shape.radius, 0.0)
    if isinstance(shape, HalfPlane):
        along = y if shape.side in ("south", "north") else x
        sign = 1.0 if shape.side in ("north", "east") else -1.0
        return np.maximum(sign * (shape.at - along), 0.0)
    border = corners(shape)
    return np.where(is_within(border, points), 0.0, from_border(border, points))


def from_border(border: Points, points: Points) -> npt.NDArray[np.float64]:
    """How far points are from a closed line (m)."""
    least = np.full(len(points), np.inf)
    for away in _from_sides(border, points):
        least = np.minimum(least, np.hypot(*away.T))
    return least


def nearest_on(border: Points, points: Points) -> Points:
    """The places on a closed line that are nearest to points, shape (points, 2)."""
    away = np.stack(list(_from_sides(border, points)))
    nearest = np.hypot(away[..., 0], away[..., 1]).argmin(axis=0)
    found: Points = points - away[nearest, np.arange(len(points))]
    return found


def _from_sides(border: Points, points: Points) -> Iterator[Points]:
    """The ways to points from the nearest place of each side of a closed line."""
    for start, end in zip(border, np.roll(border, -1, axis=0), strict=True):
        side, offsets = end - start, points - start
        length = max(float(side @ side), np.finfo(np.float64).tiny)
        part = np.clip(offsets @ side / length, 0.0, 1.0)
        yield offsets - part[:, np.newaxis] * side


def between(one: Points, other: Points) -> float:
    """Least distance between two closed lines, or points (m); 0 if they cross."""
    if _meeting(one, other).any():
        return 0.0
    return float(min(from_border(one, other).min(), from_border(other, one).min()))


def grid(shape: Plain, within: Plain, margin: float) -> tuple[Points, float]:
    """Points all over a shape and `margin` around it, as far as another one extends.

    Returns:
        The points, and the area that each stands for (m2).
    """
    own, other = corners(shape), corners(within)
    low = np.maximum(own.min(axis=0) - margin, other.min(axis=0))
    high = np.minimum(own.max(axis=0) + margin, other.max(axis=0))
    size = np.maximum(high - low, 0.0)
    steps = (np.arange(_GRID) + 0.5) / _GRID
    x, y = np.meshgrid(low[0] + steps * size[0], low[1] + steps * size[1])
    return np.stack([x.ravel(), y.ravel()], axis=1), float(size[0] * size[1]) / _GRID**2


def is_within(border: Points, points: Points) -> npt.NDArray[np.bool_]:
    """Whether points are within a closed line that does not cross itself."""
    inside = np.zeros(len(points), dtype=np.bool_)
    x, y = points[:, 0], points[:, 1]
    for (x0, y0), (x1, y1) in zip(border, np.roll(border, -1, axis=0), strict=True):
        if y0 != y1:
            spans = (y0 > y) != (y1 > y)
            inside ^= spans & (x < x0 + (y - y0) * ((x1 - x0) / (y1 - y0)))
    return inside


def _meeting(one: Points, other: Points) -> npt.NDArray[np.bool_]:
    """Whether side i of one closed line meets side j of another one, shape (sides, sides)."""
    a, b = one[:, np.newaxis], np.roll(one, -1, axis=0)[:, np.newaxis]
    c, d = other[np.newaxis], np.roll(other, -1, axis=0)[np.newaxis]
    boxes = (np.minimum(a, b) <= np.maximum(c, d)) & (np.minimum(c, d) <= np.maximum(a, b))
    parted = (_turn(a, b, c) * _turn(a, b, d) <= 0) & (_turn(c, d, a) * _turn(c, d, b) <= 0)
    found: npt.NDArray[np.bool_] = boxes.all(axis=2) & parted
    return found


def _turn(a: Points, b: Points, c: Points) -> npt.NDArray[np.float64]:
    """Whether a, b, c turn left (1), right (-1) or lie on a line (0)."""
    u, v = b - a, c - a
    return np.sign(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
