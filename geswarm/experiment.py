"""Where evolution, simulator and rules meet: evaluating rule sets and evolving them to forage.

genome --mapping--> phenotype text --parse--> RuleSet --compile--> ControlTable --> collected
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import yaml

from geswarm import __version__
from geswarm.ge import (
    Engine,
    GenerationRecord,
    Grammar,
    Individual,
    Result,
    RunStore,
    Settings,
    SettingsError,
    Stopped,
    StoreError,
    evolve,
    geswarm_grammar,
)
from geswarm.rules import (
    FORAGING,
    ControlTable,
    Origin,
    RuleSet,
    Vocabulary,
    parse_text,
    save_rule_set,
)
from geswarm.rules.elements import format_probability
from geswarm.sim import (
    EvaluationStopped,
    Scenario,
    ScenarioError,
    Simulation,
    evaluate,
    parse_scenario,
)

Stop = Callable[[], bool]

_RUNS_PER_CALL = 50  # between two reports of progress


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One rule set in one scenario, run after run.

    Attributes:
        collected: Objects dropped in the nest, int64, shape (runs,); run i has the same random
            streams for every rule set.
        lost: Objects dropped elsewhere, the same shape.
    """

    collected: npt.NDArray[np.int64]
    lost: npt.NDArray[np.int64]

    @property
    def mean(self) -> float:
        """Mean of the collected objects."""
        return float(self.collected.mean())

    def summary(self) -> dict[str, Any]:
        """The runs and their figures, as JSON values; sd is the sample standard deviation."""
        return {
            "collected": self.collected.tolist(),
            "mean": self.mean,
            "sd": float(self.collected.std(ddof=1)) if self.collected.size > 1 else 0.0,
            "median": float(np.median(self.collected)),
            "lost_mean": float(self.lost.mean()),
        }


