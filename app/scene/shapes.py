"""Triangle meshes from a few simple forms, all with outward normals and in metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh.

    Attributes:
        vertices: Shape (V, 3), float32, metres.
        faces: Shape (F, 3), uint32, vertices counter-clockwise seen from outside.
    """

    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]

    def __add__(self, other: Mesh) -> Mesh:
        return Mesh(
            np.concatenate((self.vertices, other.vertices)),
            np.concatenate((self.faces, other.faces + np.uint32(len(self.vertices)))),
        )

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Mesh:
        """The mesh at another place."""
        return Mesh(self.vertices + np.array((x, y, z), dtype=np.float32), self.faces)


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """One mesh of several."""
    first, *rest = meshes
    return sum(rest, start=first)


def lathe(profile: Sequence[Point], sides: int) -> Mesh:
    """A profile turned around the z axis.

    Args:
        profile: (radius, z) points, such that the outside is to the right along the profile; edges
            between its segments stay sharp.
        sides: Number of sides of the round.
    """
    angles = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    circle = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    here, after = np.arange(sides), np.roll(np.arange(sides), -1)
    bands = []
    for (r0, z0), (r1, z1) in pairwise(profile):
        lower = np.column_stack((r0 * circle, np.full(sides, z0)))
        upper = np.column_stack((r1 * circle, np.full(sides, z1)))
        rising = np.stack((here, after, sides + after), axis=1)
        falling = np.stack((here, sides + after, sides + here), axis=1)
        faces = [rising] * (r0 > 0) + [falling] * (r1 > 0)  # at the axis one of the two is empty
        bands.append(_mesh(np.concatenate((lower, upper)), np.concatenate(faces)))
    return merged(bands)


def prism(outline: Sequence[Point], z0: float, z1: float) -> Mesh:
    """A convex outline, counter-clockwise, raised from z0 to z1; all edges sharp."""
    corners = np.asarray(outline, dtype=float)
    count = len(corners)
    fan = np.array([(0, i, i + 1) for i in range(1, count - 1)])
    top = _mesh(np.column_stack((corners, np.full(count, z1))), fan)
    bottom = _mesh(np.column_stack((corners, np.full(count, z0))), fan[:, ::-1])
    walls = [
        _mesh(
            np.array([(*a, z0), (*b, z0), (*b, z1), (*a, z1)]),
            np.array([(0, 1, 2), (0, 2, 3)]),
        )
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    return merged((top, bottom, *walls))


def box(x: Point, y: Point, z: Point) -> Mesh:
    """The cuboid between two x, two y and two z."""
    return prism(((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])), *z)


def rectangle(x: Point, y: Point, z: float = 0.0) -> Mesh:
    """A horizontal rectangle that is seen from above."""
    corners = np.array([(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)])
    return _mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))


def annulus(inside: float, outside: float, sides: int) -> Mesh:
    """A flat ring at z = 0 between two radii, seen from above."""
    return lathe(((outside, 0.0), (inside, 0.0)), sides)


def line(points: Sequence[Point], width: float) -> Mesh:
    """A flat line at z = 0 with round ends and bends, seen from above."""
    dot = lathe(((width / 2, 0.0), (0.0, 0.0)), 12)
    parts = [dot.moved(*point) for point in points]
    for a, b in pairwise(np.asarray(points)):
        length = np.linalg.norm(b - a)
        if length < 1e-6:
            continue
        along = (b - a) / length
        side = np.array((along[1], -along[0])) * width / 2
        corners = np.column_stack((np.stack((a + side, b + side, b - side, a - side)), np.zeros(4)))
        parts.append(_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)])))
    return merged(parts)


def _mesh(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> Mesh:
    return Mesh(vertices.astype(np.float32), faces.astype(np.uint32))
