"""The form of an arena: what decides the source of a kernel, and not its numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from geswarm.sim.arena.model import Arena, Box, Disc, HalfPlane, Outline, Point, Polygon, Shape

MOST_SIDES = 64
"""Most sides of a polygon: each is a line of source in several loops."""


class GroundError(ValueError):
    """The simulator cannot run in this arena."""


@dataclass(frozen=True)
class Form:
    """The form of one shape.

    Attributes:
        kind: "disc", "box", "turned" (a box), "polygon", or the side of a half-plane ("south").
        sides: Of a polygon, else 0.
    """

    kind: str
    sides: int = 0

    @classmethod
    def of(cls, shape: Disc | Box | Polygon | HalfPlane) -> Form:
        """The form of a shape."""
        if isinstance(shape, HalfPlane):
            return cls(shape.side)
        if isinstance(shape, Polygon):
            return cls("polygon", len(shape.points))
        if isinstance(shape, Disc):
            return cls("disc")
        return cls("turned" if shape.angle % 180.0 else "box")


@dataclass(frozen=True)
class PatchForm:
    """The form of one patch of floor.

    Attributes:
        form: Of its shape.
        area: The area that it belongs to, or empty.
        colour: Number of its colour among those of the arena; -1 if it is not painted.
    """

    form: Form
    area: str = ""
    colour: int = -1


@dataclass(frozen=True)
class Ground:
    """The form of an arena; arenas of one form share a kernel.

    Attributes:
        outline: "box", "disc", "convex" (a polygon) or "polygon" (any other one).
        sides: Of a polygon, else 0.
        inner: The corners of a polygon at which the walls stand out into the arena.
        obstacles: Their forms.
        patches: Their forms; later ones lie on top.
        lights: How many.
        source: The form of where objects lie ("box", "disc", "turned" or "triangles"); empty if
            they do not.
    """

    outline: str = "box"
    sides: int = 0
    inner: tuple[int, ...] = ()
    obstacles: tuple[Form, ...] = ()
    patches: tuple[PatchForm, ...] = ()
    lights: int = 0
    source: str = ""

    @classmethod
    def of(cls, arena: Arena) -> Ground:
        """The form of an arena.

        Raises:
            GroundError: A polygon has more than MOST_SIDES sides.
        """
        for shape in (arena.outline, *(patch.shape for patch in arena.patches)):
            if isinstance(shape, Polygon) and len(shape.points) > MOST_SIDES:
                raise GroundError(
                    f"a polygon: expected at most {MOST_SIDES} corners, got {len(shape.points)}"
                )
        outline = arena.outline
        inner = inner_corners(outline.points) if isinstance(outline, Polygon) else ()
        return cls(
            outline=_kind_of_outline(outline, inner),
            sides=len(outline.points) if isinstance(outline, Polygon) else 0,
            inner=inner,
            obstacles=tuple(Form.of(each) for each in arena.obstacles),
            patches=tuple(
                PatchForm(
                    Form.of(arena.resolved(patch.shape)),
                    patch.area,
                    arena.colours.index(patch.floor) if patch.floor else -1,
                )
                for patch in arena.patches
            ),
            lights=len(arena.lights),
            source=_source_form(arena.area("source")),
        )

    @property
    def areas(self) -> tuple[str, ...]:
        """The names of the areas, in the order of their first patches."""
        return tuple(dict.fromkeys(patch.area for patch in self.patches if patch.area))

    @property
    def is_plain(self) -> bool:
        """Whether one clamp is enough to keep robots inside."""
        return self.outline in ("box", "disc") and not self.obstacles

    @property
    def may_be_crossed(self) -> bool:
        """Whether a robot that moved far in a step may be on the other side of something."""
        return self.outline == "polygon" or bool(self.obstacles)


def inner_corners(points: tuple[Point, ...]) -> tuple[int, ...]:
    """The corners of a polygon at which the inner angle is more than half a turn."""
    found = []
    for k, (x, y) in enumerate(points):
        (before_x, before_y), (after_x, after_y) = points[k - 1], points[(k + 1) % len(points)]
        one, two = (x - before_x, y - before_y), (after_x - x, after_y - y)
        turn = one[0] * two[1] - one[1] * two[0]
        if turn < -1e-9 * math.hypot(*one) * math.hypot(*two):
            found.append(k)
    return tuple(found)


def _kind_of_outline(outline: Outline, inner: tuple[int, ...]) -> str:
    if isinstance(outline, Polygon):
        return "polygon" if inner else "convex"
    return Form.of(outline).kind


_Resolved: TypeAlias = Disc | Box | Polygon | HalfPlane


def _source_form(shapes: tuple[Shape, ...]) -> str:
    """How places in the source are drawn; a half-plane of a box is a box."""
    if not shapes:
        return ""
    shape = shapes[0]
    if len(shapes) > 1 or isinstance(shape, Polygon):
        return "triangles"
    if isinstance(shape, HalfPlane):
        return "box"
    assert isinstance(shape, _Resolved)
    return Form.of(shape).kind
