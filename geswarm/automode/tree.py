"""Behaviour trees as Maple has them, over the same modules as machines.

From the branch `BehaviorTree` of ARGoS3-AutoMoDe, with what is particular there: an action that
has neither failed nor succeeded is executed and the tick ends, running; a selector* of which every
child failed has succeeded; nodes with a star remember which child was running, also where another
branch was executed meanwhile; a tree in which nothing runs stops the robot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from geswarm.automode.modules import SUCCESS, Behaviour, Condition

CONTROLS = ("selector", "selector*", "sequence", "sequence*", "negation")
"""Kinds of nodes that have children, by number."""
NEGATION = 4
ACTION, CONDITION = 5, 6
MOST_CHILDREN = 10
"""Children are numbered by one digit each."""
MOST_LEVELS = 5
"""Of nodes below the root: so many digits does AutoMoDe read."""


@dataclass(frozen=True)
class Action:
    """A leaf that executes a behaviour.

    Attributes:
        behaviour: Which.
        success: Probability that it succeeds in a tick instead of being executed.
    """

    behaviour: Behaviour
    success: float

    def __post_init__(self) -> None:
        if not SUCCESS.admits(self.success):
            raise ValueError(f"success: expected {SUCCESS.expected}, got {self.success}")


@dataclass(frozen=True)
class Check:
    """A leaf that succeeds if a condition is true, and fails otherwise."""

    condition: Condition


@dataclass(frozen=True)
class Control:
    """A node that asks its children, from the first on.

    Attributes:
        kind: Position in CONTROLS.
        children: Up to MOST_CHILDREN; exactly one of a negation.
    """

    kind: int
    children: tuple[Node, ...]

    def __post_init__(self) -> None:
        most = 1 if self.kind == NEGATION else MOST_CHILDREN
        if not 1 <= len(self.children) <= most:
            raise ValueError(
                f"{CONTROLS[self.kind]}: expected 1 to {most} children, got {len(self.children)}"
            )

    @property
    def remembers(self) -> bool:
        """Whether it goes on with the child that was running."""
        return CONTROLS[self.kind].endswith("*")


Node: TypeAlias = Action | Check | Control


@dataclass(frozen=True)
class Tree:
    """A controller of Maple."""

    root: Control
