"""A 3D arena: draws one world and follows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import viser

from geswarm.sim import Scenario, vocabulary_of
from geswarm.sim.bodies import E_PUCK, FOOT_BOT

from .. import palette
from ..palette import Colour
from ..state.view import ArenaView, Kind
from .detail import MOST_IN_FULL, Detail
from .epuck import distant_epuck, epuck
from .footbot import distant_footbot, distant_puck, footbot, puck, yaw_quaternions
from .points import Points
from .scenery import draw_scenery
from .shapes import Mesh

_BODY: Colour = (66, 71, 84)
_TRIM: Colour = (240, 241, 244)
_LOOKS = {FOOT_BOT.name: (footbot, distant_footbot), E_PUCK.name: (epuck, distant_epuck)}
"""Of each body: as it is, and with few triangles."""
_UPRIGHT = np.array((1.0, 0.0, 0.0, 0.0), dtype=np.float32)


@dataclass(frozen=True)
class RobotHandles:
    """One batch per part of the robots; instance i is robot i."""

    shadows: viser.BatchedMeshHandle
    glows: viser.BatchedMeshHandle
    bodies: viser.BatchedMeshHandle
    trims: viser.BatchedMeshHandle
    leds: viser.BatchedMeshHandle
    carried: viser.BatchedMeshHandle

    @property
    def posed(self) -> tuple[viser.BatchedMeshHandle, ...]:
        """The batches that follow position and heading."""
        return self.bodies, self.trims, self.leds, self.carried

    def remove(self) -> None:
        """Take all robots from the screen."""
        for part in (self.shadows, self.glows, *self.posed):
            part.remove()


@dataclass
class ArenaHandles:
    """What is on the screen; None for robots or objects that there are none of.

    Attributes:
        detail: How robots and objects are drawn: as points, or else as one batch per part.
    """

    root: viser.FrameHandle
    detail: Detail = Detail.FULL
    robots: RobotHandles | None = None
    objects: viser.BatchedMeshHandle | None = None
    points: Points | None = None

    def clear(self) -> None:
        """Take robots and objects from the screen."""
        for part in (self.robots, self.objects, self.points):
            if part is not None:
                part.remove()
        self.robots = self.objects = self.points = None


OnMade: TypeAlias = Callable[[Kind, tuple[viser.BatchedMeshHandle, ...]], None]


class ShownArena:
    """Draws a scenario once and a view of its world as often as wanted.

    Args:
        root: Node of the scene that everything of it is below.
        on_made: Called with the batches that are the robots, or the objects, whenever new ones
            have been made; instance i is number i.
    """

    def __init__(self, root: str = "/arena", on_made: OnMade | None = None) -> None:
        self.root = root
        self.on_made = on_made
        self.handles: ArenaHandles | None = None

    def build(
        self, scene: viser.SceneApi, scenario: Scenario, at: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        """Draw a scenario, instead of the one drawn before if there is one.

        Robots and objects appear with the next `sync`.

        Args:
            scene: Where to draw.
            scenario: Arena, zones and light.
            at: Where the centre of the arena is in the scene, metres.
        """
        self.remove()
        self._scene, self._extent = scene, max(scenario.width, scenario.length)
        self._looks = _LOOKS[scenario.body]
        self._colours = palette.behaviour_colours(vocabulary_of(scenario))
        self._linear = np.array([palette.linear(c) for c in self._colours], dtype=np.uint8)
        self.handles = ArenaHandles(
            scene.add_frame(self.root, show_axes=False, position=(*at, 0.0))
        )
        draw_scenery(scene, self.root, scenario)

    def remove(self) -> None:
        """Take everything from the screen."""
        if self.handles is not None:
            self.handles.root.remove()
            self.handles = None

    def sync(self, view: ArenaView, detail: Detail | None = None) -> None:
        """Show a view: assigns to what is there; made anew only for other counts or details.

        Args:
            view: Robots and objects.
            detail: How finely to draw them; None as finely as suits so many.
        """
        if (handles := self.handles) is None:
            raise RuntimeError("ShownArena.sync: expected build() to be called before")
        if detail is None:
            detail = Detail.FULL if len(view.x) <= MOST_IN_FULL else Detail.SIMPLE
        if detail is not handles.detail:
            handles.clear()
            handles.detail = detail
        if detail is Detail.POINTS:
            if handles.points is None:
                handles.points = Points(self._scene, self.root, self._extent, self._colours)
            handles.points.sync(view)
            return
        self._sync_robots(handles, view)
        self._sync_objects(handles, view)

    def _sync_robots(self, handles: ArenaHandles, view: ArenaView) -> None:
        count = len(view.x)
        if handles.robots is None or len(handles.robots.bodies.batched_positions) != count:
            if handles.robots is not None:
                handles.robots.remove()
            handles.robots = self._new_robots(count, handles.detail) if count else None
        robots = handles.robots
        if robots is None:
            return
        positions = np.zeros((count, 3), dtype=np.float32)
        positions[:, 0], positions[:, 1] = view.x, view.y
        quaternions = yaw_quaternions(view.theta)
        robots.shadows.batched_positions = robots.glows.batched_positions = positions
        for batch in robots.posed:
            batch.batched_positions = positions
            batch.batched_wxyzs = quaternions
        colours = self._linear[np.asarray(view.behaviour)]
        robots.leds.batched_colors = robots.glows.batched_colors = colours
        robots.carried.batched_scales = np.asarray(view.carried, dtype=np.float32)

    def _sync_objects(self, handles: ArenaHandles, view: ArenaView) -> None:
        count = len(view.objects)
        if handles.objects is None or len(handles.objects.batched_positions) != count:
            if handles.objects is not None:
                handles.objects.remove()
            mesh = puck() if handles.detail is Detail.FULL else distant_puck()
            new = self._batch("objects", mesh, count, palette.OBJECT) if count else None
            handles.objects = new
            if new is not None:
                self._tell("object", (new,))
        if handles.objects is not None:
            positions = np.zeros((count, 3), dtype=np.float32)
            positions[:, :2] = view.objects
            handles.objects.batched_positions = positions

    def _new_robots(self, count: int, detail: Detail) -> RobotHandles:
        near, far = self._looks
        look = near() if detail is Detail.FULL else far()

        def batch(
            name: str, mesh: Mesh, colour: Colour, opacity: float | None = None
        ) -> viser.BatchedMeshHandle:
            return self._batch(name, mesh, count, colour, opacity)

        robots = RobotHandles(
            shadows=batch("shadows", look.shadow, (10, 12, 18), 0.4),
            glows=batch("glows", look.glow, _TRIM, 0.13),
            bodies=batch("bodies", look.body, _BODY),
            trims=batch("trims", look.trim, _TRIM),
            leds=batch("leds", look.leds, _TRIM),
            carried=batch("carried", look.carried, palette.OBJECT),
        )
        self._tell("robot", robots.posed)
        return robots

    def _tell(self, kind: Kind, batches: tuple[viser.BatchedMeshHandle, ...]) -> None:
        if self.on_made is not None:
            self.on_made(kind, batches)

    def _batch(
        self,
        name: str,
        mesh: Mesh,
        count: int,
        colour: Colour,
        opacity: float | None = None,
    ) -> viser.BatchedMeshHandle:
        return self._scene.add_batched_meshes_simple(
            f"{self.root}/{name}",
            mesh.vertices,
            mesh.faces,
            batched_wxyzs=np.tile(_UPRIGHT, (count, 1)),
            batched_positions=np.zeros((count, 3), dtype=np.float32),
            batched_scales=np.ones(count, dtype=np.float32),
            batched_colors=np.tile(np.array(palette.linear(colour), dtype=np.uint8), (count, 1)),
            opacity=opacity,
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )
