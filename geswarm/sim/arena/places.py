"""Where something is put by hand: robots clear of walls and obstacles, objects in the source."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import Extent, distances, turn_of
from geswarm.sim.arena.model import Arena, Box, Disc, Point
from geswarm.sim.arena.source_place import where_objects_lie
from geswarm.sim.arena.start_places import free_of, places_of
from geswarm.sim.arena.triangles import Triangles
from geswarm.sim.scenario.checks import objects_from_walls
from geswarm.sim.scenario.model import Scenario

_STOPS = 512
"""Places between the one asked for and that where the robot is, the last of which is free."""


def nearest_free(arena: Arena, wanted: Point, now: Point, radius: float) -> Point:
    """A place for a robot: that asked for, or as far on the way there as walls allow.

    In a rectangle without obstacles it is the nearest one inside the walls.
    """
    reach_x, reach_y = (half - radius for half in (arena.half_width, arena.half_length))
    inside = (
        min(max(wanted[0], -reach_x), reach_x),
        min(max(wanted[1], -reach_y), reach_y),
    )
    if isinstance(arena.outline, Box) and not arena.obstacles:
        return inside
    points = np.linspace(inside, now, _STOPS)
    free = free_of(places_of(replace(arena, start=None), radius), points)
    x, y = points[free.argmax()] if free.any() else now
    return float(x), float(y)


def nearest_in_source(scenario: Scenario, wanted: Point) -> Point:
    """The nearest place where objects may lie."""
    margin = objects_from_walls(scenario.object_margin, scenario.grip_reach, scenario.robot.radius)
    place = where_objects_lie(scenario.arena, margin)
    assert place is not None, "there are no objects without a source"
    shape, (x, y) = place.shape, wanted
    if isinstance(shape, Triangles):
        return shape.nearest(wanted)
    if isinstance(shape, Extent):
        return min(max(x, shape.west), shape.east), min(max(y, shape.south), shape.north)
    if isinstance(shape, Disc):
        away = np.hypot(x - shape.x, y - shape.y)
        share = min(1.0, shape.radius / away) if away else 0.0
        return shape.x + share * (x - shape.x), shape.y + share * (y - shape.y)
    cos, sin = turn_of(shape)
    dx, dy = x - shape.x, y - shape.y
    along = min(max(cos * dx + sin * dy, -shape.width / 2.0), shape.width / 2.0)
    across = min(max(cos * dy - sin * dx, -shape.length / 2.0), shape.length / 2.0)
    return shape.x + cos * along - sin * across, shape.y + sin * along + cos * across


def is_in_area(
    arena: Arena, name: str, x: npt.NDArray[np.float32], y: npt.NDArray[np.float32]
) -> npt.NDArray[np.bool_]:
    """Which points are in an area; shape that of x and y."""
    points = np.column_stack((x, y)).astype(np.float64)
    inside = [distances(shape, points) <= 0.0 for shape in arena.area(name)]
    return np.asarray(np.any(inside, axis=0))
