"""One simulation, its robots side by side in blocks: the interactive world and large swarms."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from geswarm.sim.assembly.kernel import assemble
from geswarm.sim.assembly.records import robot_type, room
from geswarm.sim.assembly.source import Layout
from geswarm.sim.controllers.encoding import (
    fill_robots,
    grid_for,
    is_wide,
    numbers_by_name,
)
from geswarm.sim.controllers.starting import start_of
from geswarm.sim.kernels.state import LANES
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario

_MOST_PAIRS = 100_000_000


class Swarm:
    """Robots and objects of one simulation.

    Attributes:
        blocks: Of `assembly.records.robot_type`, 64 robots each; the last one may hold fewer. Of
            bodies with inertia each block holds one, in its first lane.
        objects: float32, positions, shape (objects, 2).
        parts: What the scenario is composed of.
        steps: Control steps run so far.
    """

    def __init__(self, scenario: Scenario, rules: bool, wide: bool | None = None) -> None:
        """Make room; `rules` says that they are interpreted one by one."""
        parts = parts_of(scenario)
        inert = parts.body.is_inert
        wide = not inert and (is_wide(scenario) if wide is None else wide)
        self.layout = Layout(swarm=not inert, rules=rules, wide=wide)
        self._scenario = scenario
        self.parts = parts
        self._kernel = assemble(parts, self.layout)
        self._numbers = numbers_by_name(scenario, self._kernel.numbers, parts)
        blocks = -(-scenario.robots // LANES) if self.layout.swarm else scenario.robots
        self.blocks = room(blocks, robot_type(parts, self.layout))
        self.objects = np.zeros((scenario.objects, 2), dtype=np.float32)
        self._grid = grid_for(scenario)
        self.steps = 0

    def start(self, seed: int, individual: int = 0, replicate: int = 0) -> None:
        """Place robots and objects."""
        began = start_of(self._scenario, np.array([(0, seed, individual, replicate)]), self.parts)
        robots = np.zeros((len(self.blocks), LANES), dtype=began.robots.dtype)
        robots["cos"] = 1.0
        at = self._places(slice(None))
        robots[at] = began.robots[0]
        self.blocks[:] = np.zeros(1, dtype=self.blocks.dtype)
        fill_robots(self.blocks, robots)
        if self.layout.swarm:
            self.blocks["exists"][at] = 1
        self.objects[:] = began.objects[0]
        self.list_anew()
        self.steps = 0

    def list_anew(self) -> None:
        """List the pairs of robots before the next step."""
        self._grid.listed[:] = grid_for(self._scenario).listed

    def go_on_as(self, other: Swarm) -> None:
        """Take over robots and objects of a swarm in another scenario."""
        for name in self.blocks.dtype.names or ():
            if name in (other.blocks.dtype.names or ()):
                self.blocks[name] = other.blocks[name]
        self.objects[:] = other.objects
        self.steps = other.steps

    def run(self, controller: tuple[Any, ...], steps: int) -> None:
        """Run control steps; `controller` is what the kernel takes for deciding.

        Raises:
            ValueError: More robots are near each other than can be kept track of.
        """
        end = self.steps + steps
        while self.steps < end:
            left = end - self.steps
            arguments = (self._numbers, self.blocks, self.objects, *controller)
            search = self._grid if self.layout.swarm else 1
            self.steps += self._kernel.run(*arguments, search, self.steps, left)
            if self.steps < end:
                self._make_room(-int(self._grid.listed[0]))

    def _make_room(self, pairs: int) -> None:
        if pairs > _MOST_PAIRS:
            raise ValueError(
                f"{pairs} pairs of robots are in sight of each other, expected at most "
                f"{_MOST_PAIRS}: a shorter rab_range or a larger arena helps"
            )
        room = np.empty((pairs + pairs // 2, 2), dtype=np.int32)
        self._grid = self._grid._replace(pairs=room)

    def of_robots(self, name: str) -> npt.NDArray[Any]:
        """A field of all robots, shape (robots,)."""
        if not self.layout.swarm:
            return np.asarray(self.blocks[name][:, 0])
        values: npt.NDArray[Any] = self.blocks[name].reshape(-1)[: self._scenario.robots]
        return values

    def _places(self, which: slice) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Block and lane of some robots."""
        at = np.arange(self._scenario.robots)[which]
        return (at // LANES, at % LANES) if self.layout.swarm else (at, np.zeros_like(at))

    def put(self, name: str, which: slice, values: npt.NDArray[Any]) -> None:
        """Set a field of some robots."""
        self.blocks[name][self._places(which)] = values

    def place_robot(self, i: int, x: float, y: float) -> None:
        """Put a robot somewhere."""
        block, lane = (int(at[0]) for at in self._places(slice(i, i + 1)))
        robot = self.blocks[block]
        for name, place in (("x", x), ("y", y)):
            robot[name][lane] = place
            if self.layout.wide:
                robot[f"low_{name}"][lane] = place - float(robot[name][lane])

    def measured(self, name: str) -> float:
        """A measure: the sum over the robots, or what is made of their places."""
        if measure := self.parts.of_places.get(name):
            x, y = (self.of_robots(along)[:, np.newaxis] for along in "xy")
            return float(measure.of(x, y, self._scenario.arena)[0])
        return float(self.of_robots(name).sum(dtype=np.float64))
