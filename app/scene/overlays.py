"""What is drawn over the arena on request: selection, sensing ranges, trails, visit heat map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
import viser

from geswarm.sim import Scenario, vocabulary_of
from geswarm.sim.arena.geometry import corners, distances
from geswarm.sim.arena.model import Box, Outline
from geswarm.sim.footbot import RADIUS

from .. import palette
from ..palette import Colour
from ..state.trace import PathTrace, Trails
from ..state.view import ArenaView, Shown
from .shapes import Mesh, annulus

_ROOT = "/overlays"
_RING_Z, _RANGE_Z, _TRAIL_Z, _VISITS_Z = 0.0090, 0.0084, 0.0074, 0.0045
_FADED: Colour = (214, 215, 218)  # an old trail is nearly as pale as the ground

RANGE_COLOURS: dict[str, Colour] = {
    "grip reach": palette.OBJECT,
    "proximity": (40, 44, 56),
    "range and bearing": (140, 86, 200),
}
"""Colour of the circle of each sensing range."""

_LINEAR = np.array([palette.linear((c, c, c))[0] for c in range(256)], dtype=np.uint8)
"""What viser's lines take for each sRGB value."""

HEAT: tuple[Colour, ...] = ((255, 232, 140), (252, 152, 60), (226, 62, 40), (120, 8, 50))
"""Colours of the heat map, from places that are visited rarely to those visited often."""


def sensing_ranges(scenario: Scenario) -> dict[str, float]:
    """Radius of each range around the robot's centre, metres."""
    grip = {"grip reach": scenario.grip_reach} if scenario.objects else {}
    return {
        **grip,
        "proximity": RADIUS + scenario.proximity_range,
        "range and bearing": scenario.rab_range,
    }


@dataclass
class OverlayHandles:
    """What is on the screen of it."""

    ring: viser.FrameHandle
    visits: viser.ImageHandle
    trails: viser.LineSegmentsHandle | None = None
    ranges: tuple[viser.BatchedMeshHandle, ...] = ()


class Overlays:
    """Draws them for one arena at the origin of the scene; what is switched off costs nothing."""

    handles: OverlayHandles

    def __init__(self) -> None:
        self._root: viser.FrameHandle | None = None
        self._trail_samples = self._visit_samples = -1
        self._radii: dict[str, float] = {}

    def build(self, scene: viser.SceneApi, scenario: Scenario) -> None:
        """Begin with a scenario, instead of the one before if there is one."""
        if self._root is not None:
            self._root.remove()
        self._scene = scene
        self._colours = palette.behaviour_colours(vocabulary_of(scenario))
        self._root = scene.add_frame(_ROOT, show_axes=False)
        ring = scene.add_frame(f"{_ROOT}/selected", show_axes=False, visible=False)
        for name, inside, outside, colour in (
            ("light", 0.122, 0.150, (255, 255, 255)),
            ("dark", 0.150, 0.164, (20, 22, 30)),
        ):
            mesh = annulus(inside, outside, 48).moved(z=_RING_Z)
            scene.add_mesh_simple(
                f"{_ROOT}/selected/{name}",
                mesh.vertices,
                mesh.faces,
                color=colour,
                cast_shadow=False,
                receive_shadow=False,
            )
        visits = scene.add_image(
            f"{_ROOT}/visits",
            np.zeros((2, 2, 4), dtype=np.uint8),
            scenario.width,
            scenario.length,
            position=(0.0, 0.0, _VISITS_Z),
            cast_shadow=False,
            receive_shadow=False,
            visible=False,
        )
        self.handles = OverlayHandles(ring, visits)
        self._trail_samples = self._visit_samples = -1

    def sync_robots(self, view: ArenaView, selected: int | None, shown: Shown) -> None:
        """What goes with the robots, every frame."""
        ring = self.handles.ring
        ring.visible = selected is not None
        if selected is not None:
            ring.position = (float(view.x[selected]), float(view.y[selected]), 0.0)
        count = len(view.x)
        lit = np.zeros(count, dtype=np.float32)
        if shown.ranges == "all":
            lit[:] = 1.0
        elif shown.ranges == "selected" and selected is not None:
            lit[selected] = 1.0
        positions = np.zeros((count, 3), dtype=np.float32)
        positions[:, 0], positions[:, 1] = view.x, view.y
        for batch in self.handles.ranges:
            batch.visible = bool(lit.any())
            if batch.visible:
                batch.batched_positions, batch.batched_scales = positions, lit

    def sync_ranges(self, scenario: Scenario, shown: Shown) -> None:
        """Make the circles anew if their number or their radii have changed."""
        radii = sensing_ranges(scenario) if shown.ranges != "none" else {}
        batches = self.handles.ranges
        same = not batches or len(batches[0].batched_positions) == scenario.robots
        if radii == self._radii and same and bool(batches) == bool(radii):
            return
        self._radii = radii
        for batch in batches:
            batch.remove()
        self.handles.ranges = tuple(
            self._circles(name, radius, scenario.robots) for name, radius in radii.items()
        )

    def sync_trace(self, trace: PathTrace, shown: Shown) -> None:
        """Trails, if a sample has come since they were drawn."""
        if not shown.trails:
            if self.handles.trails is not None:
                self.handles.trails.visible = False
            return
        if trace.samples == self._trail_samples and self.handles.trails is not None:
            self.handles.trails.visible = True
            return
        self._trail_samples = trace.samples
        points, colours = trail_segments(trace.trails(), self._colours)
        trails = self.handles.trails
        if trails is None or trails.points.shape != points.shape:
            self.handles.trails = self._scene.add_line_segments(
                f"{_ROOT}/trails", points, colours, thickness=3.0, thickness_units="screen"
            )
            return
        trails.visible = True
        trails.points, trails.colors = points, colours

    def sync_visits(self, trace: PathTrace, shown: Shown) -> None:
        """The heat map, if a sample has come since it was drawn; not for every frame."""
        image = self.handles.visits
        image.visible = shown.visits
        if shown.visits and trace.samples != self._visit_samples:
            self._visit_samples = trace.samples
            picture = heat_map(trace.visits)
            picture[outside(trace)] = 0
            image.image = picture[::-1]  # viser draws its first row in the south

    def _circles(self, name: str, radius: float, count: int) -> viser.BatchedMeshHandle:
        mesh: Mesh = annulus(radius - 0.006, radius + 0.006, 64)
        colour = np.array(palette.linear(RANGE_COLOURS[name]), dtype=np.uint8)
        return self._scene.add_batched_meshes_simple(
            f"{_ROOT}/{name.replace(' ', '_')}",
            mesh.moved(z=_RANGE_Z).vertices,
            mesh.faces,
            batched_wxyzs=np.tile(np.array((1.0, 0.0, 0.0, 0.0), dtype=np.float32), (count, 1)),
            batched_positions=np.zeros((count, 3), dtype=np.float32),
            batched_scales=np.zeros(count, dtype=np.float32),
            batched_colors=np.tile(colour, (count, 1)),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
            visible=False,
        )


