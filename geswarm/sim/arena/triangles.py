"""Shapes with straight sides cut into convex pieces and triangles; places in these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm.sim.arena.geometry import Extent, Points, corners, is_within, nearest_on
from geswarm.sim.arena.model import Plain, Point

_STRAIGHT = 1e-9  # m2
_LEAST_SHARE = 1e-9
"""Of the whole area, below which a triangle is left out."""
_TOUCHING = 1e-6
"""How far shapes may reach into each other and still be taken to touch (m)."""


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles that have no more than their borders in common.

    Attributes:
        corners: Counter-clockwise, shape (triangles, 3, 2), metres.
    """

    corners: Points

    @classmethod
    def of(cls, parts: Sequence[Points]) -> Triangles:
        """Convex pieces, each cut into triangles; what has hardly any area is left out.

        Args:
            parts: Corners of each, counter-clockwise, shape (corners, 2), metres.
        """
        fans = [np.stack((part[[0] * (len(part) - 2)], part[1:-1], part[2:]), 1) for part in parts]
        found = np.concatenate([np.zeros((0, 3, 2)), *fans])
        areas = turn(*np.moveaxis(found, 1, 0))
        return cls(found[areas > max(_STRAIGHT, _LEAST_SHARE * float(areas.sum()))])

    @property
    def extent(self) -> Extent:
        """The smallest box along the axes around all of them."""
        points = self.corners.reshape(-1, 2)
        return Extent(*points.min(axis=0).tolist(), *points.max(axis=0).tolist())

    @property
    def rows(self) -> Points:
        """How places in them are drawn, see `kernels.geometry.place_in_triangles`.

        Returns:
            Shape (triangles, 8): the area of all before it and its own, as shares of the whole; a
            corner; the ways from there to the second and to the third one (x, y each, m).
        """
        first, second, third = np.moveaxis(self.corners, 1, 0)
        areas = turn(first, second, third)
        shares = areas / areas.sum()
        before = np.cumsum(shares) - shares
        return np.column_stack((before, shares, first, second - first, third - first))

    def nearest(self, wanted: Point) -> Point:
        """The place in them that is nearest to one."""
        point = np.array([wanted])
        if any(is_within(each, point)[0] for each in self.corners):
            return wanted
        found = np.array([nearest_on(each, point)[0] for each in self.corners])
        x, y = found[np.hypot(*(found - point).T).argmin()].tolist()
        return x, y

    def share_area_with(self, other: Triangles) -> bool:
        """Whether some of these have more than borders in common with some of the others."""
        mine, its = self.corners[:, np.newaxis], other.corners[np.newaxis]
        return not bool((_has_beside(mine, its) | _has_beside(its, mine)).all())


def _has_beside(one: Points, other: Points) -> npt.NDArray[np.bool_]:
    """Whether a triangle is all beyond a side of another one; shape but for the last two axes."""
    found = np.zeros(np.broadcast_shapes(one.shape, other.shape)[:-2], dtype=np.bool_)
    for k in range(3):
        start, end = one[..., k, np.newaxis, :], one[..., k - 2, np.newaxis, :]
        length = np.hypot(*np.moveaxis(end - start, -1, 0))
        found |= (turn(start, end, other) <= _TOUCHING * length).all(axis=-1)
    return found


def pieces(shape: Plain) -> list[Points]:
    """A shape as convex pieces that do not overlap: itself if it is convex, or triangles."""
    border = corners(shape)
    following, next_but_one = np.roll(border, -1, axis=0), np.roll(border, -2, axis=0)
    if (turn(border, following, next_but_one) >= -_STRAIGHT).all():
        return [border]
    return [border[list(triangle)] for triangle in triangles(border)]


def triangles(border: Points) -> list[tuple[int, int, int]]:
    """A simple polygon cut into triangles: numbers of their corners, counter-clockwise."""
    left, found = list(range(len(border))), []
    while len(left) > 3:
        for place, corner in enumerate(left):
            before, after = left[place - 1], left[(place + 1) % len(left)]
            bend = turn(border[before], border[corner], border[after])
            straight = abs(bend) <= _STRAIGHT
            others = border[[i for i in left if i not in (before, corner, after)]]
            if straight or (bend > 0.0 and not _holds_any(border[[before, corner, after]], others)):
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


def turn(a: Points, b: Points, c: Points) -> Points:
    """Twice the area of each triangle; positive if it goes counter-clockwise."""
    u, v = b - a, c - a
    found: Points = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return found


def _clipped(piece: Points, window: Points) -> Points:
    """What two convex pieces have in common; no points if they have nothing."""
    apart = (piece.max(axis=0) <= window.min(axis=0)) | (piece.min(axis=0) >= window.max(axis=0))
    if apart.any():
        return np.zeros((0, 2))
    for start, end in zip(window, np.roll(window, -1, axis=0), strict=True):
        side = turn(start, end, piece)
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
    sides = (turn(a, b, points), turn(b, c, points), turn(c, a, points))
    return bool((np.minimum.reduce(sides) >= 0.0).any())
