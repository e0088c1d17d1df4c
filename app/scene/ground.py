"""The floor of an arena: what is painted in which colour, and where the names of areas stand."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.ndimage import minimum_filter

from geswarm.sim import Scenario
from geswarm.sim.arena.geometry import corners, distances
from geswarm.sim.arena.model import Arena, Patch
from geswarm.sim.arena.triangles import common, pieces

from .. import palette
from ..palette import Colour
from .lettering import text_width
from .plane import flat
from .shapes import Mesh

LETTER_HEIGHT = 0.42
"""Of the name of an area, if there is room, metres."""

_LAYER, _DEEPEST = 0.0008, 0.0024  # m from one patch to the one on top of it, and of all of them
_CELLS = 49  # along each side of a raster that room for a name is looked for in; odd: with a middle
_PART_WIDTH, _PART_HEIGHT = 0.8, 0.42  # that a name takes of the room it has
_SMALLER, _MOST_TRIALS = 0.8, 16  # steps so large that names in patches alike are of one height

_SENSOR_OF_COLOURS = "FLOOR"
_TOLD_APART_BY = {"nest": "white", "source": "black"}
"""What the ground of an area is painted with where robots are to find out that they are there."""


@dataclass(frozen=True)
class Sign:
    """The name of an area on the floor.

    Attributes:
        area: Its name.
        text: What is written.
        at: The middle of it (m).
        height: Of a capital (m).
        ground: Colour of what it stands on.
    """

    area: str
    text: str
    at: tuple[float, float]
    height: float
    ground: Colour


def as_shown(scenario: Scenario) -> Arena:
    """The arena of a scenario, its nest and source unpainted if robots sense but the areas.

    They are shown in tints then, on which robots and objects are seen better.
    """
    arena = scenario.arena
    if _SENSOR_OF_COLOURS in scenario.preconditions:
        return arena
    patches = tuple(
        replace(patch, floor="") if _TOLD_APART_BY.get(patch.area) == patch.floor else patch
        for patch in arena.patches
    )
    return replace(arena, patches=patches)


def floors(arena: Arena, stretch: float = 1.0) -> list[tuple[Mesh, Colour]]:
    """The floor and its patches, each in its colour, the lowest first.

    Args:
        arena: The arena.
        stretch: How much farther than usual layers are apart; the highest is at z = 0.
    """
    ground, count = pieces(arena.outline), len(arena.patches)
    layer = stretch * min(_LAYER, _DEEPEST / max(1, count))
    found = [(flat(ground, -count * layer), paint_of(arena, arena.floor))]
    for number, patch in enumerate(arena.patches, start=1):
        seen = common(arena.resolved(patch.shape), ground)
        if seen:
            found.append((flat(seen, (number - count) * layer), patch_colour(arena, patch)))
    return found


def paint_of(arena: Arena, floor: str) -> Colour:
    """How a colour of the floor is shown; grey is pale where it need not be told from white."""
    return palette.FLOOR if arena.colours == ("grey",) else palette.FLOORS[floor]


def patch_colour(arena: Arena, patch: Patch) -> Colour:
    """How a patch is shown: as it is painted, or else in the tint of its area."""
    if patch.floor:
        return paint_of(arena, patch.floor)
    others = [name for name in arena.areas if name not in palette.AREAS]
    tint = palette.AREAS.get(patch.area)
    if tint is None:
        tint = palette.OTHER_AREAS[others.index(patch.area) % len(palette.OTHER_AREAS)]
    if arena.colours == ("grey",):
        return tint
    return palette.between(paint_of(arena, arena.floor), tint, 0.35)


def signs(arena: Arena, height: float = LETTER_HEIGHT) -> list[Sign]:
    """Where the name of each area stands: on that of its patches where it can be largest.

    Args:
        arena: The arena.
        height: Of a capital where there is room (m).
    """
    found: dict[str, Sign] = {}
    for number, patch in enumerate(arena.patches):
        if patch.area:
            sign = _sign(arena, number, height)
            largest = found.get(patch.area)
            if sign is not None and (largest is None or sign.height > largest.height):
                found[patch.area] = sign
    return list(found.values())


def _sign(arena: Arena, number: int, height: float) -> Sign | None:
    patch = arena.patches[number]
    x, y, free = _room(arena, number)
    if not free.any():
        return None
    row, column = (float(places.mean()) for places in np.nonzero(free))
    text = patch.area.upper()
    wide = text_width(text, 1.0) / _PART_WIDTH
    for _ in range(_MOST_TRIALS):
        size = [
            2 * math.ceil((extent / step - 1.0) / 2.0 - 1e-9) + 1
            for extent, step in ((height / _PART_HEIGHT, y[1] - y[0]), (height * wide, x[1] - x[0]))
        ]
        fits = minimum_filter(free, size=[max(1, cells) for cells in size], mode="constant")
        if fits.any():
            rows, columns = np.nonzero(fits)
            # The place nearest to the middle of what is seen of the patch.
            best = np.hypot(
                (rows - row) * (y[1] - y[0]), (columns - column) * (x[1] - x[0])
            ).argmin()
            at = float(x[columns[best]]), float(y[rows[best]])
            return Sign(patch.area, text, at, height, patch_colour(arena, patch))
        height *= _SMALLER
    return None


def _room(
    arena: Arena, number: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.uint8]]:
    """A raster over what is seen of a patch.

    Returns:
        Middles of its columns and of its rows (m), and 1 where the patch is seen, shape
        (rows, columns), 0 elsewhere.
    """
    shape, walls = arena.resolved(arena.patches[number].shape), corners(arena.outline)
    border = corners(shape)
    low = np.maximum(border.min(axis=0), walls.min(axis=0))
    high = np.minimum(border.max(axis=0), walls.max(axis=0))
    middles = (np.arange(_CELLS) + 0.5) / _CELLS
    x, y = (low[axis] + middles * (high[axis] - low[axis]) for axis in (0, 1))
    points = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)
    free = (distances(shape, points) <= 0.0) & (distances(arena.outline, points) <= 0.0)
    above = [arena.resolved(patch.shape) for patch in arena.patches[number + 1 :]]
    for other in (*above, *arena.obstacles):
        free &= distances(other, points) > 0.0
    return x, y, free.reshape(_CELLS, _CELLS).astype(np.uint8)
