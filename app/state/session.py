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

from geswarm.rules import RuleSet, Vocabulary
from geswarm.sim import CONTROL_STEP, Scenario, ScenarioError, World, can_go_on, vocabulary_of

from .arena_commands import ArenaCommands
from .campaigns import Campaigns
from .comparison import RuleSetComparison
from .document import RuleDocument, bare_rules
from .evolution import EvolutionThread
from .insight import InsightFinder
from .journal import Journal
from .past_runs import ArenaRun, PastRuns
from .playback import Playback
from .references import first_rules
from .rival import BEFORE, Rival, rivals_offered
from .rule_commands import RuleCommands
from .runs import Runs
from .states import MachineDrawer
from .swarm import ShownSwarm
from .trace import SAMPLE_STEPS, PathTrace
from .verdict import Judge, VerdictQuestion
from .view import ArenaView, Shown
from .worth import WorthOfPieces, WorthQuestion

Command: TypeAlias = Callable[["Session"], None]


class Session(RuleCommands, ArenaCommands):
    """The state that every panel shows.

    Attributes:
        loaded: The scenario as it was loaded.
        scenario: Where the swarm is: as loaded, or changed since.
        scenario_problem: Why the last change of it was refused, else empty.
        document: The rules being edited; the world runs them as they stand.
        journal: What of them would be lost in a crash, and what was left by earlier ones.
        world: The swarm.
        rival: The swarm beside it, if there is one.
        rival_problem: Why the last rule set that was asked for is not beside it, else empty.
        trace: Where the robots have been.
        past: The runs before, which can be gone back to.
        playback: Play, pause, speed.
        evolution: The background evolution.
        runs: Its runs: the next, the present and those that are kept.
        comparison: Any rule sets in any scenarios.
        campaigns: The paper's experiments, repeated.
        verdict: What the last change did to the score.
        worth: What each piece of the rules is worth, once asked for.
        insight: What can be said of the rules without running them.
        machine: Their state machine, drawn.
        scenario_version: Grows when the scenario changes.
        shown: What is drawn besides robots and objects.
    """

    def __init__(
        self,
        scenario: Scenario,
        rule_set: RuleSet,
        evolution: EvolutionThread,
        seed: int = 0,
        journal: Journal | None = None,
    ) -> None:
        self.loaded = self.scenario = scenario
        self.scenario_problem = ""
        self.document = RuleDocument(rule_set)
        self.journal = journal or Journal(None)
        self.world = World(scenario, rule_set, seed)
        self.rival: Rival | None = None
        self.rival_problem = ""
        self.trace = PathTrace(scenario, self.world.state)
        self.past = PastRuns()
        self.playback = Playback(CONTROL_STEP)
        self.evolution = evolution
        self.runs = Runs(evolution, rule_set, scenario)
        self.comparison = RuleSetComparison(evolution.workers, scenario)
        self.campaigns = Campaigns(evolution)
        self.scenario_version = 1
        self.verdict = Judge(evolution.workers)
        self.worth = WorthOfPieces(evolution.workers)
        self.insight = InsightFinder()
        self.machine = MachineDrawer()
        self.shown = Shown()
        self.deselect()
        self.release()
        self._swarm = ShownSwarm(self.world)
        self._commands: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self.insight.look_into(self.document.version, rule_set, self.vocabulary)
        self.machine.draw(rule_set, self.vocabulary)
        self._judge()

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
        return self._swarm.view(self.playback.fraction)

    def rival_view(self) -> ArenaView | None:
        """The other arena at the same moment, if there is one."""
        return self.rival.swarm.view(self.playback.fraction) if self.rival else None

    @property
    def _swarms(self) -> tuple[ShownSwarm, ...]:
        return (self._swarm, self.rival.swarm) if self.rival else (self._swarm,)

    def _advance(self, steps: float, budget: float) -> None:
        """Make the steps due, the last one as motion that is displayed."""
        deadline = time.perf_counter() + budget
        while steps > 1 and time.perf_counter() < deadline:
            chunk = int(min(steps - 1, SAMPLE_STEPS - self.world.steps % SAMPLE_STEPS))
            for swarm in self._swarms:
                swarm.world.step(chunk)
            self._record()
            steps -= chunk
        for swarm in self._swarms:
            swarm.step()
        self._record()
        self._keep_held()

    def _record(self) -> None:
        if self.world.steps % SAMPLE_STEPS == 0:
            self.trace.record(self.world.state)

    def _restarted(self) -> None:
        """Nothing of the run before is shown any more."""
        self.held = None
        self.trace.restart(self.scenario, self.world.state)
        self._jump()

    def _jump(self) -> None:
        for swarm in self._swarms:
            swarm.jump()
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
        self._advance(1, 0.0)
        self._jump()

    def set_speed(self, speed: float) -> None:
        """Simulated seconds per second; infinity for as fast as possible."""
        self.playback.speed = speed
        self.playback.restart()

    def reset(self, seed: int | None = None) -> None:
        """Start the run again, with another seed if one is given; `take_back_reset` undoes it."""
        self.past.keep(self._run())
        self._begin(seed)

    def take_back_reset(self) -> None:
        """Go on with the run before, as it was. Again: with the one before that.

        The rules stay, unless the run before had other terms: then its own come back.
        """
        if (latest := self.past.latest) is None:
            return
        other_terms = vocabulary_of(latest.scenario) is not self.vocabulary
        run = self.past.exchange(self._run(), even_new=other_terms)
        same_scenario = run.scenario == self.scenario
        self.loaded, self.scenario, self.rival = run.loaded, run.scenario, run.rival
        self._swarm, self.world, self.trace = run.swarm, run.swarm.world, run.trace
        if other_terms:
            self._forget_rules(run.rule_set)
        elif bare_rules(self.document.rule_set) != bare_rules(self.world.rule_set):
            self.world.set_rules(self.document.rule_set)
        self.held = None
        self._jump()
        if not same_scenario:
            self._scenario_changed()

    def _run(self) -> ArenaRun:
        rule_set = self.document.rule_set
        return ArenaRun(self.loaded, self.scenario, self._swarm, self.rival, self.trace, rule_set)

    def _begin(self, seed: int | None) -> None:
        self.world.reset(seed)
        if self.rival is not None:
            self.rival.swarm.world.set_rules(self._rules_of(self.rival))
            self.rival.swarm.world.reset(self.world.seed)
        self._restarted()

    def toggle_fastest(self) -> None:
        """As fast as possible, or back to the clock on the wall."""
        self.set_speed(1.0 if math.isinf(self.playback.speed) else math.inf)

    # --- commands: scenario -------------------------------------------------------------------

    def set_scenario(self, scenario: Scenario) -> None:
        """Move the swarm to another scenario; the rules stay if it has the same terms.

        Else those come that the scenario is compared with; undo does not bring the old ones back,
        but going back to the run before does.
        """
        if vocabulary_of(scenario) is self.vocabulary:
            self._take_scenario(scenario, loaded=scenario)
        else:
            self._enter(scenario)

    def _enter(self, scenario: Scenario) -> None:
        """Begin in a scenario with other terms, with rules that can run there."""
        self.past.keep(self._run(), even_new=True)
        self.scenario_problem = ""
        self.loaded = self.scenario = scenario
        rule_set = first_rules(scenario)
        self.world = World(scenario, rule_set, self.world.seed)
        self._swarm, self.rival = ShownSwarm(self.world), None
        self.trace = PathTrace(scenario, self.world.state)
        self._forget_rules(rule_set)
        self._restarted()
        self._scenario_changed()

    def _forget_rules(self, rule_set: RuleSet) -> None:
        """Have rules in other words in place of those edited so far."""
        self.document.begin_anew(rule_set)
        self.comparison.move_to(self.scenario)
        self.runs.move_to(self.scenario)
        self.runs.follow(rule_set)
        self.insight.look_into(self.document.version, rule_set, self.vocabulary)
        self.machine.draw(self.world.rule_set, self.vocabulary)

    def change_scenario(self, **changes: Any) -> None:
        """Change values of the scenario, at once where the run can go on, else with a reset.

        What cannot be is left as it was; `scenario_problem` tells why.
        """
        try:
            self._take_scenario(self.scenario.with_changes(**changes))
        except ScenarioError as error:
            self.scenario_problem = "; ".join(
                f"{finding.place.element}: {finding.message}" for finding in error.findings
            )

    def restore_scenario(self) -> None:
        """Take back all changes of the scenario since it was loaded."""
        self._take_scenario(self.loaded)

    def _take_scenario(self, scenario: Scenario, loaded: Scenario | None = None) -> None:
        self.scenario_problem = ""
        if scenario != self.scenario and not can_go_on(self.scenario, scenario):
            self.past.keep(self._run())
        self.loaded = loaded or self.loaded
        if scenario == self.scenario:
            return
        self.scenario = self.trace.scenario = scenario
        goes_on = [swarm.world.set_scenario(scenario) for swarm in self._swarms]
        if not all(goes_on):
            self._restarted()
        self._scenario_changed()

    def _scenario_changed(self) -> None:
        self.scenario_version += 1
        if self.selected is not None and self.selected >= self.scenario.robots:
            self.deselect()
        self._judge()

    # --- commands: side by side ---------------------------------------------------------------

    def rivals_offered(self) -> tuple[str, ...]:
        """Names of the rule sets that there are to compare with now."""
        return tuple(rivals_offered(self.document, self.runs, self.vocabulary))

    def compare_with(self, name: str | None) -> None:
        """Run another rule set beside this one, both from the start; None ends it.

        What is no longer there is not compared with; `rival_problem` tells.
        """
        self.rival_problem = ""
        if name is None:
            self.rival = None
            return
        rule_set = rivals_offered(self.document, self.runs, self.vocabulary).get(name)
        if rule_set is None:
            self.rival_problem = f"{name!r} is no longer there to compare with"
            return
        self.past.keep(self._run())
        self.rival = Rival(name, ShownSwarm(World(self.scenario, rule_set, self.world.seed)))
        self._begin(None)

    def _rules_of(self, rival: Rival) -> RuleSet:
        """The rules that the rival's name stands for now; its old ones if there are none."""
        offered = rivals_offered(self.document, self.runs, self.vocabulary)
        return offered.get(rival.name, rival.swarm.world.rule_set)

    # --- following the rules -------------------------------------------------------------------

    def _follow_document(self) -> None:
        document = self.document
        self.journal.keep(document.unsaved)
        self.insight.look_into(document.version, document.rule_set, self.vocabulary)
        self.runs.follow(document.rule_set)
        if bare_rules(document.rule_set) == bare_rules(self.world.rule_set):
            return  # only words have changed
        self.world.set_rules(document.rule_set)
        self.machine.draw(document.rule_set, self.vocabulary)
        if self.rival is not None and self.rival.name == BEFORE:
            self.rival.swarm.world.set_rules(self._rules_of(self.rival))
        self._judge()

    def weigh_pieces(self) -> None:
        """Begin to find out what each piece of the rules is worth."""
        document = self.document
        self.worth.ask(WorthQuestion(document.version, document.rule_set, self.scenario))

    @property
    def vocabulary(self) -> Vocabulary:
        """What the rules may mention in the present scenario."""
        return self.world.vocabulary

    def _judge(self) -> None:
        document = self.document
        self.verdict.ask(
            VerdictQuestion(document.version, document.rule_set, document.before, self.scenario)
        )
        self.worth.forget(document.version)

    def close(self) -> None:
        """Stop everything that runs in the background."""
        self.evolution.stop()
        self.runs.close()
        self.comparison.close()
        self.campaigns.close()
        self.verdict.close()
        self.worth.close()
        self.insight.close()
        self.machine.close()
        self.journal.close()