def evaluate_rule_sets(
    rule_sets: Sequence[RuleSet],
    scenario: Scenario,
    runs: int = 50,
    seed: int = 0,
    workers: int | None = None,
    stop: Stop | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> list[Evaluation]:
    """Run every rule set `runs` times; the result does not depend on the number of workers.

    Args:
        rule_sets: What to evaluate.
        scenario: Where.
        runs: Simulations of each.
        seed: Keys the random streams, together with the number of the run.
        workers: Threads; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        on_progress: Called with (simulations done, simulations in all).

    Raises:
        EvaluationStopped: `stop` returned True.
    """
    tables = [ControlTable.compile(rule_set) for rule_set in rule_sets]
    todo = [
        Simulation(table=table, seed=seed, replicate=run)
        for table in range(len(tables))
        for run in range(runs)
    ]
    counts = []
    for first in range(0, len(todo), _RUNS_PER_CALL):
        part = todo[first : first + _RUNS_PER_CALL]
        result = evaluate(tables, scenario, part, workers=workers, stop=stop)
        counts.append(np.stack([result.collected, result.lost]))
        if on_progress:
            on_progress(first + len(part), len(todo))
    collected, lost = np.concatenate(counts, axis=1).reshape(2, len(tables), runs)
    return [Evaluation(*pair) for pair in zip(collected, lost, strict=True)]


def foraging_grammar(vocabulary: Vocabulary = FORAGING) -> Grammar:
    """The paper's grammar over a vocabulary: its sentences are rule sets."""
    return geswarm_grammar(
        {
            "P_name": list(vocabulary.precondition_index),
            "B_name": list(vocabulary.behaviour_index),
            "IS_name": list(vocabulary.state_index),
            "value": [format_probability(p) for p in vocabulary.probabilities],
        }
    )


@dataclass(frozen=True)
class ForagingFitness:
    """Fitness of phenotypes: mean of the objects collected (paper, section 3.1.2).

    A fitness depends on seed, generation and individual alone, not on workers or on who else is
    evaluated.
    """

    scenario: Scenario
    seed: int
    evaluations: int
    workers: int | None = None
    stop: Stop | None = None

    def __call__(self, generation: int, individuals: Sequence[Individual]) -> list[float]:
        """Mean collected of each individual over `evaluations` simulations.

        Raises:
            Stopped: `stop` returned True.
        """
        tables, table_of = _compile_once(one.phenotype or "" for one in individuals)
        todo = [
            Simulation(table, self.seed, (generation << 32) + one.key, replicate)
            for table, one in zip(table_of, individuals, strict=True)
            for replicate in range(self.evaluations)
        ]
        try:
            result = evaluate(tables, self.scenario, todo, workers=self.workers, stop=self.stop)
        except EvaluationStopped as error:
            raise Stopped from error
        per_individual = result.collected.reshape(len(individuals), self.evaluations)
        return [float(mean) for mean in per_individual.mean(axis=1)]


def _compile_once(phenotypes: Iterable[str]) -> tuple[list[ControlTable], list[int]]:
    """The different control tables, and for each phenotype which one is its own."""
    positions: dict[str, int] = {}
    table_of = [positions.setdefault(phenotype, len(positions)) for phenotype in phenotypes]
    return [ControlTable.compile(parse_text(phenotype)) for phenotype in positions], table_of


class RunConfigError(ValueError):
    """The config.yaml of a run cannot be used."""


@dataclass(frozen=True)
class RunConfig:
    """Everything that decides how an evolutionary run goes."""

    scenario: Scenario
    settings: Settings
    seed: int = 0

    def to_yaml(self) -> str:
        """The text of config.yaml, everything resolved."""
        document = {
            "geswarm": __version__,
            "seed": self.seed,
            "evolution": asdict(self.settings),
            "scenario_name": self.scenario.name,
            "scenario": yaml.safe_load(self.scenario.to_yaml()),
        }
        return yaml.safe_dump(document, sort_keys=False, default_flow_style=None)

    @classmethod
    def from_yaml(cls, text: str) -> RunConfig:
        """Read what `to_yaml` wrote.

        Raises:
            RunConfigError: It is something else.
        """
        try:
            document = yaml.safe_load(text)
            scenario_text = yaml.safe_dump(document["scenario"])
            return cls(
                scenario=parse_scenario(scenario_text, str(document["scenario_name"])),
                settings=Settings(**document["evolution"]),
                seed=int(document["seed"]),
            )
        except (KeyError, TypeError, ValueError, ScenarioError, SettingsError) as error:
            raise RunConfigError(f"not the configuration of a run: {error}") from error
        except yaml.YAMLError as error:
            raise RunConfigError("not the configuration of a run: not valid YAML") from error


class EvolutionRun:
    """An evolutionary run in its directory: config.yaml, run.db, history.csv and best.yaml.

    Attributes:
        config: How it goes.
        directory: Where it is kept.
        history: One record per generation finished, those before a resume included.
    """

    def __init__(self, config: RunConfig, store: RunStore, engine: Engine) -> None:
        self.config = config
        self.directory = store.directory
        self.history: list[GenerationRecord] = store.history()
        self._store = store
        self._engine = engine

    @classmethod
    def create(cls, config: RunConfig, directory: str | Path) -> EvolutionRun:
        """Begin a run in a directory that holds none.

        Raises:
            StoreError: The directory holds a run already or cannot be written.
        """
        store = RunStore.create(directory, config.to_yaml())
        return cls(config, store, Engine(foraging_grammar(), config.settings, config.seed))

    @classmethod
    def resume(cls, directory: str | Path) -> EvolutionRun:
        """Continue a run exactly where its last complete generation ended.

        Raises:
            StoreError: There is no run, or it cannot be used.
        """
        store = RunStore.open(directory)
        try:
            config = RunConfig.from_yaml(store.config)
            state = store.checkpoint()
            grammar = foraging_grammar()
            if state is None:
                engine = Engine(grammar, config.settings, config.seed)
            else:
                engine = Engine.restore(grammar, config.settings, config.seed, state)
        except (ValueError, StoreError) as error:
            store.close()
            raise StoreError(f"{directory}: {error}") from error
        run = cls(config, store, engine)
        run._save_best()  # a run killed before it wrote best.yaml has it now
        return run

    @property
    def finished(self) -> bool:
        """All generations are done."""
        return self._engine.finished

    @property
    def best(self) -> RuleSet | None:
        """The best rule set so far, with its origin; None before the first generation."""
        best = self._engine.best
        if best is None or best.phenotype is None:
            return None
        origin = Origin(run=str(self.directory), generation=best.generation, fitness=best.fitness)
        name = f"Evolved, seed {self.config.seed}, generation {best.generation}"
        return replace(parse_text(best.phenotype), name=name, origin=origin)

    def run(
        self,
        workers: int | None = None,
        on_generation: Callable[[GenerationRecord], None] | None = None,
        stop: Stop | None = None,
    ) -> Result:
        """Evolve to the last generation or until `stop` returns True; can be called again.

        Raises:
            StoreError: A generation could not be written; those before it are safe.
        """
        saved = None

        def after_generation(record: GenerationRecord) -> None:
            nonlocal saved
            self.history.append(record)
            if self.best != saved:
                saved = self.best
                self._save_best()
            if on_generation:
                on_generation(record)

        fitness = ForagingFitness(
            self.config.scenario,
            self.config.seed,
            self.config.settings.evaluations,
            workers,
            stop,
        )
        return evolve(self._engine, fitness, self._store, after_generation, stop)

    def _save_best(self) -> None:
        if self.best is not None:
            try:
                save_rule_set(self.best, self.directory / "best.yaml")
            except OSError as error:
                raise StoreError(f"{self.directory}: cannot write best.yaml: {error}") from error

    def close(self) -> None:
        """Close the directory."""
        self._store.close()
