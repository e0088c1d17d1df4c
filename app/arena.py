"""The live 3D arena: a panel that draws one world and follows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
import viser

from . import palette
from .camera import FIELD_OF_VIEW, NEAREST, CameraPose, framing
from .footbot import footbot, puck, yaw_quaternions
from .palette import Colour
from .scenery import ArenaShape, draw_backdrop, draw_scenery, outer_points
from .shapes import Mesh
from .view import ArenaView

ROOT = "/arena"

_BODY: Colour = (66, 71, 84)
_TRIM: Colour = (240, 241, 244)
_LED_COLOURS = np.array([palette.linear(c) for c in palette.BEHAVIOURS], dtype=np.uint8)
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

    @property
    def clickable(self) -> tuple[viser.BatchedMeshHandle, ...]:
        """The batches that are the robot itself."""
        return self.bodies, self.trims, self.leds

    def remove(self) -> None:
        """Take all robots from the screen."""
        for part in (self.shadows, self.glows, *self.posed):
            part.remove()


@dataclass
class ArenaHandles:
    """What is on the screen; None for robots or objects that there are none of."""

    root: viser.FrameHandle
    robots: RobotHandles | None = None
    objects: viser.BatchedMeshHandle | None = None


class Arena:
    """Draws a scenario once and a view of its world as often as wanted.

    Args:
        on_robot_click: Called with the robot's index when it is clicked, from a thread of viser's.
    """

    def __init__(self, on_robot_click: Callable[[int], None] | None = None) -> None:
        self.on_robot_click = on_robot_click
        self.handles: ArenaHandles | None = None
        self._poses: WeakKeyDictionary[viser.ClientHandle, CameraPose] = WeakKeyDictionary()

    def build(self, server: viser.ViserServer, shape: ArenaShape) -> None:
        """Draw the scenario; robots and objects appear with the first `sync`."""
        self._server = server
        draw_backdrop(server.scene)
        self.rebuild(shape)
        server.on_client_connect(self._welcome)

    def rebuild(self, shape: ArenaShape) -> None:
        """Draw another scenario instead, without robots or objects, and turn all cameras to it."""
        self._shape = shape
        self._usual_pose = pose = framing(outer_points(shape))
        camera = self._server.initial_camera
        with self._server.atomic():
            if self.handles is not None:
                self.handles.root.remove()
            root = self._server.scene.add_frame(ROOT, show_axes=False)
            self.handles = ArenaHandles(root)
            draw_scenery(self._server.scene, ROOT, shape)
            camera.fov, camera.near = FIELD_OF_VIEW, NEAREST
            camera.position, camera.look_at = pose.position, pose.look_at
        for client in self._server.get_clients().values():
            self._aim(client)

    def sync(self, view: ArenaView) -> None:
        """Show a view: assigns to the batches, and makes new ones only if counts have changed."""
        if self.handles is None:
            raise RuntimeError("Arena.sync: expected build() to be called before")
        with self._server.atomic():
            self._sync_robots(self.handles, view)
            self._sync_objects(self.handles, view)

    def _sync_robots(self, handles: ArenaHandles, view: ArenaView) -> None:
        count = len(view.x)
        if handles.robots is None or len(handles.robots.bodies.batched_positions) != count:
            if handles.robots is not None:
                handles.robots.remove()
            handles.robots = self._new_robots(count) if count else None
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
        colours = _LED_COLOURS[np.asarray(view.behaviour) % len(_LED_COLOURS)]
        robots.leds.batched_colors = robots.glows.batched_colors = colours
        robots.carried.batched_scales = np.asarray(view.carried, dtype=np.float32)

    def _sync_objects(self, handles: ArenaHandles, view: ArenaView) -> None:
        count = len(view.objects)
        if handles.objects is None or len(handles.objects.batched_positions) != count:
            if handles.objects is not None:
                handles.objects.remove()
            new = self._batch("objects", puck(), count, palette.OBJECT) if count else None
            handles.objects = new
        if handles.objects is not None:
            positions = np.zeros((count, 3), dtype=np.float32)
            positions[:, :2] = view.objects
            handles.objects.batched_positions = positions

    def _new_robots(self, count: int) -> RobotHandles:
        look = footbot()
        robots = RobotHandles(
            shadows=self._batch("shadows", look.shadow, count, (10, 12, 18), opacity=0.4),
            glows=self._batch("glows", look.glow, count, _TRIM, opacity=0.13),
            bodies=self._batch("bodies", look.body, count, _BODY),
            trims=self._batch("trims", look.trim, count, _TRIM),
            leds=self._batch("leds", look.leds, count, _TRIM),
            carried=self._batch("carried", look.carried, count, palette.OBJECT),
        )
        if self.on_robot_click is not None:
            for part in robots.clickable:
                part.on_click(self._clicked)
        return robots

    def _batch(
        self, name: str, mesh: Mesh, count: int, colour: Colour, opacity: float | None = None
    ) -> viser.BatchedMeshHandle:
        return self._server.scene.add_batched_meshes_simple(
            f"{ROOT}/{name}",
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

    def _clicked(self, event: viser.SceneNodePointerEvent[viser.BatchedMeshHandle]) -> None:
        if event.instance_index is not None and self.on_robot_click is not None:
            self.on_robot_click(event.instance_index)

    def _welcome(self, client: viser.ClientHandle) -> None:
        client.camera.on_update(self._keep_framed)
        self._keep_framed(client.camera)

    def _keep_framed(self, camera: viser.CameraHandle) -> None:
        """Fit the picture to the shape of the window, until the user takes the camera elsewhere."""
        poses = (self._usual_pose, self._poses.get(camera.client))
        if any(pose is not None and pose.is_at(camera.position) for pose in poses):
            self._aim(camera.client)

    def _aim(self, client: viser.ClientHandle) -> None:
        """Turn one camera so that the whole arena is in the picture, whatever its shape."""
        pose = framing(outer_points(self._shape), client.camera.aspect)
        self._poses[client] = pose
        if not pose.is_at(client.camera.position):
            with client.atomic():
                client.camera.position, client.camera.look_at = pose.position, pose.look_at
