"""The kernels that start simulations.

They are built by functions so that `geswarm.sim.compiled` can tell numba's cache about all sources:
a kernel that mentions `version` has it in its cache key. That is why they return it.
"""

from __future__ import annotations

from typing import Any

from geswarm.sim.kernels.free import gap_around, is_free
from geswarm.sim.kernels.jit import kernel
from geswarm.sim.kernels.placement import start
from geswarm.sim.kernels.state import Beginning, Places


def build_start_all(version: int) -> Any:
    """The kernel that starts simulations; `version` becomes part of its cache key."""

    @kernel
    def start_all(
        places: Places,
        beginning: Beginning,
        swarms: Any,
        slots: Any,
        starts: Any,
        order: Any,
        objects: Any,
        simulations: Any,
        placed: Any,
    ) -> int:
        """Write the state at the start of each simulation.

        Args:
            places: Where robots start and objects lie.
            beginning: What robots start with.
            swarms: Of ROBOT, shape (simulations, robots).
            slots: Working space, see `neighbours.enter`.
            starts: Working space.
            order: Working space, int64, shape (spots,).
            objects: float64, shape (simulations, objects, 2).
            simulations: int64, shape (simulations, 4): table, seed, individual, replicate.
            placed: bool, shape (simulations,): whether all robots have a place.
        """
        for number in range(len(simulations)):
            keys = simulations[number]
            swarm, items = swarms[number], objects[number]
            placed[number] = start(
                places, beginning, swarm, slots, starts, order, items, keys[1], keys[2], keys[3]
            )
        return version

    return start_all


def build_look_around(version: int) -> Any:
    """The kernel that says where robots may stand; `version` becomes part of its cache key."""

    @kernel
    def look_around(places: Places, points: Any, free: Any, gaps: Any) -> int:
        """Look around at some points.

        Args:
            places: Where robots start.
            points: float64, shape (points, 2).
            free: bool, shape (points,): whether a robot may start there, see `free.is_free`.
            gaps: float64, shape (points,): see `free.gap_around`.
        """
        for number in range(len(points)):
            x, y = points[number, 0], points[number, 1]
            free[number] = is_free(places, x, y)
            gaps[number] = gap_around(places, x, y)
        return version

    return look_around
