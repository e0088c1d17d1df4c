"""Shapes in the plane as meshes: floors of any form, walls along them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import corners
from geswarm.sim.arena.model import Plain
from geswarm.sim.arena.triangles import turn

from .shapes import Mesh, merged

Points = npt.NDArray[np.float64]
"""Shape (n, 2), metres; corners go counter-clockwise."""

_STRAIGHT = 1e-9  # m2
_SHARPEST = 0.25  # of a wall's corners, lest it reaches far out


def flat(parts: Sequence[Points], z: float = 0.0) -> Mesh:
    """Convex pieces as a horizontal mesh that is seen from above."""
    vertices, faces, count = [np.zeros((0, 2))], [np.zeros((0, 3), dtype=np.int64)], 0
    for part in parts:
        inner = np.arange(1, len(part) - 1)
        fan = np.column_stack((np.zeros_like(inner), inner, inner + 1))
        seen = turn(part[fan[:, 0]], part[fan[:, 1]], part[fan[:, 2]]) > _STRAIGHT
        vertices.append(part)
        faces.append(fan[seen] + count)
        count += len(part)
    ground = np.concatenate(vertices)
    upright = np.column_stack((ground, np.full(count, z)))
    return Mesh(upright.astype(np.float32), np.concatenate(faces).astype(np.uint32))


def wall(shape: Plain, thickness: float, height: float) -> Mesh:
    """A wall on the ground along the outside of a shape, without its underside."""
    inner, outer = corners(shape), _around(shape, thickness)
    rings = [
        np.column_stack((ring, np.full(len(ring), z)))
        for z in (0.0, height)
        for ring in (inner, outer)
    ]
    low_inner, low_outer, high_inner, high_outer = rings
    return merged(
        (
            _strip(high_inner, low_inner),
            _strip(low_outer, high_outer),
            _strip(high_outer, high_inner),
        )
    )


def rim(shape: Plain, width: float) -> Mesh:
    """A flat ring at z = 0 along the outside of a shape, seen from above."""
    inner, outer = corners(shape), _around(shape, width)
    return _strip(*(np.column_stack((ring, np.zeros(len(ring)))) for ring in (outer, inner)))


def _around(shape: Plain, distance: float) -> Points:
    """The corners of a shape, moved outwards so that all sides are at a distance (m)."""
    border = corners(shape)
    along = np.roll(border, -1, axis=0) - border
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    outward = np.column_stack((along[:, 1], -along[:, 0]))
    before = np.roll(outward, 1, axis=0)
    bend = 1.0 + (outward * before).sum(axis=1, keepdims=True)
    moved: Points = border + distance * (outward + before) / np.maximum(bend, _SHARPEST)
    return moved


def _strip(lower: Points, upper: Points) -> Mesh:
    """A closed strip of flat quadrilaterals, shape of both borders (n, 3); its edges are sharp.

    It is seen from where the first border is below the second one and both run to the right.
    """
    n = len(lower)
    quads = np.stack((lower, np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0), upper), axis=1)
    first = 4 * np.arange(n)[:, None]
    faces = np.concatenate([first + np.array(half) for half in ((0, 1, 2), (0, 2, 3))])
    return Mesh(quads.reshape(-1, 3).astype(np.float32), faces.astype(np.uint32))
