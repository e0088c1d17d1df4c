"""What a foot-bot looks like: two treads in a round base, a ring of LEDs, a tower with a camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from geswarm.sim.footbot import RADIUS

from .robot_meshes import RobotMeshes, glow, shadow
from .shapes import Mesh, lathe, merged, prism

HEIGHT = 0.146
"""From the ground to the top of the tower, m."""

OBJECT_RADIUS = 0.04
OBJECT_HEIGHT = 0.05

_RING_LOW, _RING_HIGH = 0.058, 0.094
_RING_INSIDE = 0.066
_TOWER_RADIUS = 0.048


def footbot() -> RobotMeshes:
    """The meshes of a foot-bot that faces east."""
    return RobotMeshes(
        body=_body(),
        trim=_trim(),
        leds=_leds(),
        shadow=shadow(RADIUS),
        glow=glow(RADIUS),
        carried=puck().moved(z=HEIGHT),
    )


def distant_footbot() -> RobotMeshes:
    """A foot-bot in about a tenth of the triangles, for swarms too large to look at one robot."""
    ring = (
        (RADIUS, _RING_LOW),
        (RADIUS, _RING_HIGH),
        (_RING_INSIDE, _RING_HIGH),
    )
    top = HEIGHT + OBJECT_HEIGHT
    arrow = ((-0.030, 0.0), (-0.050, -0.045), (0.065, 0.0), (-0.050, 0.045))
    return RobotMeshes(
        body=lathe(((0.078, 0.0), (0.078, _RING_LOW)), 6),
        trim=merged((lathe(((_RING_INSIDE, 0.084), (0.0, 0.084)), 8), prism(arrow, 0.084, HEIGHT))),
        leds=lathe(ring, 8),
        shadow=shadow(RADIUS, 6),
        glow=glow(RADIUS, 6, ((1.7, 0.0062),)),
        carried=lathe(((OBJECT_RADIUS, HEIGHT), (OBJECT_RADIUS, top), (0.0, top)), 5),
    )


def puck() -> Mesh:
    """An object that stands on the ground: a small cylinder with a bevelled edge."""
    r, h, bevel = OBJECT_RADIUS, OBJECT_HEIGHT, 0.008
    return lathe(((r, 0.0), (r, h - bevel), (r - bevel, h), (0.0, h)), 16)


def distant_puck() -> Mesh:
    """The same in a sixth of the triangles."""
    r, h = OBJECT_RADIUS, OBJECT_HEIGHT
    return lathe(((r, 0.0), (r, h), (0.0, h)), 5)


def _body() -> Mesh:
    base = lathe(((0.066, 0.012), (0.078, 0.030), (0.078, _RING_LOW)), 20)
    deck = lathe(((_RING_INSIDE, 0.084), (0.0, 0.084)), 20)
    arrow = prism(((-0.014, 0.0), (-0.030, -0.030), (0.042, 0.0), (-0.030, 0.030)), 0.140, HEIGHT)
    return merged((base, _tread(0.056), _tread(-0.056), deck, arrow))


def _tread(y: float) -> Mesh:
    """One track with its wheels: a long box with slanted ends, standing on the ground."""
    side = ((-0.040, 0.0), (0.040, 0.0), (0.055, 0.022), (0.040, 0.044), (-0.040, 0.044))
    upright = prism((*side, (-0.055, 0.022)), -0.011, 0.011)
    x, z, across = upright.vertices.T
    return Mesh(np.column_stack((x, y - across, z)), upright.faces)


def _trim() -> Mesh:
    rim = lathe(((0.078, 0.050), (RADIUS, 0.050), (RADIUS, _RING_LOW)), 20)
    r = _TOWER_RADIUS
    tower = lathe(
        ((r, 0.084), (r, 0.112), (r - 0.008, 0.120), (r - 0.008, 0.134), (0.0, 0.140)), 16
    )
    pointer = prism(((0.050, -0.026), (0.100, 0.0), (0.050, 0.026)), 0.088, 0.100)
    claws = [
        prism(
            ((0.080, y - 0.006), (0.108, y - 0.003), (0.108, y + 0.003), (0.080, y + 0.006)),
            0.040,
            0.070,
        )
        for y in (-0.024, 0.024)
    ]
    return merged((rim, tower, pointer, *claws))


def _leds() -> Mesh:
    inside, outside = _RING_INSIDE, RADIUS
    return lathe(
        (
            (outside, _RING_LOW),
            (outside, _RING_HIGH - 0.008),
            (outside - 0.006, _RING_HIGH),
            (inside, _RING_HIGH),
            (inside, 0.084),
        ),
        20,
    )


def yaw_quaternions(theta: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float32]:
    """Rotations about z as quaternions (w, x, y, z), shape (n, 4), of headings in radians, (n,)."""
    quaternions = np.zeros((len(theta), 4), dtype=np.float32)
    quaternions[:, 0] = np.cos(theta / 2)
    quaternions[:, 3] = np.sin(theta / 2)
    return quaternions
