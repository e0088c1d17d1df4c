"""An arena as the numbers that assembled kernels name."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from geswarm.sim.arena.geometry import Extent, turn_of
from geswarm.sim.arena.model import Arena, Box, Disc, HalfPlane, Polygon
from geswarm.sim.arena.source_place import box_numbers, in_single, where_objects_lie
from geswarm.sim.arena.triangles import Triangles

_SLACK = 1e-3
"""By which share of its radius a body may be pressed into a wall."""
_GREY = {"black": 0.0, "white": 1.0}
"""How bright a floor is, where it is not grey."""
_ROUNDING = 4.0 * 2.0**-24
"""Of a coordinate in single precision, relative to it."""


def ground_numbers(arena: Arena, radius: float) -> dict[str, float]:
    """The numbers that the source made of an arena's form names; metres.

    Args:
        arena: Of a form that `Ground.of` takes.
        radius: Of a robot (m).
    """
    extent = max(arena.half_width, arena.half_length)
    numbers = {
        "half_width": arena.half_width,
        "half_length": arena.half_length,
        "clearance": radius - max(_SLACK * radius, _ROUNDING * extent),
    }
    if isinstance(arena.outline, Disc):
        numbers["arena_radius"] = arena.outline.radius
    if isinstance(arena.outline, Polygon):
        for k, wall in enumerate(walls(arena.outline)):
            numbers |= {f"wall{k}_{name}": value for name, value in wall._asdict().items()}
    for k, obstacle in enumerate(arena.obstacles):
        numbers |= _named(f"obstacle{k}", obstacle)
    numbers["floor_grey"] = _GREY.get(arena.floor, 0.498)
    for k, patch in enumerate(arena.patches):
        numbers |= _named(f"patch{k}", arena.resolved(patch.shape))
        numbers[f"patch{k}_grey"] = _GREY.get(patch.floor, 0.498)
    for k, light in enumerate(arena.lights):
        x, y = arena.place_of(light)
        place = {"x": x, "y": y, "height": light.height, "intensity": light.intensity}
        numbers |= {f"light{k}_{name}": value for name, value in place.items()}
    return numbers


class Wall(NamedTuple):
    """A side of a polygon: where it begins, its direction with inside to the left, its length."""

    x: float
    y: float
    along_x: float
    along_y: float
    length: float


def walls(polygon: Polygon) -> Iterator[Wall]:
    """The sides of a polygon, that from the first corner to the second first."""
    points = polygon.points
    for k, (x, y) in enumerate(points):
        to_x, to_y = points[(k + 1) % len(points)]
        length = math.hypot(to_x - x, to_y - y)
        yield Wall(x, y, (to_x - x) / length, (to_y - y) / length, length)


def _named(prefix: str, shape: Disc | Box | Polygon | HalfPlane) -> dict[str, float]:
    return {f"{prefix}_{name}": value for name, value in _of_shape(shape).items()}


def _of_shape(shape: Disc | Box | Polygon | HalfPlane) -> dict[str, float]:
    if isinstance(shape, HalfPlane):
        return {"edge": shape.at}
    if isinstance(shape, Disc):
        return {"x": shape.x, "y": shape.y, "radius": shape.radius}
    if isinstance(shape, Polygon):
        return _of_polygon(shape)
    cos, sin = turn_of(shape)
    place = {"x": shape.x, "y": shape.y}
    half = {"half_width": shape.width / 2.0, "half_length": shape.length / 2.0}
    return {**place, **half, "cos": cos, "sin": sin}


def _of_polygon(shape: Polygon) -> dict[str, float]:
    numbers: dict[str, float] = {}
    for k, (x, y) in enumerate(shape.points):
        to_x, to_y = shape.points[(k + 1) % len(shape.points)]
        slope = (to_x - x) / (to_y - y) if to_y != y else 0.0
        numbers |= {f"x{k}": x, f"y{k}": y, f"slope{k}": slope}
    return numbers


def object_numbers(arena: Arena, margin: float) -> dict[str, float]:
    """The numbers of where objects lie; none if there is no source.

    Args:
        arena: The arena.
        margin: Least distance of objects from walls and obstacles (m).

    Raises:
        GroundError: Objects cannot be placed in the area `source`.
    """
    place = where_objects_lie(arena, margin)
    if place is None:
        return {}
    numbers = {f"objects_{side}": at for side, at in place.extent._asdict().items()}
    if isinstance(place.shape, Triangles):  # whose number the form does not know
        return numbers
    if isinstance(place.shape, Extent):
        box = box_numbers(in_single(arena, margin))
        return numbers | {f"object_{name}": value for name, value in box.items()}
    return numbers | _named("object", place.shape)


def triangle_numbers(arena: Arena, margin: float) -> list[float]:
    """Where objects lie in triangles, as `kernels.geometry.place_in_triangles` takes it.

    Args:
        arena: The arena.
        margin: Least distance of objects from walls and obstacles (m).

    Returns:
        The numbers of one triangle after the other, then how many triangles; none if objects lie
        in something else.

    Raises:
        GroundError: Objects cannot be placed in the area `source`.
    """
    place = where_objects_lie(arena, margin)
    if place is None or not isinstance(place.shape, Triangles):
        return []
    rows = place.shape.rows
    return [*rows.ravel().tolist(), float(len(rows))]
