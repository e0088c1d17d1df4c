"""What a robot looks like: its parts as low-polygon meshes, one mesh per colour.

x is forward, the origin is on the ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .shapes import Mesh, lathe, merged

_SHADOW, _SHADOW_HEIGHT = 1.15, 0.0078
_GLOW_LAYERS = ((2.2, 0.0050), (1.95, 0.0056), (1.7, 0.0062), (1.45, 0.0068))
"""(radius in body radii, z) of faint discs, one above the other: brighter towards the robot."""


@dataclass(frozen=True, eq=False)
class RobotMeshes:
    """The meshes of one robot.

    Attributes:
        body: Dark: what drives it, and the arrow on top.
        trim: Light: the rest of it.
        leds: The LED ring, in the colour of the behaviour.
        shadow: Flat disc below the robot.
        glow: Flat disc around it, the light of the LEDs on the ground.
        carried: The object on top of the robot.
    """

    body: Mesh
    trim: Mesh
    leds: Mesh
    shadow: Mesh
    glow: Mesh
    carried: Mesh


def shadow(radius: float, sides: int = 20) -> Mesh:
    """The shadow of a body."""
    return lathe(((_SHADOW * radius, _SHADOW_HEIGHT), (0.0, _SHADOW_HEIGHT)), sides)


def glow(
    radius: float, sides: int = 20, layers: Sequence[tuple[float, float]] = _GLOW_LAYERS
) -> Mesh:
    """What LEDs light of the ground around a body."""
    return merged([lathe(((r * radius, z), (0.0, z)), sides) for r, z in layers])
