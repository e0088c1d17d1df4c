"""The commands with which people reach into the arena: they look at robots, and move things."""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.sim import Scenario

from .swarm import ShownSwarm
from .view import Kind


@dataclass(frozen=True)
class Held:
    """What the mouse holds, and where (m)."""

    kind: Kind
    index: int
    x: float
    y: float


class ArenaCommands:
    """What people look at and hold in the arena.

    Attributes:
        scenario: As it is now.
        selected: Index of the robot that is looked at, if any.
        following: The camera follows it.
        held: What the mouse holds, if anything.
    """

    scenario: Scenario
    selected: int | None
    following: bool
    held: Held | None
    _swarm: ShownSwarm

    def select(self, robot: int) -> None:
        """Look at a robot, or no longer if it is the one already looked at."""
        if robot == self.selected:
            self.deselect()
        elif 0 <= robot < self.scenario.robots:
            self.selected = robot

    def deselect(self) -> None:
        """Look at no robot in particular."""
        self.selected = None
        self.following = False

    def follow(self, wanted: bool) -> None:
        """Have the camera follow the selected robot, or stay where it is."""
        self.following = wanted and self.selected is not None

    def hold(self, kind: Kind, index: int, x: float, y: float) -> None:
        """Take a robot or an object to a place and hold it there until it is released."""
        number = self.scenario.robots if kind == "robot" else self.scenario.objects
        if 0 <= index < number:
            self.held = Held(kind, index, x, y)
            self._keep_held()

    def release(self) -> None:
        """Let go of what is held."""
        self.held = None

    def _keep_held(self) -> None:
        if (held := self.held) is not None:
            self._swarm.place(held.kind, held.index, held.x, held.y)
