"""Arenas: outline, obstacles, patches of floor, lights, where robots start and objects lie.

Lengths are in metres, x points east, y north; the outline lies around the origin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, Literal, TypeAlias, TypeVar

Point: TypeAlias = tuple[float, float]
Side: TypeAlias = Literal["south", "north", "west", "east"]

SIDES: tuple[Side, ...] = ("south", "north", "west", "east")
COLOURS = ("grey", "black", "white", "red", "green", "blue", "yellow")
"""What a floor may be."""
ZONES: dict[str, Side] = {"nest": "south", "source": "north"}
"""Areas whose depth is a number of a scenario, where they are bands along one side."""


@dataclass(frozen=True)
class Disc:
    """All points within `radius` of (x, y)."""

    x: float
    y: float
    radius: float


@dataclass(frozen=True)
class Box:
    """A rectangle around (x, y): `width` along x, `length` along y, turned by `angle` (degrees)."""

    x: float
    y: float
    width: float
    length: float
    angle: float = 0.0


@dataclass(frozen=True)
class Polygon:
    """A simple polygon; its corners counter-clockwise, the first one not repeated."""

    points: tuple[Point, ...]


@dataclass(frozen=True)
class HalfPlane:
    """All points on one side of a line: south of y = `at`, or east of x = `at`, and so on."""

    side: Side
    at: float


@dataclass(frozen=True)
class Band:
    """All points no further than `depth` from one side of the arena's extent."""

    side: Side
    depth: float


Plain: TypeAlias = Disc | Box | Polygon | HalfPlane
"""A shape that does not depend on the arena's extent."""
Shape: TypeAlias = Plain | Band
Outline: TypeAlias = Disc | Box | Polygon
Obstacle: TypeAlias = Disc | Box


@dataclass(frozen=True)
class Patch:
    """A part of the floor.

    Attributes:
        shape: Where; what is outside the outline does not matter.
        floor: Its colour; empty for that of what is below it.
        area: The name of the area that it belongs to (`nest`), or empty; patches of one name are
            one area.
    """

    shape: Shape
    floor: str = ""
    area: str = ""


@dataclass(frozen=True)
class Light:
    """A lamp.

    Attributes:
        x: Where (m).
        y: Where (m); if `beyond` is set, the distance from the northern side, northwards.
        height: Above the floor (m).
        intensity: As ARGoS counts it; 1 is a plain lamp.
        beyond: Whether `y` counts from the arena's northern side.
    """

    x: float = 0.0
    y: float = 0.0
    height: float = 0.0
    intensity: float = 1.0
    beyond: bool = False


