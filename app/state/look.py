"""A run as people look at it at one moment, whether it is under way or long over."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from geswarm.evaluation import shown as figure
from geswarm.evolution import EvolutionRun, Population, RunConfig
from geswarm.ge import (
    GenerationRecord,
    Injection,
    Settings,
    StoredIndividual,
    StoredSteering,
    StoreError,
)
from geswarm.rules import Origin, RuleSet, Vocabulary

from .behaviours import Label, Labels
from .run_folder import stamp_of


@dataclass(frozen=True)
class Mark:
    """What a person did to a run.

    Attributes:
        generation: The first one that it acted on.
        text: What it was.
        fitness: Of the rules that entered; None if it was something else.
    """

    generation: int
    text: str
    fitness: float | None = None


@dataclass(frozen=True)
class Chosen:
    """An individual that is looked at.

    Attributes:
        run: Name of its run.
        generation: For which it was bred.
        key: Its number among those.
        fitness: What is known of it.
        rule_set: Its rules.
        vocabulary: Of its scenario.
    """

    run: str
    generation: int
    key: int
    fitness: float
    rule_set: RuleSet
    vocabulary: Vocabulary


@dataclass(frozen=True, eq=False)
class Look:
    """A run at one moment.

    Attributes:
        directory: Where it is kept.
        config: How it began.
        settings: As they are now.
        history: All generations so far.
        marks: What people did to it.
        population: After the last of these generations.
        labels: What its behaviours are told by, by `Member.behaviour`.
        ancestors: The best individual and everyone it descends from, oldest first.
        best: The best rule set; None before the first generation.
    """

    directory: Path
    config: RunConfig
    settings: Settings
    history: tuple[GenerationRecord, ...]
    marks: tuple[Mark, ...]
    population: Population
    labels: Mapping[str, Label]
    ancestors: tuple[StoredIndividual, ...]
    best: RuleSet | None

    @classmethod
    def at(cls, run: EvolutionRun, labels: Labels) -> Look:
        """Look at a run.

        Args:
            run: It.
            labels: Those of its behaviours so far.

        Raises:
            StoreError: It cannot be read, perhaps because it was closed meanwhile.
        """
        population = run.population()
        return cls(
            run.directory,
            run.config,
            run.settings,
            tuple(run.history),
            _marks(run),
            population,
            labels.of(population),
            tuple(run.genealogy()),
            run.best,
        )

    @property
    def finished(self) -> bool:
        """All generations are done."""
        return len(self.history) >= self.config.settings.generations

    def individual(self, generation: int, key: int) -> Chosen | None:
        """Somebody of the population or of the ancestors; None if it is invalid or not there."""
        for member in self.population.members:
            if (member.generation, member.key) == (generation, key) and member.rule_set:
                return self._chosen(generation, key, member.fitness, member.rule_set)
        return self.stored(self.ancestors, generation, key)

    def stored(
        self, individuals: Sequence[StoredIndividual], generation: int, key: int
    ) -> Chosen | None:
        """One of the stored individuals of this run; None if it is invalid or not there."""
        for one in individuals:
            if (one.generation, one.key) == (generation, key) and one.phenotype is not None:
                rule_set = self.config.composition.rule_set(one.phenotype)
                return self._chosen(generation, key, one.fitness, rule_set)
        return None

    def _chosen(self, generation: int, key: int, fitness: float, rule_set: RuleSet) -> Chosen:
        name = f"Generation {generation}, individual {key}"
        origin = Origin(run=str(self.directory), generation=generation, fitness=fitness)
        named = replace(rule_set, name=name, origin=origin)
        known = self.config.composition.vocabulary
        return Chosen(self.directory.name, generation, key, fitness, named, known)


def main_line(ancestors: Sequence[StoredIndividual]) -> list[StoredIndividual]:
    """The last of the ancestors, its first parent, that one's first parent and so on."""
    births = {(one.generation, one.key): one for one in ancestors}
    line = [*ancestors[-1:]]
    while line and line[-1].parents and line[-1].parents[0] in births:
        line.append(births[line[-1].parents[0]])
    return line


class Lens:
    """Keeps a look at one run up to date; what has not changed is not read again.

    Attributes:
        look: The run; None if there is none, or none that can be read.
        problem: Why it cannot be read, else empty.
    """

    def __init__(self) -> None:
        self.look: Look | None = None
        self.problem = ""
        self._seen: tuple[object, ...] = ()
        self._labels = Labels()

    def turn_to(self, directory: Path | None, live: EvolutionRun | None) -> None:
        """Look at a run again, or at another one, or at none.

        Args:
            directory: Where it is kept.
            live: The run itself while this process writes it, else it is read from there.
        """
        written = () if directory is None else stamp_of(directory)
        seen = (directory, written if live is None else (live, len(live.history)))
        if seen == self._seen:
            return
        if self._seen[:1] != (directory,):
            self._labels = Labels()
        look, problem = None, ""
        try:
            if live is not None:
                look = Look.at(live, self._labels)
            elif directory is not None:
                look = _read(directory, self._labels)
        except Exception as error:  # damaged in whatever way: the dashboard goes on
            problem = str(error) if isinstance(error, StoreError) else f"{directory}: {error!r}"
        self.look, self.problem, self._seen = look, problem, seen


def _read(directory: Path, labels: Labels) -> Look:
    run = EvolutionRun.read(directory)
    try:
        return Look.at(run, labels)
    finally:
        run.close()


def _marks(run: EvolutionRun) -> tuple[Mark, ...]:
    """What was done to a run up to the last generation that is finished."""
    done = [change for change in tuple(run.steering) if change.generation <= len(run.history)]
    present = run.config.settings.steerable
    marks = []
    entered = 0
    for before, change in zip([None, *done], done, strict=False):
        if before is None or before.generation != change.generation:
            entered = 0
        if isinstance(change.what, Injection):
            marks.append(_entry(run, change, entered))
            entered += 1
        else:
            steered = change.what.settings.items()
            words = [f"{name} {present[name]:g} → {value:g}" for name, value in steered]
            present |= change.what.settings
            marks.append(Mark(change.generation, ", ".join(words)))
    return tuple(marks)


def _entry(run: EvolutionRun, change: StoredSteering, number: int) -> Mark:
    """Rules that entered: the injected are bred after all others, in their order."""
    key = run.config.settings.population + number
    (one,) = [one for one in run.bred(change.generation) if one.key == key]
    text = f"rules from the table entered, fitness {figure(one.fitness)}"
    return Mark(change.generation, text, one.fitness)
