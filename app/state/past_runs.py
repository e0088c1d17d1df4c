"""The runs of the arena that were begun again: any of them can be gone back to."""

from __future__ import annotations

import copy
from dataclasses import dataclass

from geswarm.rules import RuleSet
from geswarm.sim import Scenario

from .rival import Rival
from .swarm import ShownSwarm
from .trace import PathTrace

_MOST_RUNS, _MOST_ROBOTS = 8, 200_000  # that are kept, in all runs together


@dataclass(frozen=True, eq=False)
class ArenaRun:
    """A run of the arena with all that belongs to it.

    Attributes:
        loaded: The scenario as it was loaded.
        scenario: The scenario with its changes since.
        swarm: The swarm.
        rival: The swarm beside it, if there is one.
        trace: Where the robots have been.
        rule_set: The rules in the table.
    """

    loaded: Scenario
    scenario: Scenario
    swarm: ShownSwarm
    rival: Rival | None
    trace: PathTrace
    rule_set: RuleSet

    @property
    def time(self) -> float:
        """Simulated time since its start (s)."""
        return self.swarm.world.time


class PastRuns:
    """Keeps runs that others took the place of; where room is short, the shorter ones go first."""

    def __init__(self) -> None:
        self._runs: list[ArenaRun] = []

    @property
    def latest(self) -> ArenaRun | None:
        """The run that `exchange` would return."""
        return self._runs[-1] if self._runs else None

    def keep(self, run: ArenaRun, even_new: bool = False) -> None:
        """Keep a run as it is now, whatever becomes of its swarms.

        Args:
            run: It.
            even_new: Also if it has not begun, as its rules would be lost with it.
        """
        if run.time > 0.0 or even_new:
            self._runs.append(copy.deepcopy(run))
            self._make_room()

    def exchange(self, present: ArenaRun, even_new: bool = False) -> ArenaRun:
        """The latest run; the present one is kept in its place, before all others.

        Args:
            present: It.
            even_new: As for `keep`.

        Raises:
            IndexError: No run is kept.
        """
        run = self._runs.pop()
        if present.time > 0.0 or even_new:
            self._runs.insert(0, present)
        return run

    def _make_room(self) -> None:
        while len(self._runs) > 1 and (
            len(self._runs) > _MOST_RUNS
            or sum(run.scenario.robots for run in self._runs) > _MOST_ROBOTS
        ):
            self._runs.remove(min(self._runs[:-1], key=lambda run: run.time))