@dataclass(frozen=True)
class Arena:
    """Where an experiment takes place.

    Attributes:
        outline: The walls around it: a box that is not turned and lies around the origin, a disc
            around the origin, or a polygon.
        obstacles: What stands inside; robots do not get through, nor do objects lie there.
        patches: Of the floor; later ones lie on top.
        lights: Lamps.
        start: Where robots start; None for everywhere.
        floor: Colour of the floor beside the patches.
    """

    outline: Outline
    obstacles: tuple[Obstacle, ...] = ()
    patches: tuple[Patch, ...] = ()
    lights: tuple[Light, ...] = ()
    start: Shape | None = None
    floor: str = "grey"

    @property
    def half_width(self) -> float:
        """Greatest distance of a point of the outline from the origin, along x."""
        return max(abs(x) for x, _ in _corners(self.outline))

    @property
    def half_length(self) -> float:
        """Greatest distance of a point of the outline from the origin, along y."""
        return max(abs(y) for _, y in _corners(self.outline))

    @property
    def areas(self) -> tuple[str, ...]:
        """The names of the areas, in the order of their first patches."""
        return tuple(dict.fromkeys(patch.area for patch in self.patches if patch.area))

    @property
    def colours(self) -> tuple[str, ...]:
        """The colours of the floor, that beside the patches first."""
        return tuple(dict.fromkeys((self.floor, *(p.floor for p in self.patches if p.floor))))

    @property
    def banded(self) -> bool:
        """Whether it is a rectangle with nothing in it but bands, as that of the paper."""
        shapes = [patch.shape for patch in self.patches]
        if self.start is not None:
            shapes.append(self.start)
        plain = isinstance(self.outline, Box) and not self.obstacles
        return plain and all(isinstance(shape, Band) for shape in shapes)

    def zone(self, name: str) -> Band | None:
        """The band along the side that `ZONES` names which is the area of a name, if there is."""
        for patch in self.patches:
            shape = patch.shape
            if patch.area == name and isinstance(shape, Band) and shape.side == ZONES[name]:
                return shape
        return None

    @property
    def far_light(self) -> Light | None:
        """The lamp beyond the northern side, if it is the only one."""
        beyond = [light for light in self.lights if light.beyond]
        return beyond[0] if len(beyond) == len(self.lights) == 1 else None

    def with_number(self, name: str, value: float) -> Arena:
        """The same with another `width`, `length`, depth of `nest` or `source`, or `light`.

        Args:
            name: Which number.
            value: What it is to be (m).

        Raises:
            ValueError: The arena has no such number; says why.
        """
        if name in ("width", "length"):
            if not isinstance(self.outline, Box):
                raise ValueError("the arena is no rectangle")
            box = self.outline
            wide = replace(box, width=value) if name == "width" else replace(box, length=value)
            return replace(self, outline=wide)
        if name == "light":
            if self.far_light is None:
                raise ValueError("the arena has no single light beyond its northern side")
            return replace(self, lights=(replace(self.far_light, y=value),))
        band = self.zone(name)
        if band is None:
            raise ValueError(f"the arena has no {name} that is a band in the {ZONES[name]}")
        changed = replace(band, depth=value)
        patches = tuple(
            replace(each, shape=changed) if each.area == name and each.shape == band else each
            for each in self.patches
        )
        return replace(self, patches=patches, start=changed if self.start == band else self.start)

    def area(self, name: str) -> tuple[Plain, ...]:
        """The shapes that make up an area, bands as half-planes."""
        return tuple(self.resolved(each.shape) for each in self.patches if each.area == name)

    def resolved(self, shape: Shape) -> Plain:
        """A shape that does not depend on the extent."""
        if not isinstance(shape, Band):
            return shape
        half = self.half_length if shape.side in ("south", "north") else self.half_width
        edge = half - shape.depth
        return HalfPlane(shape.side, edge if shape.side in ("north", "east") else -edge)

    def place_of(self, light: Light) -> Point:
        """Where a lamp is."""
        return light.x, light.y + self.half_length if light.beyond else light.y


def _corners(outline: Outline) -> tuple[Point, ...]:
    if isinstance(outline, Polygon):
        return outline.points
    if isinstance(outline, Disc):
        return ((outline.radius, outline.radius),)
    return ((outline.width / 2.0, outline.length / 2.0),)


_Part = TypeVar("_Part")


def normalised(part: _Part) -> _Part:
    """An arena, or a part of one, with floats as numbers and polygons counter-clockwise."""
    changed: Any = part
    if isinstance(part, Polygon):
        points = tuple((float(x), float(y)) for x, y in part.points)
        turns = sum(
            (x - points[0][0]) * (v - points[0][1]) - (u - points[0][0]) * (y - points[0][1])
            for (x, y), (u, v) in zip(points, (*points[1:], points[0]), strict=True)
        )
        changed = Polygon(points if turns >= 0 else (points[0], *points[:0:-1]))
    elif is_dataclass(part):
        names = [field.name for field in fields(part)]
        changed = replace(changed, **{name: normalised(getattr(part, name)) for name in names})
    elif isinstance(part, tuple | list):
        changed = tuple(normalised(each) for each in part)
    elif part is not None and not isinstance(part, bool | str):
        changed = float(changed)
    found: _Part = changed
    return found


def regular(corners: int, radius: float, turn: float | None = None) -> Polygon:
    """A regular polygon around the origin.

    Args:
        corners: How many.
        radius: Of the circle through them (m).
        turn: Where the first one is, counter-clockwise from east (degrees); None for a side that
            lies to the north.
    """
    first = 90.0 + 180.0 / corners if turn is None else turn
    angles = [math.radians(first + 360.0 * k / corners) for k in range(corners)]
    return Polygon(tuple((radius * math.cos(a), radius * math.sin(a)) for a in angles))
