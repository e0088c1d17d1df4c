"""The evolutionary runs of a session: the next, the present and those kept in the run folder."""

from __future__ import annotations

import contextlib
from pathlib import Path

from geswarm.rules import RuleSet
from geswarm.sim import EvaluationStopped, Scenario

from ..run_directory import RUNS, new_run_directory
from .background import Lookout, Stop
from .evolution import EvolutionThread, evaluate_references
from .look import Chosen, Lens, Look
from .plan import Plan, PlanError
from .run_folder import RunError, RunFolder, RunSummary

MOST_COMPARED = 6
"""Curves over one another; there are as many colours that everybody can tell apart."""


class Runs:
    """What is planned, what runs, what is kept, and what of it is looked at.

    The loop owns it, except for what `refresh` finds out in the background: `kept`, `look` and
    `problem` are replaced as a whole.

    Attributes:
        evolution: The run under way.
        plan: Of the next run.
        kept: All of the run folder, the newest first.
        compared: Names of runs whose curves are laid over the one looked at.
        look: The run looked at; None if there is none.
        problem: Why the run cannot be looked at, else empty.
        chosen: The individual looked at, if any.
    """

    def __init__(self, evolution: EvolutionThread, rule_set: RuleSet, folder: Path = RUNS) -> None:
        self.evolution = evolution
        self.plan = Plan()
        self.kept: tuple[RunSummary, ...] = ()
        self.compared: tuple[str, ...] = ()
        self.look: Look | None = None
        self.problem = ""
        self.chosen: Chosen | None = None
        self._folder = RunFolder(folder)
        self._rule_set = rule_set
        self._opened: Path | None = None
        self._lens = Lens()
        self._references: dict[Scenario, dict[str, float]] = {}
        self._lookout = Lookout("runs", self._find_out)

    @property
    def shown(self) -> Path | None:
        """Directory of the run looked at: the one that was opened, else the present or last one."""
        return self._opened or self.evolution.directory

    @property
    def references(self) -> dict[str, float]:
        """Mean collected of the presets where the run looked at took place, once known."""
        if self.look is None:
            return {}
        if self.look.directory == self.evolution.directory:
            return self.evolution.references
        return self._references.get(self.look.config.scenario, {})

    def is_active(self, name: str) -> bool:
        """The run of that name is under way."""
        directory = self.evolution.directory
        return self.evolution.active and directory is not None and directory.name == name

    # --- the next run -------------------------------------------------------------------------

    def follow(self, rule_set: RuleSet) -> None:
        """The rules of the table have changed."""
        self.plan = self.plan.following(self._rule_set, rule_set)
        self._rule_set = rule_set

    def freeze(self, rule: int, wanted: bool) -> None:
        """Have the next run leave a rule of the table as it is, or not.

        Raises:
            PlanError: There is no such rule.
        """
        if not 0 <= rule < len(self._rule_set.rules):
            raise PlanError(f"there is no rule {rule + 1} to freeze")
        self.plan = self.plan.freezing(self._rule_set.rules[rule], wanted)

    def start(self, scenario: Scenario) -> None:
        """Begin the planned run in a new directory; any run under way is stopped.

        Raises:
            PlanError: The plan has findings.
        """
        config = self.plan.config(scenario, self._rule_set)
        first = self.plan.first(self._rule_set)
        directory = new_run_directory(config, self._folder.path)
        self.evolution.start(config, directory, first)
        self._opened = None

    # --- the runs that are kept ---------------------------------------------------------------

    def resume(self, name: str) -> None:
        """Continue a run; any other under way is stopped.

        Raises:
            RunError: There is no such run, or it is finished or under way.
        """
        directory = self._folder.directory(name)
        if self.is_active(name):
            raise RunError(f"{name} is under way already")
        if any(summary.name == name and summary.finished for summary in self.kept):
            raise RunError(f"{name} is finished: all its generations are done")
        self.evolution.resume(directory)
        self._opened = None

    def open(self, name: str) -> None:
        """Look at a run.

        Raises:
            RunError: There is no such run.
        """
        self._opened = self._folder.directory(name)

    def compare(self, name: str, wanted: bool) -> None:
        """Lay a run's curve over the others, or not.

        Raises:
            RunError: There is no such run, or there are too many.
        """
        others = tuple(one for one in self.compared if one != name)
        if wanted:
            self._folder.directory(name)
            if len(others) == MOST_COMPARED:
                raise RunError(f"expected at most {MOST_COMPARED} runs to compare")
            others = (*others, name)
        self.compared = others

    def delete(self, name: str) -> str:
        """Remove a run for good; says what was left because it is no part of a run.

        Raises:
            RunError: There is no such run, it is under way, or it cannot be removed.
        """
        if self.is_active(name):
            raise RunError(f"{name} is under way: stop it before it is deleted")
        left = self._folder.delete(name)
        self.kept = tuple(summary for summary in self.kept if summary.name != name)
        self.compared = tuple(one for one in self.compared if one != name)
        if self._opened is not None and self._opened.name == name:
            self._opened = None
        if self.evolution.directory is not None and self.evolution.directory.name == name:
            self.evolution.forget()
        return left

    # --- looking ------------------------------------------------------------------------------

    def choose(self, generation: int, key: int) -> None:
        """Look at an individual of the run looked at.

        Raises:
            RunError: It is not known there, or invalid.
        """
        chosen, live = None, self.evolution.run
        if self.look is not None:
            chosen = self.look.individual(generation, key)
            if chosen is None and live is not None and live.directory == self.look.directory:
                chosen = self.look.stored(live.bred(generation), generation, key)
        if chosen is None:
            raise RunError(f"individual {key} of generation {generation} has no rules to show")
        self.chosen = chosen

    def forget(self) -> None:
        """Look at no individual in particular."""
        self.chosen = None

    def refresh(self) -> None:
        """Find out in the background how things stand, unless that is being done already."""
        self._lookout.ask()

    def close(self) -> None:
        """End the thread."""
        self._lookout.close()

    def _find_out(self, stop: Stop) -> None:
        evolution, directory = self.evolution, self.shown
        live = evolution.run
        if live is not None and live.directory != directory:
            live = None
        self._lens.turn_to(directory, live)
        self.look, self.problem = self._lens.look, self._lens.problem
        self.kept = self._folder.scan(evolution.directory if evolution.active else None)
        if self.look is not None and live is None:
            self._find_references(
                self.look.config.scenario,
                lambda: stop() or evolution.active or self.shown != directory,
            )

    def _find_references(self, scenario: Scenario, stop: Stop) -> None:
        """What the presets collect where the run looked at took place."""
        if scenario in self._references:
            return
        with contextlib.suppress(EvaluationStopped):
            self._references[scenario] = dict(evaluate_references(scenario, 1, stop))
