"""The kernel that starts simulations.

It is built by a function so that `geswarm.sim.compiled` can tell numba's cache about all sources: a
kernel that mentions `version` has it in its cache key. That is why it returns it.
"""

from __future__ import annotations

from typing import Any

from geswarm.sim.kernels.jit import kernel
from geswarm.sim.kernels.placement import start
from geswarm.sim.kernels.state import Physics


def build_start_all(version: int) -> Any:
    """The kernel that starts simulations; `version` becomes part of its cache key."""

    @kernel
    def start_all(
        physics: Physics, swarms: Any, slots: Any, starts: Any, objects: Any, simulations: Any
    ) -> int:
        """Write the state at the start of each simulation.

        Args:
            physics: Scenario in numbers, float64.
            swarms: Of ROBOT, shape (simulations, robots).
            slots: Working space, see `neighbours.enter`.
            starts: Working space.
            objects: float64, shape (simulations, objects, 2).
            simulations: int64, shape (simulations, 4): table, seed, individual, replicate.
        """
        for number in range(len(simulations)):
            _, seed, individual, replicate = simulations[number]
            swarm, items = swarms[number], objects[number]
            start(physics, swarm, slots, starts, items, seed, individual, replicate)
        return version

    return start_all
