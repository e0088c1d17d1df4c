"""What is seen of a world at one moment, and what the user wants to see besides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.sim import WorldState

Kind: TypeAlias = Literal["robot", "object"]
Whose: TypeAlias = Literal["none", "selected", "all"]


@dataclass
class Shown:
    """What is drawn besides robots and objects.

    Attributes:
        trails: The robots' paths of late.
        visits: How often each place was visited, as a heat map.
        ranges: Whose sensing ranges.
    """

    trails: bool = False
    visits: bool = False
    ranges: Whose = "none"


@dataclass(frozen=True, eq=False)
class ArenaView:
    """What is seen of a world at one moment, for n robots and k objects.

    Attributes:
        x: East, shape (n,), metres from the centre of the arena.
        y: North, shape (n,), metres.
        theta: Heading, shape (n,), radians from east, counter-clockwise.
        behaviour: Behaviour code, shape (n,), int.
        carried: Whether the robot has an object, shape (n,), bool.
        objects: Places of the objects on the ground, shape (k, 2), metres.
    """

    x: npt.NDArray[np.floating[Any]]
    y: npt.NDArray[np.floating[Any]]
    theta: npt.NDArray[np.floating[Any]]
    behaviour: npt.NDArray[np.integer[Any]]
    carried: npt.NDArray[np.bool_]
    objects: npt.NDArray[np.floating[Any]]

    @classmethod
    def of(cls, state: WorldState) -> ArenaView:
        """What there is to see of a world's state."""
        return cls(state.x, state.y, state.theta, state.behaviour, state.carried, state.objects)

    def with_placed(self, kind: Kind, i: int, other: ArenaView) -> ArenaView:
        """The same, but with one robot or object where the other view has it."""
        if kind == "object":
            objects = self.objects.copy()
            objects[i] = other.objects[i]
            return replace(self, objects=objects)
        x, y = self.x.copy(), self.y.copy()
        x[i], y[i] = other.x[i], other.y[i]
        return replace(self, x=x, y=y)


def between(before: ArenaView, after: ArenaView, fraction: float) -> ArenaView:
    """The view a fraction of the way between two successive steps: poses are interpolated.

    Behaviours, carried and lying objects are those of `after`.
    """
    if fraction >= 1.0 or len(before.x) != len(after.x):
        return after
    turn = np.remainder(after.theta - before.theta + np.pi, 2 * np.pi) - np.pi
    return replace(
        after,
        x=before.x + fraction * (after.x - before.x),
        y=before.y + fraction * (after.y - before.y),
        theta=before.theta + fraction * turn,
    )
