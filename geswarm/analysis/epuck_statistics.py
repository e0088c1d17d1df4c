"""What AutoMoDe's stack is compared by: how robots of a machine move, where, and in which state."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from geswarm.automode import Machine
from geswarm.sim import Scenario, parts_of
from geswarm.sim.arena.geometry import distances
from geswarm.sim.arena.model import Arena
from geswarm.sim.batch import Group, fitness_of
from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.machines import states_of
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.kernels.state import LANES

Array = npt.NDArray[np.float64]

_STANDS = 5e-4
"""m in a step, below which a robot stands still."""
_FAR = 9.0
_NEIGHBOURS_EVERY = 10
"""Steps; between them the nearest neighbour hardly changes."""


def figures_of(machine: Machine, scenario: Scenario, runs: int, seed: int) -> dict[str, Array]:
    """Objective and statistics of each run.

    Args:
        machine: What the robots run.
        scenario: Where; a small swarm, see `batch.runs_side_by_side`.
        runs: How many.
        seed: Keys their random numbers.

    Returns:
        By name, each of shape (runs,): `objective`, `speed` (m/s), `turn_rate` (rad/s), `still`,
        `black`, `white` and `state 0` to the last (shares of robot-steps, at the end of each), `nn`
        (m; distance of centres to the nearest neighbour, where there is more than one robot).
    """
    parts = parts_of(scenario)
    controllers = compile_controllers([machine], fails(scenario, parts), parts)
    states = states_of(machine, parts)
    shares = []
    for first in range(0, runs, LANES):
        numbers = range(first, min(first + LANES, runs))
        simulations = np.array([(0, seed, 0, run) for run in numbers], dtype=np.int64)
        group = Group(controllers, scenario, simulations)
        found = _followed(group, scenario, states, len(numbers))
        measures = {each.name: group.measured(each.name) for each in parts.measures}
        found["objective"] = fitness_of(scenario, measures)[: len(numbers)]
        shares.append(found)
    return {name: np.concatenate([each[name] for each in shares]) for name in shares[0]}


def _followed(
    group: Group, scenario: Scenario, states: npt.NDArray[np.int64], runs: int
) -> dict[str, Array]:
    """Run a group to its end; the statistics of each run."""
    sums: dict[str, Array] = defaultdict(lambda: np.zeros(runs))
    before, heading = _places(group, runs), _headings(group, runs)
    for step in range(scenario.steps):
        group.run(step, 1)
        places, heading_before, heading = _places(group, runs), heading, _headings(group, runs)
        turned = (heading - heading_before + math.pi) % (2.0 * math.pi) - math.pi
        sums["turn_rate"] += 10.0 * np.abs(turned).mean(axis=0)
        went = np.hypot(*(places - before))
        sums["speed"] += 10.0 * went.mean(axis=0)
        sums["still"] += (went < _STANDS).mean(axis=0)
        for colour, on_it in floors_below(scenario.arena, places).items():
            sums[colour] += on_it.mean(axis=0)
        state = states[group.robots["behaviour"][:, :runs]]
        for at in range(states.max() + 1):
            sums[f"state {at}"] += (state == at).mean(axis=0)
        if len(went) > 1 and step % _NEIGHBOURS_EVERY == 0:
            apart = np.hypot(*(places[:, :, None] - places[:, None]))
            apart += _FAR * np.eye(len(went))[:, :, None]
            sums["nn"] += _NEIGHBOURS_EVERY * apart.min(axis=0).mean(axis=0)
        before = places
    return {name: each / scenario.steps for name, each in sums.items()}


def _places(group: Group, runs: int) -> Array:
    """Where robots are, shape (2, robots, runs)."""
    return np.stack([group.robots[along][:, :runs].astype(np.float64) for along in "xy"])


def _headings(group: Group, runs: int) -> Array:
    """Where robots look, shape (robots, runs)."""
    angles: Array = np.arctan2(*(group.robots[name].astype(np.float64) for name in ("sin", "cos")))
    return angles[:, :runs]


def floors_below(arena: Arena, places: Array) -> Mapping[str, npt.NDArray[np.bool_]]:
    """Whether places are on black and on white floor; the later patch lies above.

    Args:
        arena: Whose floor.
        places: x and y, shape (2, ...).

    Returns:
        By colour, shape (...).
    """
    points = places.reshape(2, -1).T
    floor = np.full(len(points), arena.floor, dtype=object)
    for patch in arena.patches:
        if patch.floor:
            floor[distances(arena.resolved(patch.shape), points) == 0.0] = patch.floor
    return {colour: (floor == colour).reshape(places.shape[1:]) for colour in ("black", "white")}
