"""What a phenotype is worth: the objects that a swarm under its rules collects.

genome --mapping--> phenotype text --parse--> RuleSet --compile--> ControlTable --> collected
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, wait
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geswarm import __version__
from geswarm.ge import (
    Grammar,
    Individual,
    NotASentenceError,
    Stopped,
    genome_of,
    geswarm_grammar,
)
from geswarm.rules import (
    FORAGING,
    ControlTable,
    Rule,
    RuleSet,
    Vocabulary,
    format_text,
    parse_text,
)
from geswarm.rules.elements import format_probability
from geswarm.rules.reachability import reachable_situations
from geswarm.sim import EvaluationStopped, Scenario, Simulation, evaluate

Stop = Callable[[], bool]

_SHARE_ROBOT_STEPS = 8_000_000  # what is sent to an executor at once: a fraction of a second's work
_PATIENCE = 0.2  # seconds between two looks at `stop` while an executor works


class InjectionError(ValueError):
    """A rule set cannot enter a population; says which rule and why."""


class EvaluationError(RuntimeError):
    """An executor could not do its work; the generation at work is lost, no more."""


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
class Composition:
    """From phenotypes to rule sets: rules that evolution must not change, then the evolved ones.

    Attributes:
        frozen: The rules that come first; usually none.
    """

    frozen: tuple[Rule, ...] = ()

    def rule_set(self, phenotype: str) -> RuleSet:
        """The whole rule set."""
        return RuleSet((*self.frozen, *parse_text(phenotype).rules))

    def phenotype(self, rule_set: RuleSet) -> str:
        """The phenotype that becomes a rule set; rules that are switched off are left out.

        Raises:
            InjectionError: It does not begin with the frozen rules, has none besides them, or the
                grammar does not derive the others: says which rule and why.
        """
        rules = tuple(map(_bare, rule_set.active_rules))
        frozen = len(self.frozen)
        for number, (rule, expected) in enumerate(zip(rules, self.frozen, strict=False), start=1):
            if rule != _bare(expected):
                raise InjectionError(f"rule {number} is frozen, expected it unchanged")
        if len(rules) <= frozen:
            raise InjectionError(f"expected more than {frozen} rules switched on, got {len(rules)}")
        for number, rule in enumerate(rules[frozen:], start=frozen + 1):
            for action in rule.actions:
                _require_listed(action.p, number)
        text = format_text(RuleSet(rules[frozen:])).removeprefix('name ""')
        phenotype = " ".join(text.split())
        try:
            genome_of(foraging_grammar(), phenotype)
        except NotASentenceError as error:
            raise InjectionError(f"the grammar does not derive these rules: {error}") from error
        return phenotype

    def behaviour(self, phenotype: str) -> bytes:
        """Equal for phenotypes under which robots decide the same: an engine's `identity`.

        The control table in the situations that robots can get into, to twelve decimals.
        """
        return _behaviour(self, phenotype)


def _require_listed(p: float, rule: int) -> None:
    listed = FORAGING.probabilities
    if p not in listed:
        nearest = format_probability(min(listed, key=lambda one: abs(one - p)))
        raise InjectionError(
            f"rule {rule}: p = {format_probability(p)} cannot evolve, expected one of "
            f"{', '.join(map(format_probability, listed))}; the nearest is {nearest}"
        )


def _bare(rule: Rule) -> Rule:
    return replace(rule, comment="", enabled=True)


@lru_cache(maxsize=1024)
def _table(composition: Composition, phenotype: str) -> ControlTable:
    return ControlTable.compile(composition.rule_set(phenotype))


@lru_cache(maxsize=4096)
def _behaviour(composition: Composition, phenotype: str) -> bytes:
    table = _table(composition, phenotype)
    indexing = table.indexing
    shape = (indexing.percepts, indexing.behaviours * indexing.states, indexing.outcomes)
    decisions = table.probabilities.reshape(shape).round(12)
    reachable = reachable_situations(decisions, table.vocabulary)
    return np.packbits(reachable).tobytes() + (decisions[reachable] + 0.0).tobytes()


@dataclass(frozen=True)
class ForagingFitness:
    """Fitness of phenotypes: mean of the objects collected (paper, section 3.1.2).

    A fitness depends on seed, generation and individual alone (with common random numbers: on seed,
    generation and behaviour), not on where it is evaluated or who else is.

    Attributes:
        scenario: Where they forage.
        seed: Keys the random streams, together with generation, individual and replicate.
        evaluations: Simulations per individual.
        workers: Threads, if there is no executor; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        common_random_numbers: The streams are keyed by the generation, not by the individual.
        composition: What a phenotype becomes.
        executor: Evaluates in shares, anywhere: what travels is text and numbers.
    """

    scenario: Scenario
    seed: int
    evaluations: int
    workers: int | None = None
    stop: Stop | None = None
    common_random_numbers: bool = False
    composition: Composition = field(default_factory=Composition)
    executor: Executor | None = None

    def __call__(self, generation: int, individuals: Sequence[Individual]) -> list[float]:
        """Mean collected of each individual over `evaluations` simulations.

        Raises:
            Stopped: `stop` returned True.
            EvaluationError: The executor failed.
        """
        phenotypes = list(dict.fromkeys(one.phenotype or "" for one in individuals))
        position = {phenotype: at for at, phenotype in enumerate(phenotypes)}
        todo = [
            Simulation(
                position[one.phenotype or ""],
                self.seed,
                (generation << 32) + (0 if self.common_random_numbers else one.key),
                replicate,
            )
            for one in individuals
            for replicate in range(self.evaluations)
        ]
        collected = (self._here if self.executor is None else self._elsewhere)(phenotypes, todo)
        per_individual = collected.reshape(len(individuals), self.evaluations)
        return [float(mean) for mean in per_individual.mean(axis=1)]

    def _here(self, phenotypes: list[str], todo: list[Simulation]) -> npt.NDArray[np.int64]:
        tables = [_table(self.composition, phenotype) for phenotype in phenotypes]
        try:
            result = evaluate(tables, self.scenario, todo, workers=self.workers, stop=self.stop)
        except EvaluationStopped as error:
            raise Stopped from error
        return result.collected

    def _elsewhere(self, phenotypes: list[str], todo: list[Simulation]) -> npt.NDArray[np.int64]:
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
                        simulate_share, __version__, self.scenario, self.composition, texts, moved
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
            raise EvaluationError(
                f"the simulations could not be run: {type(error).__name__}: {error}"
            ) from error
        finally:
            for future in futures:
                future.cancel()


def simulate_share(
    version: str,
    scenario: Scenario,
    composition: Composition,
    phenotypes: Sequence[str],
    simulations: Sequence[Simulation],
) -> npt.NDArray[np.int64]:
    """What an executor's worker does: run simulations in one thread.

    Args:
        version: GESwarm's version where the evolution runs.
        scenario: The scenario.
        composition: What a phenotype becomes.
        phenotypes: What `Simulation.table` is an index into.
        simulations: The runs.

    Returns:
        Objects collected, int64, shape (simulations,).

    Raises:
        RuntimeError: This machine has another version, whose results could differ.
    """
    if version != __version__:
        raise RuntimeError(f"expected GESwarm {version} on every worker, found {__version__}")
    tables = [_table(composition, phenotype) for phenotype in phenotypes]
    return evaluate(tables, scenario, simulations, workers=1).collected
