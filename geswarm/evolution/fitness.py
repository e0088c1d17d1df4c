"""What a phenotype is worth: the objective of a swarm under its rules."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import CancelledError, Executor, wait
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm import __version__
from geswarm.evolution.composition import Composition
from geswarm.ge import Individual, Stopped
from geswarm.rules import Rule
from geswarm.sim import EvaluationStopped, Scenario, Simulation, Stop, can_run, evaluate

_SHARE_ROBOT_STEPS = 8_000_000  # what is sent to an executor at once: a fraction of a second's work
_PATIENCE = 0.2  # seconds between two looks at `stop` while an executor works


class EvaluationError(RuntimeError):
    """An executor could not do its work; the generation at work is lost, no more."""


@dataclass(frozen=True)
class ScenarioFitness:
    """Fitness of phenotypes: mean of the scenario's objective, less if that is to be minimised.

    A fitness depends on seed, generation and individual alone (with common random numbers: on seed,
    generation and behaviour), not on where it is evaluated or who else is.

    Attributes:
        scenario: Where they act.
        seed: Keys the random streams, together with generation, individual and replicate.
        evaluations: Simulations per individual.
        workers: Threads, if there is no executor; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        common_random_numbers: The streams are keyed by the generation, not by the individual.
        frozen: Rules that stand before the evolved ones.
        executor: Evaluates in shares, anywhere: what travels is text and numbers.
    """

    scenario: Scenario
    seed: int
    evaluations: int
    workers: int | None = None
    stop: Stop | None = None
    common_random_numbers: bool = False
    frozen: tuple[Rule, ...] = ()
    executor: Executor | None = None

    def __call__(self, generation: int, individuals: Sequence[Individual]) -> list[float]:
        """Mean gain of each individual over `evaluations` simulations, more is better.

        Raises:
            Stopped: `stop` returned True.
            EvaluationError: The executor failed.
        """
        told = dict.fromkeys(one.phenotype or "" for one in individuals)
        phenotypes = [phenotype for phenotype in told if self._can_run(phenotype)]
        position = {phenotype: at for at, phenotype in enumerate(phenotypes)}
        todo = [
            Simulation(
                position[one.phenotype or ""],
                self.seed,
                (generation << 32) + (0 if self.common_random_numbers else one.key),
                replicate,
            )
            for one in individuals
            if (one.phenotype or "") in position
            for replicate in range(self.evaluations)
        ]
        gains = (self._here if self.executor is None else self._elsewhere)(phenotypes, todo)
        means = iter(gains.reshape(-1, self.evaluations).mean(axis=1).tolist())
        found = [next(means) if (i.phenotype or "") in position else None for i in individuals]
        worst = min([0.0, *(mean for mean in found if mean is not None)])
        return [worst if mean is None else mean for mean in found]

    def _can_run(self, phenotype: str) -> bool:
        """Whether the simulator has room for the rules; those it has not are worth the least."""
        composition = Composition.of(self.scenario, self.frozen)
        return can_run(composition.rule_set(phenotype), self.scenario)

    def _here(self, phenotypes: list[str], todo: list[Simulation]) -> npt.NDArray[np.float64]:
        composition = Composition.of(self.scenario, self.frozen)
        rule_sets = [composition.rule_set(phenotype) for phenotype in phenotypes]
        try:
            result = evaluate(rule_sets, self.scenario, todo, workers=self.workers, stop=self.stop)
        except EvaluationStopped as error:
            raise Stopped from error
        return self.scenario.objective.gain(result.fitness)

    def _elsewhere(self, phenotypes: list[str], todo: list[Simulation]) -> npt.NDArray[np.float64]:
        """The same in shares, by the executor; a share names only the phenotypes that it needs."""
        assert self.executor is not None
        size = max(1, _SHARE_ROBOT_STEPS // (self.scenario.robots * self.scenario.steps))
        futures = []
        try:
            for first in range(0, len(todo), size):
                share = todo[first : first + size]
                needed = sorted({one.table for one in share})
                moved = [one._replace(table=needed.index(one.table)) for one in share]
                texts = [phenotypes[at] for at in needed]
                futures.append(
                    self.executor.submit(
                        simulate_share, __version__, self.scenario, self.frozen, texts, moved
                    )
                )
            waiting = set(futures)
            while waiting:
                if self.stop is not None and self.stop():
                    raise Stopped
                _, waiting = wait(waiting, timeout=_PATIENCE)
            return np.concatenate([future.result() for future in futures])
        except Stopped:
            raise
        except Exception as error:  # whatever an executor raises: the run can be resumed
            raise EvaluationError(f"the simulations could not be run: {_why(error)}") from error
        finally:
            for future in futures:
                future.cancel()


def _why(error: Exception) -> str:
    """What an executor's failure means."""
    if isinstance(error, CancelledError):
        return "they were given up; the scheduler of the cluster is gone"
    reason = f"{type(error).__name__}: {error}"
    if isinstance(error, ImportError):
        return f"a worker cannot import what it needs, GESwarm {__version__}: {reason}"
    return reason


def simulate_share(
    version: str,
    scenario: Scenario,
    frozen: tuple[Rule, ...],
    phenotypes: Sequence[str],
    simulations: Sequence[Simulation],
) -> npt.NDArray[np.float64]:
    """What an executor's worker does: run simulations in one thread.

    Args:
        version: GESwarm's version where the evolution runs.
        scenario: The scenario.
        frozen: Rules that stand before the evolved ones.
        phenotypes: What `Simulation.table` is an index into.
        simulations: The runs.

    Returns:
        Gains, float64, shape (simulations,).

    Raises:
        RuntimeError: This machine has another version, whose results could differ.
    """
    if version != __version__:
        raise RuntimeError(f"expected GESwarm {version} on every worker, found {__version__}")
    composition = Composition.of(scenario, frozen)
    rule_sets = [composition.rule_set(phenotype) for phenotype in phenotypes]
    return scenario.objective.gain(evaluate(rule_sets, scenario, simulations, workers=1).fitness)
