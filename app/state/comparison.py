"""Rule sets compared in scenarios: what is chosen, and full runs of it in the background."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from geswarm.analysis.cases import Case, Samples, run_cases
from geswarm.analysis.compared import Compared
from geswarm.rules import RuleSet, Vocabulary, load_rule_set, read_rule_set
from geswarm.sim import (
    EvaluationStopped,
    Scenario,
    load_scenario,
    scenario_names,
    vocabulary_of,
)

from ..run_directory import RUNS
from .background import Newest, Stop
from .plan import LARGEST_SEED
from .rival import best_of, presets_of

ARENA, TABLE = "arena", "table"
MOST_RUNS, LEAST_RUNS = 1000, 2
MOST_CHOSEN = 12
"""Rule sets, and scenarios; more cannot be looked at side by side."""
MOST_FILES = 20
_MOST_KEPT = 200
_FIRST_PRESETS = 2


class ChoiceError(ValueError):
    """What was chosen cannot be compared; says why."""


@dataclass(frozen=True)
class ComparisonChoice:
    """What is to be compared, as it was typed; see `findings`.

    Attributes:
        rules: Names of rule sets, in the order in which they are offered.
        scenarios: Names of scenarios, in the order in which they are offered.
        against: The rule set that the others are compared with; the first one if it is not chosen.
        runs: Simulations of each rule set in each scenario.
        seed: Of their random streams.
    """

    rules: tuple[str, ...] = (TABLE,)
    scenarios: tuple[str, ...] = (ARENA,)
    against: str = ""
    runs: Any = 50
    seed: Any = 0

    def findings(self) -> dict[str, str]:
        """What is wrong with it, by the name of the attribute."""
        found = {}
        for name in ("rules", "scenarios"):
            if not 1 <= len(getattr(self, name)) <= MOST_CHOSEN:
                found[name] = f"expected 1 to {MOST_CHOSEN}, got {len(getattr(self, name))}"
        for name, least, most in (("runs", LEAST_RUNS, MOST_RUNS), ("seed", 0, LARGEST_SEED)):
            value = getattr(self, name)
            if type(value) is not int or not least <= value <= most:
                found[name] = f"expected a whole number from {least} to {most}, got {value!r}"
        return found


@dataclass(frozen=True, eq=False)
class ComparisonQuestion:
    """A comparison to be made.

    Attributes:
        rule_sets: By name.
        scenarios: Where each of them runs.
        against: Name of the rule set that the others are compared with.
        runs: Simulations of each rule set in each scenario.
        seed: Of their random streams.
    """

    rule_sets: dict[str, RuleSet]
    scenarios: tuple[Scenario, ...]
    against: str
    runs: int
    seed: int


@dataclass(frozen=True, eq=False)
class Progress:
    """A comparison as far as it is made.

    Attributes:
        compared: Every case that is done.
        document: `compared.document()`, which takes too long for the loop.
        share: Of all the work that is done.
        busy: More is to come.
        error: Why it cannot go on, else empty.
    """

    compared: Compared
    document: dict[str, Any]
    share: float = 0.0
    busy: bool = True
    error: str = ""


class RuleSetComparison:
    """What is chosen, and the answer; the loop owns it, except for `progress`.

    Attributes:
        workers: Threads that simulate; leave one core to the arena.
        vocabulary: Of the arena: what rule sets and scenarios must have to be compared.
        choice: As it is typed.
        progress: Of the newest comparison, replaced as runs come in; None before the first one.
    """

    def __init__(self, workers: int, scenario: Scenario, folder: Path = RUNS) -> None:
        self.workers = workers
        self.vocabulary = vocabulary_of(scenario)
        self.choice = self._first_choice()
        self.progress: Progress | None = None
        self._folder = folder
        self._files: dict[str, RuleSet] = {}
        self._kept: dict[str, Path] = {}
        self._newest: Newest[ComparisonQuestion] = Newest("comparison", self._answer)

    def move_to(self, scenario: Scenario) -> None:
        """Compare what is in a scenario's words from now on."""
        if vocabulary_of(scenario) is not self.vocabulary:
            self.cancel()
            self.vocabulary, self._files = vocabulary_of(scenario), {}
            self.choice = self._first_choice()

    def _first_choice(self) -> ComparisonChoice:
        """The table and the first presets, where the arena is."""
        return ComparisonChoice(rules=(TABLE, *list(self._presets)[:_FIRST_PRESETS]))

    @property
    def _presets(self) -> dict[str, RuleSet]:
        """The presets by title, those of the paper first."""
        presets = presets_of(self.vocabulary)
        ordered = sorted(presets, key=lambda name: (name not in ("evo8", "hand-coded"), name))
        return {presets[name].name: presets[name] for name in ordered}

    def rules_offered(self) -> list[str]:
        """Names of all rule sets that there are: table, presets, files, the best of the runs."""
        return [TABLE, *self._presets, *self._files, *self._kept]

    def scenarios_offered(self) -> list[str]:
        """Names of all scenarios; the first is that of the arena as it is now."""
        return [ARENA, *_scenarios_with(self.vocabulary)]

    def look_for_runs(self) -> None:
        """Find what the runs that are kept ended with; what is gone is no longer chosen."""
        self._kept = dict(_kept_rule_sets(self._folder))
        offered = set(self.rules_offered())
        if not offered.issuperset(self.choice.rules):
            left = tuple(name for name in self.choice.rules if name in offered)
            self.choice = replace(self.choice, rules=left)

    def change(self, **values: Any) -> None:
        """Choose otherwise, see `Choice`; why the last comparison failed is then of no interest."""
        self.choice = replace(self.choice, **values)
        if self.progress is not None and self.progress.error:
            self.progress = replace(self.progress, error="")

    def add_file(self, name: str, text: str) -> None:
        """Offer the rule set of a file, and choose it.

        Raises:
            RuleSetError: It cannot be read.
            ChoiceError: There are too many.
        """
        rule_set = read_rule_set(text, name, self.vocabulary)
        called = f"file {name}"
        if called not in self._files and len(self._files) == MOST_FILES:
            raise ChoiceError(f"{name}: {MOST_FILES} files are loaded, and no more can be")
        self._files[called] = rule_set
        self.choose("rules", called, True)

    def choose(self, what: str, name: str, wanted: bool) -> None:
        """Compare a rule set or a scenario too, or no longer.

        Args:
            what: `rules` or `scenarios`.
            name: One of those that are offered.
            wanted: Whether to.

        Raises:
            ChoiceError: It is not offered.
        """
        offered = {"rules": self.rules_offered, "scenarios": self.scenarios_offered}
        if what not in offered or name not in (known := offered[what]()):
            raise ChoiceError(f"there is no {name!r} among the {what} to compare")
        chosen = {*getattr(self.choice, what), name}
        if not wanted:
            chosen.remove(name)
        ordered = tuple(one for one in known if one in chosen)
        self.change(**{what: ordered})

    def start(self, table: RuleSet, arena: Scenario) -> None:
        """Begin what is chosen; a comparison under way is dropped.

        Args:
            table: The rules as they are edited.
            arena: The scenario as it is changed.

        Raises:
            ChoiceError: The choice has findings.
            RuleSetError: A rule set cannot be read.
        """
        choice = self.choice
        if found := choice.findings():
            raise ChoiceError("\n".join(f"{name}: {text}" for name, text in found.items()))
        rule_sets = {name: self._rule_set(name, table) for name in choice.rules}
        scenarios = tuple(
            arena.with_changes(name=ARENA) if name == ARENA else load_scenario(name)
            for name in choice.scenarios
        )
        against = choice.against if choice.against in rule_sets else choice.rules[0]
        question = ComparisonQuestion(rule_sets, scenarios, against, choice.runs, choice.seed)
        self.progress = _progress(question, {}, 0.0)
        self._newest.ask(question)

    def cancel(self) -> None:
        """End the comparison under way; what is done of it stays."""
        self._newest.ask(None)
        if self.progress is not None:
            self.progress = replace(self.progress, busy=False)

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def _rule_set(self, name: str, table: RuleSet) -> RuleSet:
        if name == TABLE:
            return table
        if name in self._presets:
            return self._presets[name]
        if name in self._files:
            return self._files[name]
        return load_rule_set(str(self._kept[name]), self.vocabulary)

    def _answer(self, question: ComparisonQuestion, stop: Stop) -> None:
        """Case after case, so that the first are seen soon and the arena has its turn."""
        cases = [Case(name, where) for where in question.scenarios for name in question.rule_sets]
        total = sum(case.scenario.robots for case in cases)
        samples: Samples = {}
        done = 0
        progress = _progress(question, samples, 0.0)
        try:
            for case in cases:
                samples |= run_cases(
                    [case], question.rule_sets, question.runs, question.seed, self.workers, stop
                )
                done += case.scenario.robots
                progress = _progress(question, samples, done / total)
                if not stop():
                    self.progress = progress
        except EvaluationStopped:
            pass
        except Exception as error:  # whatever it is: the arena goes on and the user is told
            words = f"{type(error).__name__}: {error}"
            self.progress = replace(progress, busy=False, error=words)
        if self.progress is progress:  # also if it was cancelled while this was published
            self.progress = replace(progress, busy=False)


@cache
def _scenarios_with(vocabulary: Vocabulary) -> tuple[str, ...]:
    """Names of the built-in scenarios in which the same rules can run."""
    return tuple(
        name for name in scenario_names() if vocabulary_of(load_scenario(name)) is vocabulary
    )


def _progress(question: ComparisonQuestion, samples: Samples, share: float) -> Progress:
    """What is known when these samples are in."""
    compared = Compared(
        question.rule_sets, dict(samples), question.against, question.runs, question.seed
    )
    return Progress(compared, compared.document(), share, busy=share < 1.0)


def _kept_rule_sets(folder: Path) -> Iterator[tuple[str, Path]]:
    """The best of each run and of each campaign below a folder, the newest first."""
    found = [*folder.glob("*/best.yaml"), *folder.glob("*/rules/best.yaml")]
    directories = [(path.relative_to(folder).parts[0], path) for path in found if path.is_file()]
    directories.sort(key=lambda item: item[1].stat().st_mtime, reverse=True)
    for directory, path in directories[:_MOST_KEPT]:
        yield best_of(directory), path
