"""The kernels that run one simulation: by rules (says which fired), or by control table (faster).

They are built by functions so that `geswarm.sim.compiled` can tell the cache about all sources:
a kernel that mentions `version` has it in its cache key. That is why they return it.
"""

from __future__ import annotations

from typing import Any

from geswarm.sim.kernels.control import act_on_objects, decide_by_rules, decide_by_table, sense
from geswarm.sim.kernels.draws import WALK_HEADING, WALK_TIME
from geswarm.sim.kernels.jit import kernel
from geswarm.sim.kernels.motion import move
from geswarm.sim.kernels.neighbours import avoid_robots, collide, sort_objects
from geswarm.sim.kernels.placement import restart_walk, start
from geswarm.sim.kernels.state import Physics


def build_start(version: int) -> Any:
    """The kernel that starts a simulation; `version` becomes part of its cache key."""

    @kernel
    def start_world(
        physics: Physics,
        robots: Any,
        slots: Any,
        starts: Any,
        objects: Any,
        seed: int,
        individual: int,
        replicate: int,
    ) -> int:
        """Write the state at the start."""
        start(physics, robots, slots, starts, objects, seed, individual, replicate)
        return version

    return start_world


def build_run_world(version: int) -> Any:
    """The interpreting kernel; `version` becomes part of its cache key."""

    @kernel
    def run_world(
        physics: Physics,
        robots: Any,
        slots: Any,
        starts: Any,
        objects: Any,
        heads: Any,
        following: Any,
        tally: Any,
        rules: Any,
        actions: Any,
        decisions: Any,
        first: int,
        steps: int,
    ) -> int:
        """Run control steps first..first+steps-1, interpreting the rules."""
        sort_objects(physics, objects, heads, following)
        for step in range(first, first + steps):
            may_touch = avoid_robots(physics, robots, slots, starts)
            for i in range(len(robots)):
                robot = robots[i]
                sense(physics, robot, step)
                if decide_by_rules(rules, actions, decisions, robot, step):
                    restart_walk(physics, robot, step, WALK_HEADING, WALK_TIME)
                act_on_objects(physics, objects, heads, following, tally, robot, step)
                move(physics, robot, step)
            collide(physics, robots, slots, starts, may_touch)
        return version

    return run_world


def build_run_simulation(version: int) -> Any:
    """The control-table kernel; `version` becomes part of its cache key."""

    @kernel
    def run_simulation(
        physics: Physics,
        robots: Any,
        slots: Any,
        starts: Any,
        objects: Any,
        heads: Any,
        following: Any,
        tally: Any,
        table: Any,
        slot_bits: int,
        first: int,
        steps: int,
    ) -> int:
        """Run control steps first..first+steps-1, drawing from the control table."""
        sort_objects(physics, objects, heads, following)
        for step in range(first, first + steps):
            may_touch = avoid_robots(physics, robots, slots, starts)
            for i in range(len(robots)):
                robot = robots[i]
                if decide_by_table(physics, table, slot_bits, robot, step):
                    restart_walk(physics, robot, step, WALK_HEADING, WALK_TIME)
                act_on_objects(physics, objects, heads, following, tally, robot, step)
                move(physics, robot, step)
            collide(physics, robots, slots, starts, may_touch)
        return version

    return run_simulation
