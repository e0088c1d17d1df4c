"""The two kernels that run the model: by control table (fast), or by rules (says which fired).

They are built by functions so that `geswarm.sim.compiled` can tell numba's cache about all sources:
a kernel that mentions `version` has it in its cache key. That is why they return it.
"""

from __future__ import annotations

from typing import Any

from geswarm.sim.kernels.control import act_on_objects, decide_by_rules, decide_by_table, sense
from geswarm.sim.kernels.draws import WALK_HEADING, WALK_TIME
from geswarm.sim.kernels.jit import kernel
from geswarm.sim.kernels.motion import avoid_robots, collide, move
from geswarm.sim.kernels.placement import restart_walk, start
from geswarm.sim.kernels.state import Physics


def build_start(version: int) -> Any:
    """The kernel that starts a simulation; `version` becomes part of its cache key."""

    @kernel
    def start_world(physics: Physics, robots: Any, objects: Any, seed: int) -> int:
        """Write the state at the start."""
        start(physics, robots, objects, seed, 0, 0)
        return version

    return start_world


def build_run_world(version: int) -> Any:
    """The interpreting kernel; `version` becomes part of its cache key."""

    @kernel
    def run_world(
        physics: Physics,
        robots: Any,
        objects: Any,
        tally: Any,
        rules: Any,
        actions: Any,
        first: int,
        steps: int,
    ) -> int:
        """Run control steps first..first+steps-1."""
        for step in range(first, first + steps):
            may_touch = avoid_robots(physics, robots)
            for i in range(len(robots)):
                robot = robots[i]
                sense(physics, robot, step)
                if decide_by_rules(rules, actions, robot, step):
                    restart_walk(physics, robot, step, WALK_HEADING, WALK_TIME)
                act_on_objects(physics, objects, tally, robot, step)
                move(physics, robot, step)
            collide(physics, robots, may_touch)
        return version

    return run_world


def build_run_simulations(version: int) -> Any:
    """The control-table kernel; `version` becomes part of its cache key."""

    @kernel
    def run_simulations(
        physics: Physics,
        robots: Any,
        objects: Any,
        upto: Any,
        outcomes: Any,
        simulations: Any,
        steps: int,
        tallies: Any,
    ) -> int:
        """Run simulations from start to end, one after the other.

        Args:
            physics: Scenario in numbers.
            robots: Working space, of ROBOT, shape (robots,).
            objects: Working space, shape (objects, 2).
            upto: Shape (tables, situations, outcomes), see `decide_by_table`.
            outcomes: Same shape.
            simulations: int64, shape (simulations, 4): table, seed, individual, replicate.
            steps: Control steps of each.
            tallies: int64, shape (simulations, 3), added to: picked, collected, lost.
        """
        for s in range(len(simulations)):
            table, seed = simulations[s, 0], simulations[s, 1]
            start(physics, robots, objects, seed, simulations[s, 2], simulations[s, 3])
            tally = tallies[s]
            for step in range(steps):
                may_touch = avoid_robots(physics, robots)
                for i in range(len(robots)):
                    robot = robots[i]
                    sense(physics, robot, step)
                    if decide_by_table(upto, outcomes, table, robot, step):
                        restart_walk(physics, robot, step, WALK_HEADING, WALK_TIME)
                    act_on_objects(physics, objects, tally, robot, step)
                    move(physics, robot, step)
                collide(physics, robots, may_touch)
        return version

    return run_simulations