def trail_segments(
    trails: Trails, of_behaviours: Sequence[Colour]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]:
    """Points, shape (segments, 2, 3), metres, and colours, same shape, fading with age."""
    points = np.full((*trails.ends.shape[:2], 3), _TRAIL_Z, dtype=np.float32)
    points[..., :2] = trails.ends
    vivid = np.array(of_behaviours, dtype=float)[trails.behaviour]
    age = 0.9 * trails.age[:, None] ** 1.5
    colours = (1.0 - age) * vivid + age * np.array(_FADED, dtype=float)
    return points, np.repeat(_LINEAR[colours.astype(np.uint8)][:, None], 2, axis=1)


def outside(trace: PathTrace) -> npt.NDArray[np.bool_]:
    """Which cells of the visits are outside the walls, shape (rows, columns), north first."""
    rows, columns = trace.visits.shape
    return _outside(trace.scenario.arena.outline, rows, columns)


@lru_cache(maxsize=4)
def _outside(outline: Outline, rows: int, columns: int) -> npt.NDArray[np.bool_]:
    if isinstance(outline, Box):
        return np.zeros((rows, columns), dtype=np.bool_)
    reach = np.abs(corners(outline)).max(axis=0)
    x = ((np.arange(columns) + 0.5) / columns * 2.0 - 1.0) * reach[0]
    y = (1.0 - (np.arange(rows) + 0.5) / rows * 2.0) * reach[1]
    points = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)
    found: npt.NDArray[np.bool_] = (distances(outline, points) > 0.0).reshape(rows, columns)
    return found


def _softened(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Each cell with half of its neighbours: a robot is wider than a cell."""
    padded = np.pad(values, 1, mode="edge")
    rows = padded[:-2] + 2.0 * padded[1:-1] + padded[2:]
    return (rows[:, :-2] + 2.0 * rows[:, 1:-1] + rows[:, 2:]) / 16.0


def heat_map(visits: npt.NDArray[np.int64]) -> npt.NDArray[np.uint8]:
    """Picture of how often each cell was visited, same rows and columns, RGBA."""
    soft = _softened(_softened(visits.astype(float)))
    busy = soft[soft > 0.0]
    heat = np.clip(soft / np.percentile(busy, 99.0), 0.0, 1.0) if busy.size else soft
    heat = heat**0.7  # rare visits are seen, too
    picture = np.empty((*heat.shape, 4), dtype=np.uint8)
    colours = np.array(HEAT, dtype=float)
    at = heat * (len(colours) - 1)
    for channel in range(3):
        picture[..., channel] = np.interp(at, range(len(colours)), colours[:, channel])
    picture[..., 3] = 205.0 * np.clip(1.5 * heat, 0.0, 1.0)
    return picture
