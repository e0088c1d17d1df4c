"""The evolutionary algorithm as an ask/tell engine (paper, section 3.1.2; GEVA 2.0).

One generation: `population` offspring are bred by roulette-wheel selection, single-point crossover
and mutation; the worst of them make room for the elites of the generation before, which keep their
fitness. Parameters (grammar, settings, seed) are apart from the state, which is one JSON value.
Random numbers are keyed by (seed, generation, purpose), so a restored engine continues exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any, TypeAlias

import numpy as np

from geswarm.ge.grammar import Grammar
from geswarm.ge.mapping import CODON_LIMIT, Genome, Mapper
from geswarm.ge.operators import mutate, random_genome, roulette, single_point_crossover
from geswarm.ge.record import GenerationRecord
from geswarm.ge.settings import Settings

State: TypeAlias = dict[str, Any]
"""An engine's state in JSON types: see `Engine.state`."""

WORST_FITNESS = 0.0


class CallOrderError(RuntimeError):
    """`ask` and `tell` were not called in turn."""


class FitnessError(ValueError):
    """What was told is not one finite fitness >= 0 for each asked individual."""


class CheckpointError(ValueError):
    """A state does not belong to this engine, or is damaged."""


@dataclass(frozen=True)
class Individual:
    """A genome and what it maps to.

    Attributes:
        generation: Generation for which it was bred; the initial one is 1.
        key: Its number among those bred for that generation, from 0; an evaluator keys its random
            streams by (seed, generation, key).
        genome: Codons.
        phenotype: A sentence of the grammar, or None if the mapping did not finish.
        used: Codons that the mapping read, wrapping included.
        fitness: None as long as it is not evaluated.
    """

    generation: int
    key: int
    genome: Genome
    phenotype: str | None
    used: int
    fitness: float | None = None


class _Purpose(IntEnum):
    """What random numbers are for; part of their key."""

    INITIALISATION = 0
    SELECTION = 1
    CROSSOVER = 2
    MUTATION = 3


