"""What a foot-bot looks like: the robot's parts as low-polygon meshes, one mesh per colour.

Proportions follow the MarXbot foot-bot: two treads in a round base, a ring of LEDs with the gripper in
front, and the electronics with the camera tower above. x is forward, the origin is on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .shapes import Mesh, box, lathe, line, merged, prism

RADIUS = 0.085
"""Of the body, m (foot-bot)."""

HEIGHT = 0.146
"""From the ground to the top of the tower, m."""

OBJECT_RADIUS = 0.04
OBJECT_HEIGHT = 0.05

_RING_LOW, _RING_HIGH = 0.062, 0.088
"""Lower and upper edge of the LED ring, m."""


@dataclass(frozen=True, eq=False)
class FootBot:
    """The meshes of one robot.

    Attributes:
        body: Dark: base, treads, deck and tower.
        trim: Light: rims, gripper and the arrow that shows the heading.
        leds: In the colour of the behaviour: LED ring and beacon.
        shadow: Flat disc below the robot.
        carried: The object on top of the robot.
    """

    body: Mesh
    trim: Mesh
    leds: Mesh
    shadow: Mesh
    carried: Mesh


def footbot() -> FootBot:
    """The meshes of a foot-bot that faces east."""
    return FootBot(
        body=_body(),
        trim=_trim(),
        leds=_leds(),
        shadow=lathe(((1.35 * RADIUS, 0.0), (0.0, 0.0)), 20),
        carried=puck().moved(z=HEIGHT),
    )


def puck() -> Mesh:
    """An object that stands on the ground: a small cylinder with a bevelled edge."""
    r, h, bevel = OBJECT_RADIUS, OBJECT_HEIGHT, 0.008
    return lathe(((r, 0.0), (r, h - bevel), (r - bevel, h), (0.0, h)), 16)


def _body() -> Mesh:
    base = lathe(
        ((0.0, 0.014), (0.070, 0.014), (0.078, 0.030), (0.078, _RING_LOW), (0.0, _RING_LOW)), 20
    )
    treads = [_tread(0.058), _tread(-0.058)]
    deck = lathe(((0.070, _RING_HIGH - 0.004), (0.0, _RING_HIGH - 0.004)), 20)
    tower = lathe(
        ((0.050, _RING_HIGH - 0.004), (0.050, 0.112), (0.042, 0.118), (0.042, 0.132), (0.0, 0.132)),
        16,
    )
    return merged((base, *treads, deck, tower))


def _tread(y: float) -> Mesh:
    """One track with its wheels: a long box with slanted ends, standing on the ground."""
    side = ((-0.045, 0.0), (0.045, 0.0), (0.062, 0.022), (0.045, 0.044), (-0.045, 0.044))
    upright = prism((*side, (-0.062, 0.022)), -0.011, 0.011)
    x, z, across = upright.vertices.T
    vertices = np.column_stack((x, y - across, z)).astype(np.float32)
    return Mesh(vertices, upright.faces)


def _trim() -> Mesh:
    rims = [
        lathe(((RADIUS - 0.012, z), (RADIUS, z), (RADIUS, z + 0.006), (RADIUS - 0.012, z + 0.006)), 24)
        for z in (_RING_LOW - 0.006, _RING_HIGH)
    ]
    claws = [
        prism(((0.080, y - 0.006), (0.104, y - 0.004), (0.104, y + 0.004), (0.080, y + 0.006)), 0.064, 0.084)
        for y in (-0.020, 0.020)
    ]
    palm = box((0.076, 0.086), (-0.030, 0.030), (0.060, _RING_HIGH + 0.006))
    pointer = prism(((0.052, -0.024), (0.082, 0.0), (0.052, 0.024)), 0.090, 0.098)
    arrow = prism(((-0.026, -0.026), (0.040, 0.0), (-0.026, 0.026), (-0.014, 0.0)), 0.132, 0.138)
    return merged((*rims, *claws, palm, pointer, arrow))


def _leds() -> Mesh:
    ring = lathe(
        (
            (RADIUS - 0.003, _RING_LOW),
            (RADIUS - 0.001, (_RING_LOW + _RING_HIGH) / 2),
            (RADIUS - 0.003, _RING_HIGH),
        ),
        24,
    )
    return ring


def yaw_quaternions(theta: npt.NDArray[np.float64]) -> npt.NDArray[np.float32]:
    """Rotations about z as quaternions (w, x, y, z), shape (n, 4), of headings in radians, (n,)."""
    quaternions = np.zeros((len(theta), 4), dtype=np.float32)
    quaternions[:, 0] = np.cos(theta / 2)
    quaternions[:, 3] = np.sin(theta / 2)
    return quaternions
