"""What a behaviour tree does in a step, exactly: the distribution over what follows."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import TypeAlias

from geswarm.automode.modules import FAILING, Behaviour, Condition
from geswarm.automode.options import Path
from geswarm.automode.steps import Chance
from geswarm.automode.tree import CONTROLS, NEGATION, Action, Check, Control, Node, Tree

Memory: TypeAlias = tuple[tuple[Path, int], ...]
"""Which child of each node with a star was running, by the way to the node; those at 0 left out."""


class Status(Enum):
    """What a node answers."""

    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"


@dataclass(frozen=True)
class Ticked:
    """What can come of a tick.

    Attributes:
        executed: The behaviour that acts in this step; None if none does and the robot stops.
        memory: For the next tick.
    """

    executed: Behaviour | None
    memory: Memory


def tick(
    tree: Tree, memory: Memory, chance: Callable[[Condition], Chance], obstacle: bool = False
) -> dict[Ticked, Chance]:
    """The distribution over what comes of a tick; exact if the chances are fractions.

    Args:
        tree: What the robot runs.
        memory: From the tick before; () in the first.
        chance: The probability that a condition is true in this step.
        obstacle: Whether an obstacle is in front, so that `straight` and `curve` fail.
    """
    ticker = _Ticker(chance, obstacle)
    found: dict[Ticked, Chance] = defaultdict(Fraction)
    for way in ticker.answers(tree.root, (), _Way(Fraction(1), dict(memory))):
        kept = tuple(sorted((path, at) for path, at in way.memory.items() if at))
        found[Ticked(way.executed, kept)] += way.p
    return {ticked: p for ticked, p in found.items() if p}


@dataclass(frozen=True)
class _Way:
    """One way a tick can go, so far.

    Attributes:
        p: Its probability.
        memory: Of the nodes with a star.
        status: What the last node answered.
        executed: The behaviour that runs, if one does.
    """

    p: Chance
    memory: dict[Path, int]
    status: Status = Status.FAILURE
    executed: Behaviour | None = None


@dataclass(frozen=True)
class _Ticker:
    chance: Callable[[Condition], Chance]
    obstacle: bool

    def answers(self, node: Node, path: Path, way: _Way) -> Iterator[_Way]:
        """What a node can answer, each with its probability."""
        if isinstance(node, Check):
            p = self.chance(node.condition)
            yield _Way(way.p * p, way.memory, Status.SUCCESS)
            yield _Way(way.p * (1 - p), way.memory, Status.FAILURE)
        elif isinstance(node, Action):
            yield from self._action(node, way)
        elif node.kind == NEGATION:
            opposite = {Status.SUCCESS: Status.FAILURE, Status.FAILURE: Status.SUCCESS}
            for each in self.answers(node.children[0], (*path, 0), way):
                status = opposite.get(each.status, each.status)
                yield _Way(each.p, each.memory, status, each.executed)
        else:
            begin = way.memory.get(path, 0) if node.remembers else 0
            yield from self._children(node, path, begin, way)

    def _action(self, node: Action, way: _Way) -> Iterator[_Way]:
        if self.obstacle and node.behaviour.number in FAILING:
            yield _Way(way.p, way.memory, Status.FAILURE)
            return
        yield _Way(way.p * node.success, way.memory, Status.SUCCESS)
        yield _Way(way.p * (1 - node.success), way.memory, Status.RUNNING, node.behaviour)

    def _children(self, node: Control, path: Path, at: int, way: _Way) -> Iterator[_Way]:
        """Ask the children from one on until one answers for the node."""
        selects = CONTROLS[node.kind].startswith("selector")
        goes_on = Status.FAILURE if selects else Status.SUCCESS
        if at == len(node.children):
            # a selector* has succeeded where all have failed: so it is in AutoMoDe
            status = Status.FAILURE if selects and not node.remembers else Status.SUCCESS
            yield _Way(way.p, self._noted(node, path, 0, way.memory), status)
            return
        for each in self.answers(node.children[at], (*path, at), way):
            if not each.p:
                continue
            if each.status is goes_on:
                yield from self._children(node, path, at + 1, each)
                continue
            running = at if each.status is Status.RUNNING else 0
            memory = self._noted(node, path, running, each.memory)
            yield _Way(each.p, memory, each.status, each.executed)

    def _noted(
        self, node: Control, path: Path, at: int, memory: dict[Path, int]
    ) -> dict[Path, int]:
        return {**memory, path: at} if node.remembers else memory