class Engine:
    """Evolves sentences of a grammar; whoever calls it evaluates them.

    Example:
        engine = Engine(grammar, Settings(generations=50), seed=1)
        while not engine.finished:
            asked = engine.ask()
            engine.tell([evaluate(individual.phenotype) for individual in asked])

    Attributes:
        grammar: The grammar.
        settings: The parameters.
        seed: Whole number >= 0; equal seeds give equal runs.
        generation: Generations that are finished.
        population: Individuals of the last finished generation, all with a fitness.
        best: The individual with the highest fitness so far; the first of equals.
    """

    def __init__(self, grammar: Grammar, settings: Settings | None = None, seed: int = 0) -> None:
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise ValueError(f"seed: expected a whole number >= 0, got {seed!r}")
        self.grammar = grammar
        self.settings = settings or Settings()
        self.seed = seed
        self.generation = 0
        self.population: tuple[Individual, ...] = ()
        self.best: Individual | None = None
        self._mapper = Mapper(grammar)
        self._offspring: list[Individual] | None = None

    @property
    def finished(self) -> bool:
        """All generations of the settings are evaluated."""
        return self.generation >= self.settings.generations

    def ask(self) -> list[Individual]:
        """Breed the next generation; all valid individuals of it need an evaluation.

        Equal phenotypes are all asked for, as in the paper. What is asked depends on nothing but
        the parameters and the state: after `withdraw` the same individuals are asked again.

        Raises:
            CallOrderError: The individuals asked before were not told.
        """
        if self._offspring is not None:
            raise CallOrderError(
                f"ask() called twice: expected tell() with {len(self._asked())} fitness values for "
                f"generation {self.generation + 1} first, or withdraw()"
            )
        genomes = self._breed() if self.population else self._initial_genomes()
        self._offspring = [self._individual(key, genome) for key, genome in enumerate(genomes)]
        return self._asked()

    def tell(self, fitness: Sequence[float], seconds: float = 0.0) -> GenerationRecord:
        """Give the fitness of the asked individuals, in their order; ends the generation.

        Args:
            fitness: One finite number >= 0 per asked individual.
            seconds: Wall-clock time of the generation, for the record.

        Raises:
            CallOrderError: Nothing was asked.
            FitnessError: Wrong number of values, or a value that cannot be used; nothing is changed
                then, and a correct `tell` may follow.
        """
        if self._offspring is None:
            raise CallOrderError("tell() without ask(): expected ask() before each tell()")
        values = iter(_checked_fitness(fitness, self._asked()))
        offspring = [
            replace(one, fitness=WORST_FITNESS if one.phenotype is None else next(values))
            for one in self._offspring
        ]
        elites = _ranked(self.population)[: self.settings.elites]
        survivors = _ranked(offspring)[: len(offspring) - len(elites)]
        self.population = tuple(elites + survivors)
        self.generation += 1
        self._offspring = None
        champion = max(self.population, key=_fitness_of)
        if self.best is None or _fitness_of(champion) > _fitness_of(self.best):
            self.best = champion
        return self._record(offspring, self.best, seconds)

    def withdraw(self) -> None:
        """Forget the individuals that were asked but not told, if any."""
        self._offspring = None

    def state(self) -> State:
        """Everything that `restore` needs besides the parameters, in JSON types.

        Individuals that were asked but not told are not part of it.
        """
        return {
            "generation": self.generation,
            "population": [_to_json(one) for one in self.population],
            "best": None if self.best is None else _to_json(self.best),
        }

    @classmethod
    def restore(
        cls, grammar: Grammar, settings: Settings | None, seed: int, state: Mapping[str, Any]
    ) -> Engine:
        """An engine that continues exactly where `state` was taken.

        Raises:
            CheckpointError: The state is damaged, or was made with another grammar.
        """
        engine = cls(grammar, settings, seed)
        try:
            engine.generation = int(state["generation"])
            engine.population = tuple(engine._from_json(one) for one in state["population"])
            best = state["best"]
            engine.best = None if best is None else engine._from_json(best)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise CheckpointError(
                "checkpoint: expected generation, population and best as state() gives them, "
                f"got {type(error).__name__}: {error}"
            ) from error
        if best is not None and engine.best and engine.best.phenotype != best["phenotype"]:
            raise CheckpointError(
                "checkpoint: its genomes do not map to the recorded sentences, expected the "
                f"grammar and vocabulary of the run, got {grammar.source}"
            )
        return engine

    def _rng(self, purpose: _Purpose) -> np.random.Generator:
        key = (self.seed, self.generation + 1, int(purpose))
        return np.random.default_rng(np.random.SeedSequence(key))

    def _individual(self, key: int, genome: Genome) -> Individual:
        phenotype, used = self._mapper.map(genome, self.settings.max_wraps)
        return Individual(self.generation + 1, key, genome, phenotype, used)

    def _asked(self) -> list[Individual]:
        return [one for one in self._offspring or () if one.phenotype is not None]

    def _initial_genomes(self) -> list[Genome]:
        rng = self._rng(_Purpose.INITIALISATION)
        longest = self.settings.max_codons
        return [random_genome(self._mapper, longest, rng) for _ in range(self.settings.population)]

    def _breed(self) -> list[Genome]:
        """Selection, crossover of neighbouring pairs, mutation."""
        size = self.settings.population
        fitness = [_fitness_of(one) for one in self.population]
        chosen = roulette(fitness, size + size % 2, self._rng(_Purpose.SELECTION))
        genomes = [self.population[index].genome for index in chosen]
        rng = self._rng(_Purpose.CROSSOVER)
        for at in range(0, len(genomes), 2):
            if rng.random() < self.settings.crossover:
                genomes[at : at + 2] = single_point_crossover(
                    genomes[at], genomes[at + 1], self.settings.max_codons, rng
                )
        rng = self._rng(_Purpose.MUTATION)
        return [mutate(genome, self.settings.mutation, rng) for genome in genomes[:size]]

    def _record(
        self, offspring: list[Individual], best: Individual, seconds: float
    ) -> GenerationRecord:
        fitness = [_fitness_of(one) for one in offspring]
        return GenerationRecord(
            generation=self.generation,
            best_so_far=_fitness_of(best),
            best=max(fitness),
            mean=math.fsum(fitness) / len(fitness),
            invalid=sum(one.phenotype is None for one in offspring),
            distinct=len({one.phenotype for one in offspring} - {None}),
            seconds=seconds,
        )

    def _from_json(self, data: Mapping[str, Any]) -> Individual:
        genome = tuple(data["genome"])
        if not genome or not all(type(c) is int and 0 <= c < CODON_LIMIT for c in genome):
            raise ValueError(f"genome of individual {data['key']}: codons in [0, {CODON_LIMIT})")
        phenotype, used = self._mapper.map(genome, self.settings.max_wraps)
        generation, key = int(data["generation"]), int(data["key"])
        return Individual(generation, key, genome, phenotype, used, float(data["fitness"]))


def _fitness_of(individual: Individual) -> float:
    return WORST_FITNESS if individual.fitness is None else individual.fitness


def _ranked(individuals: Sequence[Individual]) -> list[Individual]:
    """Best first; equals stay in their order."""
    return sorted(individuals, key=_fitness_of, reverse=True)


def _to_json(individual: Individual) -> dict[str, Any]:
    return {
        "generation": individual.generation,
        "key": individual.key,
        "fitness": individual.fitness,
        "phenotype": individual.phenotype,
        "genome": list(individual.genome),
    }


def _checked_fitness(fitness: Sequence[float], asked: list[Individual]) -> list[float]:
    if len(fitness) != len(asked):
        raise FitnessError(
            f"fitness: expected {len(asked)} values, one per asked individual, got {len(fitness)}"
        )
    values: list[float] = []
    for value, one in zip(fitness, asked, strict=True):
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number) or number < 0:
            raise FitnessError(
                f"fitness of individual {one.key}: expected a finite number >= 0 "
                f"(roulette-wheel selection), got {value!r}"
            )
        values.append(number)
    return values
