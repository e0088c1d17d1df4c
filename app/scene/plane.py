"""Shapes in the plane as meshes: floors of any form, what two have in common, walls along them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import corners
from geswarm.sim.arena.model import Plain

from .shapes import Mesh, merged

Points = npt.NDArray[np.float64]
"""Shape (n, 2), metres; corners go counter-clockwise."""

_STRAIGHT = 1e-9  # m2
_SHARPEST = 0.25  # of a wall's corners, lest it reaches far out


def pieces(shape: Plain) -> list[Points]:
    """A shape as convex pieces that do not overlap: itself if it is convex, or triangles."""
    border = corners(shape)
    following, next_but_one = np.roll(border, -1, axis=0), np.roll(border, -2, axis=0)
    if (_turn(border, following, next_but_one) >= -_STRAIGHT).all():
        return [border]
    return [border[list(triangle)] for triangle in triangles(border)]


def triangles(border: Points) -> list[tuple[int, int, int]]:
    """A simple polygon cut into triangles: numbers of their corners, counter-clockwise."""
    left, found = list(range(len(border))), []
    while len(left) > 3:
        for place, corner in enumerate(left):
            before, after = left[place - 1], left[(place + 1) % len(left)]
            turn = _turn(border[before], border[corner], border[after])
            straight = abs(turn) <= _STRAIGHT
            others = border[[i for i in left if i not in (before, corner, after)]]
            if straight or (turn > 0.0 and not _holds_any(border[[before, corner, after]], others)):
                if not straight:
                    found.append((before, corner, after))
                del left[place]
                break
        else:  # rounding has left nothing to cut off
            return found
    return [*found, (left[0], left[1], left[2])]


def common(shape: Plain, window: Sequence[Points]) -> list[Points]:
    """What a shape has in common with convex pieces, as convex pieces."""
    found = [_clipped(piece, each) for piece in pieces(shape) for each in window]
    return [piece for piece in found if len(piece) > 2]


def flat(parts: Sequence[Points], z: float = 0.0) -> Mesh:
    """Convex pieces as a horizontal mesh that is seen from above."""
    vertices, faces, count = [np.zeros((0, 2))], [np.zeros((0, 3), dtype=np.int64)], 0
    for part in parts:
        inner = np.arange(1, len(part) - 1)
        fan = np.column_stack((np.zeros_like(inner), inner, inner + 1))
        seen = _turn(part[fan[:, 0]], part[fan[:, 1]], part[fan[:, 2]]) > _STRAIGHT
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


def _clipped(piece: Points, window: Points) -> Points:
    """What two convex pieces have in common; no points if they have nothing."""
    apart = (piece.max(axis=0) <= window.min(axis=0)) | (piece.min(axis=0) >= window.max(axis=0))
    if apart.any():
        return np.zeros((0, 2))
    for start, end in zip(window, np.roll(window, -1, axis=0), strict=True):
        side = _turn(start, end, piece)
        found = []
        for k in range(len(piece)):
            if side[k - 1] * side[k] < 0.0:
                part = side[k - 1] / (side[k - 1] - side[k])
                found.append(piece[k - 1] + part * (piece[k] - piece[k - 1]))
            if side[k] >= 0.0:
                found.append(piece[k])
        piece = np.array(found).reshape(-1, 2)
        if len(piece) < 3:
            break
    return piece


def _holds_any(triangle: Points, points: Points) -> bool:
    """Whether any point is in a triangle or on its border."""
    a, b, c = triangle
    sides = (_turn(a, b, points), _turn(b, c, points), _turn(c, a, points))
    return bool((np.minimum.reduce(sides) >= 0.0).any())


def _turn(a: Points, b: Points, c: Points) -> Points:
    """Twice the area of each triangle; positive if it goes counter-clockwise."""
    u, v = b - a, c - a
    turn: Points = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return turn
