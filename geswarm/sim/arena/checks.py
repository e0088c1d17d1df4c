"""What an arena may be: each of its parts by itself, and all of them together."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from geswarm.sim import footbot
from geswarm.sim.arena.geometry import (
    corners,
    crosses_itself,
    distances,
    from_border,
    grid,
    overlap,
    signed_area,
)
from geswarm.sim.arena.model import (
    COLOURS,
    SIDES,
    ZONES,
    Arena,
    Band,
    Box,
    Disc,
    HalfPlane,
    Light,
    Polygon,
    normalised,
)
from geswarm.sim.parameter import Parameter, shown

Problem = tuple[tuple[str, ...], str]
"""The parts concerned (`patches 2`), the first one at fault, and what is wrong."""

MOST = {"corners": 64, "obstacles": 64, "patches": 32, "lights": 16, "areas": 6}
"""How many of each there may be."""

COORDINATE = Parameter(float, -1e4, 1e4, " m")
SIZE = Parameter(float, 0, 1e4, " m", above=True)
_LEAST_AREA = 1e-6
NUMBERS: dict[type, dict[str, Parameter]] = {
    Disc: {"x": COORDINATE, "y": COORDINATE, "radius": SIZE},
    Box: {
        "x": COORDINATE,
        "y": COORDINATE,
        "width": SIZE,
        "length": SIZE,
        "angle": Parameter(float, -3600, 3600, " degrees"),
    },
    Polygon: {},
    HalfPlane: {"at": COORDINATE},
    Band: {"depth": SIZE},
    Light: {
        "x": COORDINATE,
        "y": Parameter(float, -1e6, 1e6, " m"),
        "height": Parameter(float, 0, 1e4, " m"),
        "intensity": Parameter(float, 0, 1e6, above=True),
    },
}
"""What the numbers of each part of an arena may be."""

_AREA = re.compile(r"[a-z][a-z0-9_]{0,39}")


def area_problem(name: object) -> str | None:
    """Why something cannot be the name of an area, or None."""
    if isinstance(name, str) and _AREA.fullmatch(name):
        return None
    return f"expected a name of lower-case letters, digits and _, got {shown(name)}"


def choice_problem(value: object, known: tuple[str, ...]) -> str | None:
    """Why something is none of some names, or None."""
    if isinstance(value, str) and value in known:
        return None
    return f"expected {', '.join(known[:-1])} or {known[-1]}, got {shown(value)}"


def polygon_problem(points: object) -> str | None:
    """Why something cannot be the corners of a polygon, or None."""
    if not isinstance(points, list | tuple) or not 3 <= len(points) <= MOST["corners"]:
        given = len(points) if isinstance(points, list | tuple) else shown(points)
        return f"expected 3 to {MOST['corners']} corners, got {given}"
    for number, point in enumerate(points, start=1):
        if message := point_problem(point):
            return f"corner {number}: {message}"
    border = np.array(points, dtype=np.float64)
    if crosses_itself(border):
        return "expected sides that do not touch each other but at their ends"
    if abs(signed_area(border)) < _LEAST_AREA:
        return f"expected an area of at least {_LEAST_AREA:g} m2"
    return None


def point_problem(point: object) -> str | None:
    """Why something is no place, or None."""
    if not isinstance(point, list | tuple) or len(point) != 2:
        return f"expected a place [x, y], got {shown(point)}"
    return COORDINATE.problem(point[0]) or COORDINATE.problem(point[1])


def part_problem(part: object, kinds: tuple[type, ...]) -> str | None:
    """What is wrong with a shape or a light by itself, or None."""
    if type(part) not in kinds:
        return f"expected a {' or '.join(kind.__name__ for kind in kinds)}, got {shown(part)}"
    if isinstance(part, Polygon):
        return polygon_problem(part.points)
    if isinstance(part, HalfPlane | Band) and (message := choice_problem(part.side, SIDES)):
        return message
    for name, parameter in NUMBERS[type(part)].items():
        if message := parameter.problem(getattr(part, name)):
            return f"{name}: {message}"
    return None


_SHAPES = (Disc, Box, Polygon, HalfPlane, Band)


def problems(arena: object) -> Iterator[Problem]:
    """Everything wrong with an arena; whether its parts fit is seen once each is right."""
    if not isinstance(arena, Arena):
        yield ("arena",), f"expected an arena, got {shown(arena)}"
        return
    by_itself = list(_of_parts(arena))
    yield from by_itself or _of_all(normalised(arena))


def _of_parts(arena: Arena) -> Iterator[Problem]:
    if message := part_problem(arena.outline, (Box, Disc, Polygon)) or _off_centre(arena.outline):
        yield ("outline",), message
    if message := choice_problem(arena.floor, COLOURS):
        yield ("floor",), message
    if arena.start is not None and (message := part_problem(arena.start, _SHAPES)):
        yield ("start",), message
    for name, kinds in (("obstacles", (Box, Disc)), ("lights", (Light,))):
        for number, part in enumerate(getattr(arena, name), start=1):
            if message := part_problem(part, kinds):
                yield (f"{name} {number}",), message
    for number, patch in enumerate(arena.patches, start=1):
        message = part_problem(patch.shape, _SHAPES)
        message = message or (choice_problem(patch.floor, COLOURS) if patch.floor else None)
        message = message or (area_problem(patch.area) if patch.area else None)
        if not patch.floor and not patch.area:
            message = message or "expected a floor or an area"
        if message:
            yield (f"patches {number}",), message
    for name in ("obstacles", "patches", "lights", "areas"):
        count = len(getattr(arena, name))
        if count > MOST[name]:
            at = "patches" if name == "areas" else name
            yield (at,), f"expected at most {MOST[name]} {name}, got {count}"


def _off_centre(outline: Any) -> str | None:
    if isinstance(outline, Box | Disc):
        turned = isinstance(outline, Box) and outline.angle != 0
        if outline.x != 0 or outline.y != 0 or turned:
            return "expected an outline around the origin that is not turned"
    return None


def _of_all(arena: Arena) -> Iterator[Problem]:
    for number, obstacle in enumerate(arena.obstacles, start=1):
        if not overlap(arena.outline, obstacle):
            yield (f"obstacles {number}", "outline"), "lies outside the arena"
    for number, patch in enumerate(arena.patches, start=1):
        if not overlap(arena.outline, arena.resolved(patch.shape)):
            key = patch.area if patch.area in ZONES else f"patches {number}"
            yield (f"patches {number}", key, "outline"), "lies outside the arena"
    if arena.start is not None and not overlap(arena.outline, arena.resolved(arena.start)):
        yield ("start", "outline"), "lies outside the arena"


def room_at_start(arena: Arena, radius: float = footbot.RADIUS) -> int:
    """About how many robots have room side by side where they start, of an arena that is right.

    Centres lie in the region of start, bodies up to a radius beside it.
    """
    start = arena.resolved(arena.start or arena.outline)
    points, each = grid(start, arena.outline, radius)
    free = (distances(arena.outline, points) <= 0) & (distances(start, points) <= radius)
    for obstacle in arena.obstacles:
        free &= distances(obstacle, points) > 0
    return int(free.sum() * each / (2.0 * radius) ** 2)


def has_room_for_objects(arena: Arena, margin: float) -> bool:
    """Whether there is a place in the source that far from walls and obstacles (m)."""
    for shape in arena.area("source"):
        points, _ = grid(shape, arena.outline, 0.0)
        free = (distances(arena.outline, points) <= 0) & (distances(shape, points) <= 0)
        free &= from_border(corners(arena.outline), points) > margin
        for obstacle in arena.obstacles:
            free &= distances(obstacle, points) > margin
        if free.any():
            return True
    return False
