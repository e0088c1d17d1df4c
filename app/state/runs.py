"""The evolutionary runs of a session: the next, the present and those kept in the run folder."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from pathlib import Path

from geswarm.ge import GenerationRecord, Settings
from geswarm.ge.locks import is_written
from geswarm.rules import RuleSet
from geswarm.sim import EvaluationStopped, Scenario

from ..run_directory import RUNS, new_run_directory
from .background import Lookout, Stop
from .evolution import EvolutionThread, evaluate_references
from .look import Chosen, Lens, Look
from .plan import RunPlan, RunPlanError
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
        compared: Runs whose curves are laid over one another: the number of the colour by the name
            of the run, which keeps it for as long as it is compared.
        look: The run looked at; None if there is none.
        problem: Why the run cannot be looked at, else empty.
        done: Generations of the run under way, when things were last found out.
        chosen: The individual looked at, if any.
    """

    def __init__(
        self,
        evolution: EvolutionThread,
        rule_set: RuleSet,
        scenario: Scenario,
        folder: Path = RUNS,
    ) -> None:
        self.evolution = evolution
        self.plan = RunPlan.of(scenario)
        self.kept: tuple[RunSummary, ...] = ()
        self.compared: dict[str, int] = {}
        self.look: Look | None = None
        self.problem = ""
        self.done = 0
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
    def shows_present(self) -> bool:
        """The run looked at is the present or last one of this session, or there is none."""
        return self.shown == self.evolution.directory

    @property
    def shown_look(self) -> Look | None:
        """The look at the run looked at; None as long as there is only one at another run."""
        return self.look if self.look is not None and self.look.directory == self.shown else None

    @property
    def history(self) -> tuple[GenerationRecord, ...]:
        """Of the run looked at, as far as it is known."""
        if self.shows_present:
            return self.evolution.history
        return self.shown_look.history if self.shown_look else ()

    @property
    def reevaluated(self) -> bool:
        """The best of the run looked at is evaluated again and again: it can fall."""
        if self.shows_present:
            settings = self.evolution.settings
        else:
            settings = self.shown_look.settings if self.shown_look else None
        return settings is not None and settings.reevaluate_elites

    @property
    def best(self) -> RuleSet | None:
        """The best rule set of the run looked at, if there is one."""
        if self.shows_present:
            return self.evolution.best
        return self.shown_look.best if self.shown_look else None

    @property
    def label(self) -> str:
        """What the fitness of the run looked at is."""
        live, look = self.evolution.run, self.shown_look
        config = live.config if self.shows_present and live else look.config if look else None
        return config.scenario.objective.gain_label if config else ""

    @property
    def references(self) -> dict[str, float]:
        """Mean gain of the references where the run looked at took place, by title, once known."""
        if self.shows_present:
            return self.evolution.references
        look = self.shown_look
        return self._references.get(look.config.scenario, {}) if look else {}

    def best_so_far(self, summary: RunSummary) -> tuple[float, ...]:
        """Of a run that is kept; of the one under way as its thread knows it, which is newer."""
        if self.is_active(summary.name):
            return tuple(record.best_so_far for record in self.evolution.history)
        return summary.best_so_far

    def is_active(self, name: str) -> bool:
        """The run of that name is under way."""
        directory = self.evolution.directory
        return self.evolution.active and directory is not None and directory.name == name

    def is_elsewhere(self, name: str) -> bool:
        """A run that is kept is under way in another process."""
        present = self.evolution.directory
        return (present is None or present.name != name) and any(
            summary.written_now for summary in self.kept if summary.name == name
        )

    # --- the next run -------------------------------------------------------------------------

    def move_to(self, scenario: Scenario) -> None:
        """Plan for another scenario from now on."""
        self.plan = RunPlan.of(scenario)

    def follow(self, rule_set: RuleSet) -> None:
        """The rules of the table have changed."""
        self.plan = self.plan.following(self._rule_set, rule_set)
        self._rule_set = rule_set

    def freeze(self, rule: int, wanted: bool) -> None:
        """Have the next run leave a rule of the table as it is, or not.

        Raises:
            RunPlanError: There is no such rule.
        """
        if not 0 <= rule < len(self._rule_set.rules):
            raise RunPlanError(f"there is no rule {rule + 1} to freeze")
        self.plan = self.plan.freezing(self._rule_set.rules[rule], wanted)

    def start(self, scenario: Scenario) -> None:
        """Begin the planned run in a new directory; any run under way is stopped.

        Raises:
            RunPlanError: The plan has findings.
        """
        config = self.plan.config(scenario, self._rule_set)
        first = self.plan.first(scenario, self._rule_set)
        directory = new_run_directory(config, self._folder.path)
        self.evolution.start(config, directory, first)
        self._opened = None

    # --- the runs that are kept ---------------------------------------------------------------

    def resume(self, name: str, generations: int | None = None) -> None:
        """Continue a run; any other under way is stopped.

        Args:
            name: Of the run.
            generations: How many it is to have; as many as it was to have unless given.

        Raises:
            RunError: There is no such run, it is under way, here or elsewhere, or as many
                generations are done.
            SettingsError: So many generations cannot be.
        """
        directory = self._folder.directory(name)
        if self.is_active(name):
            raise RunError(f"{name} is under way already")
        if is_written(directory) and directory != self.evolution.directory:
            raise RunError(f"{name} is under way in another process: stop it there first")
        for summary in self.kept:
            if summary.name == name and summary.config is not None:
                _require_more(summary, summary.config.settings, generations)
        self.evolution.resume(directory, generations)
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
        others = {one: colour for one, colour in self.compared.items() if one != name}
        if wanted and name in self.compared:
            return
        if wanted:
            self._folder.directory(name)
            free = set(range(MOST_COMPARED)).difference(others.values())
            if not free:
                raise RunError(f"expected at most {MOST_COMPARED} runs to compare")
            others[name] = min(free)
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
        self.compare(name, False)
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
        self.done = len(evolution.history)
        if self.look is not None and live is None:
            self._find_references(
                self.look.config.scenario,
                lambda: stop() or evolution.active or self.shown != directory,
            )

    def _find_references(self, scenario: Scenario, stop: Stop) -> None:
        """What the references are worth where the run looked at took place."""
        if scenario in self._references:
            return
        with contextlib.suppress(EvaluationStopped):
            self._references[scenario] = dict(evaluate_references(scenario, 1, stop))


def _require_more(summary: RunSummary, settings: Settings, generations: int | None) -> None:
    """Check that a run is to have more generations than it has.

    Raises:
        RunError: It is not.
        SettingsError: There cannot be so many.
    """
    done = len(summary.best_so_far)
    if generations is None:
        generations = settings.generations
    replace(settings, generations=generations)  # raises if that cannot be
    if generations <= done:
        raise RunError(
            f"{summary.name}: {done} generations are done, expected more of them to resume it, "
            f"got {generations}"
        )
