"""Robots and objects as points, for swarms that are too large for a browser to draw otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import viser

from geswarm.sim.footbot import RADIUS

from .. import palette
from ..palette import Colour
from ..state.view import ArenaView
from .footbot import HEIGHT, OBJECT_HEIGHT

_PER_EXTENT = 1 / 300
"""Least diameter of a point by the extent of the arena: about two pixels."""


class Points:
    """Two clouds in one arena: a robot has the colour of its behaviour, an object its own.

    Args:
        scene: Where to draw.
        root: Node of the arena.
        extent: Of the arena, the larger of width and length, metres.
        colours: Of each behaviour.
    """

    def __init__(
        self, scene: viser.SceneApi, root: str, extent: float, colours: Sequence[Colour]
    ) -> None:
        self._colours = np.array(colours, dtype=np.uint8)
        size = max(2 * RADIUS, _PER_EXTENT * extent)
        nothing = np.zeros((0, 3), dtype=np.float32)
        self.robots, self.objects = (
            scene.add_point_cloud(
                f"{root}/{name}_as_points",
                nothing,
                nothing.astype(np.uint8),
                point_size=point_size,
                point_shape="circle",
                point_shading="flat",
                precision="float32",
            )
            for name, point_size in (("robots", size), ("objects", 0.6 * size))
        )

    def sync(self, view: ArenaView) -> None:
        """Show a view; objects that are carried are on top of their robots."""
        places = np.column_stack((view.x, view.y, np.full(len(view.x), HEIGHT)))
        self.robots.points = places.astype(np.float32)
        self.robots.colors = self._colours[np.asarray(view.behaviour)]
        lying = np.column_stack((view.objects, np.full(len(view.objects), OBJECT_HEIGHT)))
        carried = places[np.asarray(view.carried)] + (0.0, 0.0, OBJECT_HEIGHT)
        objects = np.concatenate((lying, carried)).astype(np.float32)
        self.objects.points = objects
        self.objects.colors = np.tile(np.array(palette.OBJECT, dtype=np.uint8), (len(objects), 1))

    def remove(self) -> None:
        """Take all points from the screen."""
        self.robots.remove()
        self.objects.remove()
