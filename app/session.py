"""One dashboard session: the swarm, the rules it runs, the clock, the evolution. No display here.

All state is owned by one thread, the loop. Whoever lives elsewhere (callbacks of the display,
sockets) posts a command, and the loop carries it out between two frames.
"""

from __future__ import annotations

import math
import queue
import time
from collections.abc import Callable
from typing import Any, TypeAlias

from geswarm.rules import RuleSet, load_preset, read_rule_set
from geswarm.sim import CONTROL_STEP, Scenario, World

from .document import RuleDocument
from .evolution import EvolutionThread
from .playback import Playback
from .verdict import Question, Verdict
from .view import ArenaView, between

Command: TypeAlias = Callable[["Session"], None]

_STEPS_PER_CALL = 10  # between two looks at the clock


class Session:
    """The state that every panel shows.

    Attributes:
        scenario: Where the swarm forages.
        document: The rules being edited; the world runs them as they stand.
        world: The swarm.
        playback: Play, pause, speed.
        evolution: The background evolution.
        verdict: What the last change did to the score.
        scenario_version: Grows when the scenario changes.
    """

    def __init__(
        self, scenario: Scenario, rule_set: RuleSet, evolution: EvolutionThread, seed: int = 0
    ) -> None:
        self.scenario = scenario
        self.document = RuleDocument(rule_set)
        self.world = World(scenario, rule_set, seed)
        self.playback = Playback(CONTROL_STEP)
        self.evolution = evolution
        self.scenario_version = 1
        self.verdict = Verdict(evolution.workers)
        self._commands: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self._jump()
        self._ask_for_verdict()

    # --- the loop -----------------------------------------------------------------------------

    def post(self, command: Command) -> None:
        """Have the loop carry out a command; from any thread, returns at once."""
        self._commands.put(command)

    def frame(self, elapsed: float, budget: float) -> None:
        """Carry out what was posted, then let `elapsed` seconds go by in the arena.

        Args:
            elapsed: Wall seconds since the last frame.
            budget: Wall seconds that the simulation may take; slower playback rather than jerks.
        """
        while not self._commands.empty():
            self._commands.get()(self)
        steps = self.playback.steps_due(elapsed)
        if steps != 0:
            self._advance(math.inf if steps is None else steps, budget)

    def view(self) -> ArenaView:
        """The arena now: between its last two steps, so that motion is smooth at any speed."""
        return between(self._before, self._now, self.playback.fraction)

    def _advance(self, steps: float, budget: float) -> None:
        """Make the steps due, the last one between the two views kept."""
        deadline = time.perf_counter() + budget
        while steps > 1 and time.perf_counter() < deadline:
            chunk = int(min(steps - 1, _STEPS_PER_CALL))
            self.world.step(chunk)
            steps -= chunk
        self._before = ArenaView.of(self.world.state)
        self.world.step()
        self._now = ArenaView.of(self.world.state)

    def _jump(self) -> None:
        self._before = self._now = ArenaView.of(self.world.state)
        self.playback.restart()

    # --- commands: playback -------------------------------------------------------------------

    def play(self) -> None:
        """Let time go by."""
        self.playback.playing = True

    def pause(self) -> None:
        """Stop time."""
        self.playback.playing = False

    def step(self) -> None:
        """One control step, then pause."""
        self.pause()
        self.world.step()
        self._jump()

    def set_speed(self, speed: float) -> None:
        """Simulated seconds per second; infinity for as fast as possible."""
        self.playback.speed = speed
        self.playback.restart()

    def reset(self, seed: int | None = None) -> None:
        """Start the run again, with another seed if one is given."""
        self.world.reset(seed)
        self._jump()

    def set_scenario(self, scenario: Scenario) -> None:
        """Move the swarm to another scenario; the rules stay."""
        self.scenario = scenario
        self.world = World(scenario, self.document.rule_set, self.world.seed)
        self.scenario_version += 1
        self._jump()
        self._ask_for_verdict()

    # --- commands: rules ----------------------------------------------------------------------

    def edit(self, edit: dict[str, Any]) -> None:
        """Change the rules; the swarm follows them from its next step on.

        Raises:
            EditError: The edit cannot be made; nothing has changed.
        """
        self.document.edit(edit)
        self._follow_document()

    def undo(self) -> None:
        """Take the last change of the rules back."""
        self.document.undo()
        self._follow_document()

    def redo(self) -> None:
        """Make the last change taken back again."""
        self.document.redo()
        self._follow_document()

    def load(self, rule_set: RuleSet) -> None:
        """Put another rule set in the table and in the swarm; undo brings the old one back."""
        self.document.replace(rule_set)
        self._follow_document()

    def load_preset(self, name: str) -> None:
        """Load a preset.

        Raises:
            RuleSetError: There is none of that name.
        """
        self.load(load_preset(name))

    def load_text(self, text: str, source: str) -> None:
        """Load YAML or the rule language.

        Raises:
            RuleSetError: It cannot be read; nothing has changed.
        """
        self.load(read_rule_set(text, source))

    def load_best(self) -> None:
        """Load the best rule set that evolution has found so far, if there is one."""
        if (best := self.evolution.best) is not None:
            self.load(best)

    def _follow_document(self) -> None:
        self.world.set_rules(self.document.rule_set)
        self._ask_for_verdict()

    def _ask_for_verdict(self) -> None:
        document = self.document
        self.verdict.ask(
            Question(document.version, document.rule_set, document.before, self.scenario)
        )

    def close(self) -> None:
        """Stop everything that runs in the background."""
        self.evolution.stop()
        self.verdict.close()
