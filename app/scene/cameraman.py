"""Keeps the arenas in the picture of every browser, or follows one robot."""

from __future__ import annotations

from weakref import WeakKeyDictionary, WeakSet

import numpy as np
import numpy.typing as npt
import viser

from .camera import FARTHEST, FIELD_OF_VIEW, FORWARD, NEAREST, NOTHING, CameraPose, framing

CLOSE = 3.2
"""From the camera to the robot that it follows, m."""

_EASE = 0.15  # of the way to the robot, in each frame


class Cameraman:
    """Aims the cameras, until a user takes one elsewhere.

    A browser tells the shape of its window, and with it where its camera belongs, only when it has
    drawn from somewhere else: until then its camera sees nothing.
    """

    def __init__(self) -> None:
        self._poses: WeakKeyDictionary[viser.ClientHandle, CameraPose] = WeakKeyDictionary()
        self._welcomed: WeakSet[viser.ClientHandle] = WeakSet()
        self._followed: npt.NDArray[np.float64] | None = None

    def build(self, server: viser.ViserServer, points: npt.NDArray[np.float64]) -> None:
        """Begin, with these points in the picture; shape (n, 3), metres."""
        self._server = server
        server.initial_camera.far = NOTHING
        self.frame(points)
        server.on_client_connect(self._welcome)

    def frame(self, points: npt.NDArray[np.float64]) -> None:
        """Turn all cameras so that these points are in the picture; shape (n, 3), metres."""
        self._points = points
        self._usual_pose = pose = framing(points)
        camera = self._server.initial_camera
        camera.fov, camera.near = FIELD_OF_VIEW, NEAREST
        camera.position, camera.look_at = pose.position, pose.look_at
        if self._followed is None:
            self._aim_all()

    def follow(self, place: tuple[float, float] | None) -> None:
        """Go with a robot at (x, y) (m), nearer if it is a new one; None goes back."""
        if place is None:
            if self._followed is not None:
                self._followed = None
                self._aim_all()
            return
        target = np.array((*place, 0.05))
        if self._followed is None:
            self._followed = target
            for client in self._welcomed_clients():
                _go_near(client, target)
            return
        self._followed = target = self._followed + _EASE * (target - self._followed)
        for client in self._welcomed_clients():
            # Where it is may be old news; from which side it looks is right, and the user's choice.
            _look_at(client, target, client.camera.position - client.camera.look_at)

    def _welcomed_clients(self) -> list[viser.ClientHandle]:
        """Those that are connected and have told where their camera is."""
        return [c for c in self._server.get_clients().values() if c in self._welcomed]

    def _welcome(self, client: viser.ClientHandle) -> None:
        client.camera.on_update(self._moved)
        self._welcomed.add(client)
        if self._followed is None:
            self._moved(client.camera)
        else:
            _go_near(client, self._followed)

    def _moved(self, camera: viser.CameraHandle) -> None:
        """Let a camera see, once it is where it belongs."""
        if not self._keep_framed(camera) and camera.far < FARTHEST:
            camera.far = FARTHEST

    def _keep_framed(self, camera: viser.CameraHandle) -> bool:
        """Fit the picture to the shape of the window, until the user takes the camera elsewhere.

        Returns:
            True if the camera was turned.
        """
        if self._followed is not None:
            return False
        poses = (self._usual_pose, self._poses.get(camera.client))
        blind = camera.far < FARTHEST  # nobody has taken it anywhere
        ours = any(pose is not None and pose.is_at(camera.position) for pose in poses)
        return (blind or ours) and self._aim(camera.client)

    def _aim_all(self) -> None:
        for client in self._server.get_clients().values():
            self._aim(client)

    def _aim(self, client: viser.ClientHandle) -> bool:
        """Turn one camera so that all points are in the picture, whatever its shape.

        Returns:
            True if it had to be turned.
        """
        pose = framing(self._points, client.camera.aspect)
        self._poses[client] = pose
        if pose.is_at(client.camera.position):
            return False
        with client.atomic():
            client.camera.position, client.camera.look_at = pose.position, pose.look_at
        return True


def _go_near(client: viser.ClientHandle, target: npt.NDArray[np.float64]) -> None:
    _look_at(client, target, -CLOSE * FORWARD)


def _look_at(
    client: viser.ClientHandle, target: npt.NDArray[np.float64], side: npt.NDArray[np.float64]
) -> None:
    """Aim a camera at a point from `side` away of it."""
    with client.atomic():
        client.camera.position, client.camera.look_at = target + side, target
