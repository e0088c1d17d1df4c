"""The parts of the arena that do not move: ground, walls, obstacles, lamps and the backdrop."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import viser

from geswarm.sim import Scenario
from geswarm.sim.arena.geometry import corners
from geswarm.sim.arena.model import Obstacle

from .. import palette
from ..palette import Colour
from .ground import LETTER_HEIGHT, as_shown, floors, signs
from .lamps import draw_lamp, lamp_of
from .lettering import painted
from .plane import rim, wall
from .shapes import Mesh, box, line, merged, prism

WALL_HEIGHT = 0.07
WALL_THICKNESS = 0.05
OBSTACLE_HEIGHT = 0.11
MARGIN = 0.28
"""Of the table around the arena, m."""

_WALL: Colour = (168, 174, 188)
_OBSTACLE: Colour = (138, 146, 166)
_TABLE: Colour = (84, 90, 106)
_MARKING: Colour = (206, 210, 220)
_LETTERS_Z = 0.004
_APRON_WIDTH, _APRON_Z = 0.11, 0.0073
"""Of the table along the walls, m; it lies above the light of robots, which stays inside so."""
_TABLE_TOP = -0.004


def outer_points(scenario: Scenario) -> npt.NDArray[np.float64]:
    """Points that enclose all that must be in the picture, shape (n, 3), metres."""
    east, north = scenario.width / 2 + MARGIN, scenario.length / 2 + MARGIN
    ground = [(x, y, z) for x in (-east, east) for y in (-north, north) for z in (0.0, 0.15)]
    arena = scenario.arena
    lamps = [point for light in arena.lights for point in lamp_of(arena, light).outermost]
    return np.array(ground + lamps)


def draw_scenery(scene: viser.SceneApi, root: str, scenario: Scenario) -> None:
    """Draw everything that does not move, as children of the node `root`."""
    arena, east, north = as_shown(scenario), scenario.width / 2, scenario.length / 2
    stretch = _stretch(scenario)
    for number, (mesh, colour) in enumerate(floors(arena, stretch)):
        _flat(scene, f"{root}/floor_{number}", mesh, colour)
    apron = rim(arena.outline, _APRON_WIDTH).moved(z=_APRON_Z)
    _flat(scene, f"{root}/apron", apron, _TABLE)
    foot = _TABLE_TOP * stretch  # of what stands on the table: no light shines through below it
    walls = wall(arena.outline, WALL_THICKNESS, WALL_HEIGHT - foot).moved(z=foot)
    _flat(scene, f"{root}/walls", walls, _WALL)
    if arena.obstacles:
        solids = merged([_solid(obstacle, foot) for obstacle in arena.obstacles])
        _flat(scene, f"{root}/obstacles", solids, _OBSTACLE)
    _flat(scene, f"{root}/table", _table(east, north, stretch), _TABLE)
    _flat(scene, f"{root}/scale", _scale_bar(east, north), _MARKING)
    for sign in signs(arena, LETTER_HEIGHT * stretch):
        letters = painted(sign.text, sign.height).moved(*sign.at, _LETTERS_Z * stretch)
        _flat(scene, f"{root}/{sign.area}_label", letters, palette.on_ground(sign.ground))
    for number, light in enumerate(arena.lights):
        name = f"{root}/light_{number}" if number else f"{root}/light"
        draw_lamp(scene, name, lamp_of(arena, light))


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


def _solid(obstacle: Obstacle, foot: float) -> Mesh:
    """An obstacle, from the level of its foot (m) on."""
    return prism([(float(x), float(y)) for x, y in corners(obstacle)], foot, OBSTACLE_HEIGHT)


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
    words = painted("1 m", 0.085).moved(x=0.5, y=0.078)
    return (bar + words).moved(-east, -north - MARGIN + 0.05, _TABLE_TOP + _LETTERS_Z)


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
