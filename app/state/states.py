"""The state machine of the edited rules, drawn in the background, and what the swarm does in it."""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.exports import brief_svg
from geswarm.rules import RuleSet, StateMachine, Vocabulary
from geswarm.sim import World

from .background import Newest, Stop


@dataclass(frozen=True)
class DrawnMachine:
    """A state machine with its picture.

    Attributes:
        rule_set: What it was drawn for.
        machine: States and transitions.
        svg: See `geswarm.exports.brief_svg`.
    """

    rule_set: RuleSet
    machine: StateMachine
    svg: str


@dataclass(frozen=True)
class Activity:
    """What the swarm does in a state machine.

    The world counts every decision of every robot, so that no transition is missed at any speed.

    Attributes:
        robots: In each state now.
        taken: How often each transition was taken since the rules were set.
    """

    robots: tuple[int, ...]
    taken: tuple[int, ...]


class MachineDrawer:
    """Draws the newest rules, on a thread of its own.

    Attributes:
        drawn: Replaced when another picture is ready; None before the first one.
    """

    def __init__(self) -> None:
        self.drawn: DrawnMachine | None = None
        self._newest: Newest[tuple[RuleSet, Vocabulary]] = Newest("states", self._draw)

    def draw(self, rule_set: RuleSet, vocabulary: Vocabulary) -> None:
        """Begin at once; what was under way is dropped."""
        self._newest.ask((rule_set, vocabulary))

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def activity(self, world: World) -> Activity | None:
        """What the swarm does in the machine drawn; None if it runs other rules meanwhile."""
        drawn = self.drawn
        if drawn is None or drawn.rule_set != world.rule_set:
            return None
        if drawn.machine.space.vocabulary is not world.vocabulary:
            return None
        robots = drawn.machine.robots_in_states(*world.numbers_in(drawn.machine.space))
        taken = drawn.machine.times_taken(world.decisions)
        return Activity(tuple(robots.tolist()), tuple(taken.tolist()))

    def _draw(self, question: tuple[RuleSet, Vocabulary], stop: Stop) -> None:
        rule_set, vocabulary = question
        machine = StateMachine.of(rule_set, vocabulary)
        drawn = DrawnMachine(rule_set, machine, brief_svg(machine))
        if not stop():
            self.drawn = drawn
