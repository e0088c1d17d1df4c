"""The parts of the arena that do not move: ground, zones, walls, the light and the backdrop."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import viser

from geswarm.sim import Scenario

from .. import palette
from ..palette import Colour
from .camera import ELEVATION, FORWARD
from .lettering import painted, text_width
from .shapes import Mesh, box, line, merged, rectangle

WALL_HEIGHT = 0.07
WALL_THICKNESS = 0.05
MARGIN = 0.28
"""Of the table around the arena, m."""

LAMP_DISTANCE = 0.5
"""From the north wall to the lamp that stands for the far light, m."""

LAMP_HEIGHT = 0.40
LAMP_RADIUS = 0.10
GLOW_RADIUS = 0.55

_WALL: Colour = (168, 174, 188)
_TABLE: Colour = (84, 90, 106)
_MARKING: Colour = (206, 210, 220)
_NEST_TEXT: Colour = (142, 156, 204)
_SOURCE_TEXT: Colour = (202, 172, 124)
_LETTERS_Z = 0.004
_TABLE_TOP = -0.004


def outer_points(scenario: Scenario) -> npt.NDArray[np.float64]:
    """Points that enclose all that must be in the picture, shape (n, 3), metres."""
    east, north = scenario.width / 2 + MARGIN, scenario.length / 2 + MARGIN
    ground = [(x, y, z) for x in (-east, east) for y in (-north, north) for z in (0.0, 0.15)]
    lamp = [(x, scenario.length / 2 + LAMP_DISTANCE, LAMP_HEIGHT + 0.35) for x in (-0.3, 0.3)]
    return np.array(ground + lamp)


def draw_scenery(scene: viser.SceneApi, root: str, scenario: Scenario) -> None:
    """Draw everything that does not move, as children of the node `root`."""
    east, north = scenario.width / 2, scenario.length / 2
    nest_edge, source_edge = scenario.nest - north, north - scenario.source
    across = (-east, east)
    stretch = _stretch(scenario)
    _flat(scene, f"{root}/nest", rectangle(across, (-north, nest_edge)), palette.NEST)
    _flat(scene, f"{root}/source", rectangle(across, (source_edge, north)), palette.SOURCE)
    if source_edge > nest_edge:
        _flat(scene, f"{root}/floor", rectangle(across, (nest_edge, source_edge)), palette.FLOOR)
    _flat(scene, f"{root}/walls", _walls(east, north), _WALL)
    _flat(scene, f"{root}/table", _table(east, north, stretch), _TABLE)
    _flat(scene, f"{root}/scale", _scale_bar(east, north), _MARKING)
    for word, colour, middle, depth in (
        ("NEST", _NEST_TEXT, (nest_edge - north) / 2, scenario.nest),
        ("SOURCE", _SOURCE_TEXT, (source_edge + north) / 2, scenario.source),
    ):
        height = min(0.42 * stretch, 0.4 * depth, 0.7 * scenario.width / text_width(word, 1.0))
        letters = painted(word, height).moved(y=middle, z=_LETTERS_Z * stretch)
        _flat(scene, f"{root}/{word.lower()}_label", letters, colour)
    _draw_lamp(scene, f"{root}/light", north, scenario.light)


def draw_backdrop(scene: viser.SceneApi) -> None:
    """Lights and background that are the same for every arena."""
    # viser's own lights bleach pale colours; shadows would halve the frame rate.
    scene.configure_default_lights(enabled=False, cast_shadow=False)
    scene.configure_environment_map(None)
    scene.add_light_hemisphere(
        "/daylight", sky_color=(255, 255, 255), ground_color=(150, 155, 175), intensity=2.5
    )
    scene.add_light_directional(
        "/sunlight", color=(255, 244, 224), intensity=2.0, position=(-2.0, -1.0, 4.0)
    )
    scene.set_background_image(_backdrop(), format="png")


def _walls(east: float, north: float) -> Mesh:
    thick, up = WALL_THICKNESS, (0.0, WALL_HEIGHT)
    along_x, along_y = (-east - thick, east + thick), (-north, north)
    return merged(
        (
            box(along_x, (north, north + thick), up),
            box(along_x, (-north - thick, -north), up),
            box((east, east + thick), along_y, up),
            box((-east - thick, -east), along_y, up),
        )
    )


def _stretch(scenario: Scenario) -> float:
    """How much larger than usual an arena is: seen from so far, thin layers would show through."""
    return max(1.0, scenario.width / 25.0, scenario.length / 25.0)


def _table(east: float, north: float, stretch: float) -> Mesh:
    """A slab that the arena stands on, with room for the lamp in the north."""
    x, y = east + MARGIN, north + MARGIN
    return box((-x, x), (-y, y), (-0.10 * stretch, _TABLE_TOP * stretch))


def _scale_bar(east: float, north: float) -> Mesh:
    """One metre on the table in front of the south wall, at the west end."""
    bar = line(((0.0, 0.045), (0.0, 0.0), (1.0, 0.0), (1.0, 0.045)), 0.014)
    words = painted("1 m", 0.085).moved(x=0.5, y=0.074)
    return (bar + words).moved(-east, -north - MARGIN + 0.08, _TABLE_TOP + _LETTERS_Z)


def _draw_lamp(scene: viser.SceneApi, name: str, north: float, distance: float) -> None:
    """The light is too far away to be shown in its place: a glowing ball on its bearing."""
    at = np.array((0.0, north + LAMP_DISTANCE, LAMP_HEIGHT))
    scene.add_icosphere(
        f"{name}/ball", LAMP_RADIUS, color=(255, 236, 170), position=at, cast_shadow=False
    )
    scene.add_image(
        f"{name}/glow",
        _glow(),
        2 * GLOW_RADIUS,
        2 * GLOW_RADIUS,
        position=tuple(at - 1.2 * LAMP_RADIUS * FORWARD),
        wxyz=_FACING_CAMERA,
        cast_shadow=False,
        receive_shadow=False,
    )
    scene.add_label(
        f"{name}/label",
        f"light, {distance:g} m north",
        position=(0.0, at[1], LAMP_HEIGHT + 0.16),
        anchor="bottom-center",
        font_screen_scale=1.2,
    )


_TILT = np.pi / 2 - ELEVATION
_FACING_CAMERA = (np.cos(_TILT / 2), np.sin(_TILT / 2), 0.0, 0.0)
"""Turns a picture, which viser lays in its x-y plane, to a camera in its usual place."""


def _glow(size: int = 128) -> npt.NDArray[np.uint8]:
    """A soft disc of light, shape (size, size, 4), RGBA."""
    axis = np.linspace(-1.0, 1.0, size)
    radius = np.hypot(axis[:, None], axis[None, :])
    picture = np.empty((size, size, 4), dtype=np.uint8)
    picture[..., :3] = palette.LIGHT
    picture[..., 3] = 235 * np.clip(1.0 - radius, 0.0, 1.0) ** 2
    return picture


def _backdrop(height: int = 256) -> npt.NDArray[np.uint8]:
    """Sky from warm in the north to cool at the viewer, shape (height, 8, 3), RGB."""
    top, bottom = np.array((74, 82, 104.0)), np.array((26, 29, 40.0))
    blend = np.linspace(0.0, 1.0, height)[:, None, None]
    column = (1.0 - blend) * top + blend * bottom
    return np.repeat(column, 8, axis=1).astype(np.uint8)


def _flat(scene: viser.SceneApi, name: str, mesh: Mesh, colour: Colour) -> None:
    scene.add_mesh_simple(
        name, mesh.vertices, mesh.faces, color=colour, cast_shadow=False, receive_shadow=False
    )
