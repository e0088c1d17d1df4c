"""Where the robots have been: their paths of late, and how often each place was visited."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm.sim import CONTROL_STEP, Scenario, WorldState

SAMPLE_STEPS = 5
"""Control steps from one sample to the next."""

TRAIL_SECONDS = 20.0
"""Simulated time that a trail goes back."""

_POINTS = round(TRAIL_SECONDS / (SAMPLE_STEPS * CONTROL_STEP)) + 1
_CELL = 0.05  # m, the finest raster of visits
_MOST_CELLS = 40_000
_SLACK = 0.05  # m that a robot may be pushed by others between two samples


@dataclass(frozen=True, eq=False)
class Trails:
    """The paths of n robots of late as line segments, oldest first.

    Attributes:
        ends: Both ends of each segment, shape (segments, 2, 2), x and y in metres.
        behaviour: What the robot did there, shape (segments,).
        age: 0 for the newest to 1 for the oldest, shape (segments,).
    """

    ends: npt.NDArray[np.float64]
    behaviour: npt.NDArray[np.uint8]
    age: npt.NDArray[np.float64]


class PathTrace:
    """Samples of where the robots are, taken every `SAMPLE_STEPS` control steps.

    Attributes:
        scenario: Where they are; its robots and its arena are those of the last restart.
        visits: Samples per cell since the start, shape (rows, columns), north and west first.
        samples: Number of samples since the start.
    """

    def __init__(self, scenario: Scenario, state: WorldState) -> None:
        self.restart(scenario, state)

    def restart(self, scenario: Scenario, state: WorldState) -> None:
        """Forget everything; the robots are where they are."""
        self.scenario = scenario
        cell = max(_CELL, math.sqrt(scenario.width * scenario.length / _MOST_CELLS))
        rows, columns = math.ceil(scenario.length / cell), math.ceil(scenario.width / cell)
        self.visits = np.zeros((rows, columns), dtype=np.int64)
        self.samples = 0
        here = np.column_stack((state.x, state.y))
        self._paths = np.repeat(here[None], _POINTS, axis=0)
        self._behaviours = np.repeat(state.behaviour[None], _POINTS, axis=0)

    def record(self, state: WorldState) -> None:
        """Take a sample."""
        self._paths[:-1] = self._paths[1:]
        self._behaviours[:-1] = self._behaviours[1:]
        self._paths[-1, :, 0], self._paths[-1, :, 1] = state.x, state.y
        self._behaviours[-1] = state.behaviour
        rows, columns = self.visits.shape
        column = (0.5 + state.x / self.scenario.width) * columns
        row = (0.5 - state.y / self.scenario.length) * rows
        inside = row.astype(int).clip(0, rows - 1), column.astype(int).clip(0, columns - 1)
        np.add.at(self.visits, inside, 1)
        self.samples += 1

    def trails(self) -> Trails:
        """The paths of late; where a robot was carried away, there is a gap of no length."""
        begin, end = self._paths[:-1], self._paths[1:]
        farthest = self.scenario.max_speed * SAMPLE_STEPS * CONTROL_STEP + _SLACK
        carried = np.hypot(*np.moveaxis(end - begin, 2, 0)) > farthest
        begin = np.where(carried[..., None], end, begin)
        age = np.linspace(1.0, 0.0, len(begin))
        return Trails(
            ends=np.stack((begin, end), axis=2).reshape(-1, 2, 2),
            behaviour=self._behaviours[1:].reshape(-1),
            age=np.repeat(age, begin.shape[1]),
        )
