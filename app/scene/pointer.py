"""The mouse in the arena: clicks select a robot, drags carry robots and objects about."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt
import viser

from ..state.view import ArenaView, Kind
from .footbot import HEIGHT

if TYPE_CHECKING:
    from ..state.session import Command, Session

Vector: TypeAlias = npt.ArrayLike
DragEvent: TypeAlias = viser.SceneNodeDragEvent[viser.BatchedMeshHandle]
ClickEvent: TypeAlias = viser.SceneNodePointerEvent[viser.BatchedMeshHandle]


_NEAR = 0.02  # of the way from the eye to the ground: so near to a point, a click is meant for it
_SAME_RAY = 0.005  # rad between two events of one click: viser rounds one of them to pixels


def on_level(eye: Vector, through: Vector, level: float) -> tuple[float, float] | None:
    """Where the ray from the eye through a point meets the plane z = level.

    Args:
        eye: Shape (3,), metres.
        through: Shape (3,), metres.
        level: Height of the plane, metres.

    Returns:
        x and y in metres, or None if the ray does not go down to the plane.
    """
    start = np.asarray(eye, dtype=float)
    way = np.asarray(through, dtype=float) - start
    if way[2] > -1e-6 or start[2] <= level:
        return None
    x, y, _ = start + way * (level - start[2]) / way[2]
    return float(x), float(y)


def nearest(view: ArenaView, place: tuple[float, float], within: float) -> int | None:
    """The robot nearest to a place, if one is within a distance, metres."""
    gaps = np.hypot(view.x - place[0], view.y - place[1])
    robot = int(np.argmin(gaps))
    return robot if gaps[robot] <= within else None


class Pointer:
    """Posts what the mouse does. viser keeps only asynchronous handlers in order.

    Attributes:
        points_only: Robots are drawn as points, which viser does not tell from the ground.
    """

    def __init__(self, post: Callable[[Command], None]) -> None:
        self.points_only = False
        self._post = post
        self._rays: dict[int, Vector] = {}  # way of the last click on a robot, by client
        self._grips: dict[int, tuple[float, float, float]] = {}

    def watch_ground(self, scene: viser.SceneApi) -> None:
        """Clicks beside all robots look away."""
        scene.on_click()(self._clicked_anywhere)  # type: ignore[arg-type]  # may be async

    def attach(self, kind: Kind, batches: tuple[viser.BatchedMeshHandle, ...]) -> None:
        """Make robots or objects react; instance i is number i."""
        for batch in batches:
            if kind == "robot":
                batch.on_click(self._clicked_robot)
            batch.on_drag("left")(self._drag_robot if kind == "robot" else self._drag_object)

    async def _clicked_robot(self, event: ClickEvent) -> None:
        index = event.instance_index
        if index is not None and event.ray_direction is not None:
            self._rays[event.client_id] = event.ray_direction
            self._post(lambda session: session.select(index))

    async def _clicked_anywhere(self, event: viser.SceneClickEvent) -> None:
        """The click on a robot comes again as a click on the scene, along the same ray."""
        if self.points_only:
            self._clicked_points(np.asarray(event.ray_origin), np.asarray(event.ray_direction))
            return
        robot = self._rays.pop(event.client_id, None)
        if robot is None or np.abs(np.subtract(robot, event.ray_direction)).max() > _SAME_RAY:
            self._post(lambda session: session.deselect())

    def _clicked_points(
        self, eye: npt.NDArray[np.float64], direction: npt.NDArray[np.float64]
    ) -> None:
        place = on_level(eye, eye + direction, HEIGHT)
        near = 0.0 if place is None else _NEAR * math.hypot(*(eye[:2] - place), eye[2])

        def select(session: Session) -> None:
            robot = None if place is None else nearest(session.view(), place, near)
            session.deselect() if robot is None else session.select(robot)

        self._post(select)

    async def _drag_robot(self, event: DragEvent) -> None:
        self._drag("robot", event)

    async def _drag_object(self, event: DragEvent) -> None:
        self._drag("object", event)

    def _drag(self, kind: Kind, event: DragEvent) -> None:
        index = event.instance_index
        if index is None or index >= len(event.target.batched_positions):
            return
        if event.phase == "end":
            self._grips.pop(event.client_id, None)
            self._post(lambda session: session.release())
            return
        if event.phase == "start":
            at = event.target.batched_positions[index]
            grip = np.asarray(event.start_position) - at
            self._grips[event.client_id] = (float(grip[0]), float(grip[1]), float(grip[2]))
        dx, dy, level = self._grips.get(event.client_id, (0.0, 0.0, 0.0))
        place = on_level(event.client.camera.position, event.end_position, level)
        if place is not None:
            x, y = place[0] - dx, place[1] - dy
            self._post(lambda session: session.hold(kind, index, x, y))
