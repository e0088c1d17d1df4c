"""What an e-puck looks like: two wheels, a light shell, the ring of LEDs and the board on top."""

from __future__ import annotations

import numpy as np

from geswarm.sim.bodies import E_PUCK

from .robot_meshes import RobotMeshes, glow, shadow
from .shapes import Mesh, Point, lathe, merged, prism

HEIGHT = 0.052
"""From the ground to the top of the board, m."""

_RADIUS = E_PUCK.radius
_WHEEL, _TYRE = 0.0205, 0.005
_SHELL_LOW, _RING_LOW, _RING_HIGH = 0.012, 0.030, 0.041
_BOARD = 0.029
_ARROW: tuple[Point, ...] = ((-0.006, 0.0), (-0.013, -0.013), (0.020, 0.0), (-0.013, 0.013))


def epuck() -> RobotMeshes:
    """The meshes of an e-puck that faces east."""
    wheels = [_wheel(side * E_PUCK.wheel_base / 2) for side in (1, -1)]
    shell = lathe(((0.027, 0.004), (0.031, _SHELL_LOW), (_RADIUS - 0.003, _RING_LOW)), 20)
    board = lathe(
        (
            (_BOARD, _RING_HIGH),
            (_BOARD, HEIGHT - 0.004),
            (_BOARD - 0.002, HEIGHT - 0.002),
            (0.0, HEIGHT - 0.002),
        ),
        20,
    )
    camera = prism(((0.028, -0.006), (0.034, -0.006), (0.034, 0.006), (0.028, 0.006)), 0.016, 0.026)
    arrow = prism(_ARROW, HEIGHT - 0.002, HEIGHT)
    return RobotMeshes(
        body=merged((*wheels, camera, arrow)),
        trim=merged((shell, board)),
        leds=_ring(20),
        shadow=shadow(_RADIUS),
        glow=glow(_RADIUS),
        carried=_load(16),
    )


def distant_epuck() -> RobotMeshes:
    """An e-puck in about a tenth of the triangles."""
    return RobotMeshes(
        body=merged(
            (lathe(((0.030, 0.0), (0.030, _RING_LOW)), 6), prism(_ARROW, HEIGHT - 0.002, HEIGHT))
        ),
        trim=lathe(((_BOARD, HEIGHT - 0.002), (0.0, HEIGHT - 0.002)), 8),
        leds=_ring(8),
        shadow=shadow(_RADIUS, 6),
        glow=glow(_RADIUS, 6, ((1.7, 0.0062),)),
        carried=_load(5),
    )


def _ring(sides: int) -> Mesh:
    """Of LEDs, around the board."""
    return lathe(((_RADIUS, _RING_LOW), (_RADIUS, _RING_HIGH), (_BOARD, _RING_HIGH)), sides)


def _load(sides: int) -> Mesh:
    """An object of its size."""
    radius, top = 0.016, HEIGHT + 0.02
    return lathe(((radius, HEIGHT), (radius, top), (0.0, top)), sides)


def _wheel(y: float) -> Mesh:
    """A disc that stands upright."""
    angles = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    outline = [(_WHEEL * np.cos(a), _WHEEL * np.sin(a)) for a in angles]
    lying = prism(outline, -_TYRE / 2, _TYRE / 2)
    x, up, across = lying.vertices.T
    return Mesh(np.column_stack((x, y - across, up + _WHEEL)).astype(np.float32), lying.faces)
