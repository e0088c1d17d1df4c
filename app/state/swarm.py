"""A world and the two moments of it between which it is displayed."""

from __future__ import annotations

from geswarm.sim import World

from .view import ArenaView, Kind, between


class ShownSwarm:
    """Shows a world that makes whole steps as if it moved smoothly.

    Attributes:
        world: The simulation.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.jump()

    def jump(self) -> None:
        """Show the world as it is now."""
        self._before = self._now = ArenaView.of(self.world.state)

    def step(self) -> None:
        """One control step, to be shown as motion."""
        self._before = ArenaView.of(self.world.state)
        self.world.step()
        self._now = ArenaView.of(self.world.state)

    def view(self, fraction: float) -> ArenaView:
        """What is seen a fraction of the way from the last step but one to the last."""
        return between(self._before, self._now, fraction)

    def place(self, kind: Kind, i: int, x: float, y: float) -> None:
        """Put a robot or an object at (x, y) (m), or as near to it as it may be, at once.

        Raises:
            IndexError: There is no such robot or object.
            ValueError: A coordinate is not finite.
        """
        move = self.world.move_robot if kind == "robot" else self.world.move_object
        move(i, x, y)
        now = ArenaView.of(self.world.state)
        self._before = self._before.with_placed(kind, i, now)
        self._now = self._now.with_placed(kind, i, now)
