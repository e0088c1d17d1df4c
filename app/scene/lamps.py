"""The lamps of an arena: where they are, or on their bearing if that is far away."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
import viser

from geswarm.sim.arena.geometry import distances
from geswarm.sim.arena.model import Arena, Light

from .. import palette
from ..palette import Colour
from .camera import ELEVATION, FORWARD
from .shapes import lathe

LAMP_DISTANCE = 0.5
"""From the wall to a lamp that stands for a far light, m."""

LAMP_HEIGHT = 0.40
LAMP_RADIUS, NEAR_LAMP_RADIUS = 0.10, 0.06
"""Of a ball that stands for a far light, and of one in its place, m."""

_GLOW = 5.5
"""Radius of the light around a ball, by that of the ball."""

_NEAR = 1.0  # m from the arena up to which a lamp is in its place
_HIGHEST = 1.0  # m, or half of the arena's extent, up to which a lamp hangs in its place
_POOL, _POOL_Z = 0.7, 0.0043  # light on the floor below a lamp: its size by that of the glow, m
_ROD: Colour = (120, 126, 142)


@dataclass(frozen=True)
class Lamp:
    """A lamp as it is drawn.

    Attributes:
        at: The middle of its ball (m).
        radius: Of its ball (m).
        label: What is said of it; empty if it is where it belongs.
        place: Whether it stands beside the arena on a rod, hangs above its floor, or is far.
    """

    at: tuple[float, float, float]
    radius: float
    label: str = ""
    place: Literal["standing", "hanging", "far"] = "far"

    @property
    def outermost(self) -> list[tuple[float, float, float]]:
        """Points that enclose it and its label."""
        x, y, z = self.at
        beside = 3.0 * self.radius
        return [(x + dx, y, z + 0.05 + beside) for dx in (-beside, beside)]


def lamp_of(arena: Arena, light: Light) -> Lamp:
    """How a light is drawn."""
    east, north = arena.half_width, arena.half_length
    x, y = arena.place_of(light)
    away = max(abs(x) - east, abs(y) - north)
    if light.beyond or away > _NEAR:
        part = min(1.0, *((h + LAMP_DISTANCE) / abs(to) for h, to in ((east, x), (north, y)) if to))
        said = f"{light.y:g} m north" if light.beyond else f"{math.hypot(x, y):.3g} m away"
        return Lamp((part * x, part * y, LAMP_HEIGHT), LAMP_RADIUS, f"light, {said}")
    height = min(light.height, max(_HIGHEST, east, north))
    said = f"light, {light.height:g} m up" if height < light.height else ""
    outside = distances(arena.outline, np.array([(x, y)]))[0] > 0.0
    at = (x, y, max(height, NEAR_LAMP_RADIUS))
    return Lamp(at, NEAR_LAMP_RADIUS, said, "standing" if outside else "hanging")


def draw_lamp(scene: viser.SceneApi, name: str, lamp: Lamp) -> None:
    """A glowing ball, on a rod or over light on the floor, or far away."""
    at, radius = np.array(lamp.at), lamp.radius
    scene.add_icosphere(
        f"{name}/ball", radius, color=(255, 236, 170), position=at, cast_shadow=False
    )
    _draw_glow(scene, f"{name}/glow", radius, at - 1.2 * radius * FORWARD, _FACING_CAMERA)
    if lamp.place == "hanging":
        below = np.array((at[0], at[1], _POOL_Z))
        _draw_glow(scene, f"{name}/pool", _POOL * radius, below, (1.0, 0.0, 0.0, 0.0))
    if lamp.place == "standing":
        rod = lathe(((0.03, -0.004), (0.03, 0.004), (0.008, 0.008), (0.008, at[2])), 12)
        scene.add_mesh_simple(
            f"{name}/rod",
            rod.vertices,
            rod.faces,
            color=_ROD,
            position=(at[0], at[1], 0.0),
            cast_shadow=False,
            receive_shadow=False,
        )
    if lamp.label:
        scene.add_label(
            f"{name}/label",
            lamp.label,
            position=(at[0], at[1], at[2] + radius + 0.06),
            anchor="bottom-center",
            font_screen_scale=1.2,
        )


def _draw_glow(
    scene: viser.SceneApi,
    name: str,
    radius: float,
    at: npt.NDArray[np.float64],
    turned: tuple[float, float, float, float],
) -> None:
    scene.add_image(
        name,
        _glow(),
        2 * _GLOW * radius,
        2 * _GLOW * radius,
        position=at,
        wxyz=turned,
        cast_shadow=False,
        receive_shadow=False,
    )


_TILT = np.pi / 2 - ELEVATION
_FACING_CAMERA = (float(np.cos(_TILT / 2)), float(np.sin(_TILT / 2)), 0.0, 0.0)
"""Turns a picture, which viser lays in its x-y plane, to a camera in its usual place."""


def _glow(size: int = 128) -> npt.NDArray[np.uint8]:
    """A soft disc of light, shape (size, size, 4), RGBA."""
    axis = np.linspace(-1.0, 1.0, size)
    radius = np.hypot(axis[:, None], axis[None, :])
    picture = np.empty((size, size, 4), dtype=np.uint8)
    picture[..., :3] = palette.LIGHT
    picture[..., 3] = 235 * np.clip(1.0 - radius, 0.0, 1.0) ** 2
    return picture
