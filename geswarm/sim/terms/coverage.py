"""How well robots cover the ground at the end, of all their places."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import Points, corners, distances, extent_of, from_border
from geswarm.sim.arena.model import Arena, HalfPlane, Plain
from geswarm.sim.terms.component import Places
from geswarm.sim.terms.declare import places_measure

_SPACING = 0.02
"""Between the points of a grid (m)."""
_COVERS, _LINKS = 0.25, 0.35
"""How far a robot covers the ground, and reaches others (m)."""
_BODY = 0.04
"""Half of the width of a robot that is on a line (m)."""
_FAR = 2.5
"""Distance to robots where there are none (m)."""


@lru_cache(maxsize=64)
def _surface(shape: Plain) -> Points:
    """Points all over a shape, `_SPACING` apart, shape (points, 2)."""
    west, south, east, north = extent_of(shape)
    x, y = np.meshgrid(_between(west, east), _between(south, north))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    return points[distances(shape, points) <= 0.0]


def _between(low: float, high: float) -> Points:
    count = math.ceil((high - low) / _SPACING)
    return low + (np.arange(count) + 0.5) * (high - low) / count


@lru_cache(maxsize=64)
def _perimeter(shape: Plain) -> Points:
    """Points all around a shape, about `_SPACING` apart, shape (points, 2)."""
    border = corners(shape)
    sides = []
    for start, end in zip(border, np.roll(border, -1, axis=0), strict=True):
        count = math.ceil(math.dist(start, end) / _SPACING)
        parts = (np.arange(count) + 0.5) / count
        sides.append(start + parts[:, np.newaxis] * (end - start))
    return np.concatenate(sides)


def _only(arena: Arena, area: str) -> Plain:
    """The shape of an area of one patch.

    Raises:
        ValueError: It has several, or is a half-plane.
    """
    shapes = arena.area(area)
    if len(shapes) != 1 or isinstance(shapes[0], HalfPlane):
        kinds = ", ".join(type(each).__name__ for each in shapes)
        raise ValueError(f"area {area}: expected one disc, box or polygon, got {kinds}")
    return shapes[0]


def _across(shape: Plain) -> float:
    """How far the points of a shape are apart at most (m)."""
    border = corners(shape)
    return float(np.hypot(*(border[:, np.newaxis] - border).T).max())


def _mean_distance(points: Points, x: Places, y: Places, counts: Places, most: float) -> Places:
    """Mean distance of points to the nearest robot of those that count, each at most `most` (m).

    Args:
        points: Shape (points, 2).
        x: Of robots (m), shape (robots, simulations), and so y, counts.
        y: See x.
        counts: Whether a robot counts.
        most: What the distance is without robots.

    Returns:
        Shape (simulations,).
    """
    nearest = np.full((len(points), x.shape[1]), most * most)
    for robot, _ in enumerate(x):
        dx, dy = points[:, :1] - x[robot], points[:, 1:] - y[robot]
        np.minimum(nearest, dx * dx + dy * dy, out=nearest, where=counts[robot])
    mean: Places = np.sqrt(nearest).mean(axis=0)
    return mean


def _within(shapes: tuple[Plain, ...], x: Places, y: Places) -> npt.NDArray[np.bool_]:
    """Whether robots are on some of the shapes, shape (robots, simulations)."""
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    on = [distances(shape, points) <= 0.0 for shape in shapes]
    return np.any(on, axis=0).reshape(x.shape) if on else np.zeros(x.shape, dtype=np.bool_)


@places_measure(unit="m", areas=("forbidden",))
def distance_to_robots(x: Places, y: Places, arena: Arena) -> Places:
    """At the end: mean distance of the arena's points to the nearest robot not on forbidden."""
    counts = ~_within(arena.area("forbidden"), x, y)
    return _mean_distance(_surface(arena.resolved(arena.outline)), x, y, counts, _FAR)


@places_measure(unit="m", areas=("surface",))
def distance_on_surface(x: Places, y: Places, arena: Arena) -> Places:
    """At the end: mean distance of the area surface's points to the nearest robot on it."""
    shape = _only(arena, "surface")
    return _mean_distance(_surface(shape), x, y, _within((shape,), x, y), _across(shape))


@places_measure(unit="m", areas=("perimeter",))
def distance_on_perimeter(x: Places, y: Places, arena: Arena) -> Places:
    """At the end: mean distance of points around the area perimeter to the nearest robot there."""
    shape = _only(arena, "perimeter")
    robots = np.stack([x.ravel(), y.ravel()], axis=1)
    counts = (from_border(corners(shape), robots) <= _BODY).reshape(x.shape)
    return _mean_distance(_perimeter(shape), x, y, counts, _across(shape))


@places_measure(unit="m2")
def covered(x: Places, y: Places, arena: Arena) -> Places:
    """At the end: ground within 0.25 m of the largest group of robots, linked within 0.35 m."""
    shape = arena.resolved(arena.outline)
    points = _surface(shape)
    inside = _in_the_largest_group(x, y)
    reached = np.zeros((len(points), x.shape[1]), dtype=np.bool_)
    for robot, members in enumerate(inside):
        dx, dy = points[:, :1] - x[robot], points[:, 1:] - y[robot]
        reached |= (dx * dx + dy * dy <= _COVERS * _COVERS) & members
    west, south, east, north = extent_of(shape)
    each = (east - west) / len(_between(west, east)) * (north - south)
    area: Places = reached.sum(axis=0) * each / len(_between(south, north))
    return area


def _in_the_largest_group(x: Places, y: Places) -> npt.NDArray[np.bool_]:
    """Whether robots are in the group of most robots, the first of equals, as for `_within`."""
    dx, dy = (each.T[:, :, np.newaxis] - each.T[:, np.newaxis] for each in (x, y))
    linked = (dx * dx + dy * dy < _LINKS * _LINKS).astype(np.float32)
    for _ in range(math.ceil(math.log2(len(x) + 1))):  # twice as many links each time
        linked = np.minimum(linked @ linked, np.float32(1.0))
    largest = linked.sum(axis=1).argmax(axis=1)
    found: npt.NDArray[np.bool_] = linked[np.arange(len(largest)), largest].T > 0.0
    return found
