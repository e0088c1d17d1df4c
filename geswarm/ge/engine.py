"""The evolutionary algorithm as an ask/tell engine (paper, section 3.1.2; GEVA 2.0).

One generation: `population` offspring are bred; the worst of them make room for the elites of the
generation before, or all compete (`Settings.reevaluate_elites`). Parameters (grammar, settings,
seed) are apart from the state, which is one JSON value. Random numbers are keyed by (seed,
generation, purpose), so a restored engine continues exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from geswarm.ge.derivation import DerivationTrees
from geswarm.ge.grammar import Grammar
from geswarm.ge.individual import WORST_FITNESS, Individual, from_json, to_json
from geswarm.ge.inverse import genome_of
from geswarm.ge.mapping import Genome, Mapper
from geswarm.ge.ranking import noise_of, ranked
from geswarm.ge.record import GenerationRecord
from geswarm.ge.settings import Settings
from geswarm.ge.variation import Child, Purpose, breed, initial

State: TypeAlias = dict[str, Any]
"""An engine's state in JSON types: see `Engine.state`."""

Identity: TypeAlias = Callable[[str], Hashable]
"""Phenotype -> a value that is equal for phenotypes that behave the same."""

TRUSTED = 10
"""Evaluations after which a mean is believed as much as any other."""


class CallOrderError(RuntimeError):
    """`ask`, `tell` or steering came when it was not its turn."""


class FitnessError(ValueError):
    """What was told is not one finite fitness for each asked individual."""


class CheckpointError(ValueError):
    """A state does not belong to this engine, or is damaged."""


class Engine:
    """Evolves sentences of a grammar; whoever calls it evaluates them.

    Example:
        engine = Engine(grammar, Settings(generations=50), seed=1)
        while not engine.finished:
            asked = engine.ask()
            engine.tell([evaluate(individual.phenotype) for individual in asked])

    Attributes:
        grammar: The grammar.
        settings: The parameters; some of them can be steered.
        seed: Whole number >= 0; equal seeds give equal runs.
        generation: Generations that are finished.
        population: Individuals of the last finished generation, all with a fitness, in the order
            of their ranking; injected ones that would not have survived come last.
        offspring: What was bred for it, with the fitness of then; includes those that did not
            survive.
        best: The individual with the highest fitness so far, the first of equals; if elites are
            evaluated again, the first in the ranking of those with `TRUSTED` evaluations, or with
            as many as any has.
    """

    def __init__(
        self,
        grammar: Grammar,
        settings: Settings | None = None,
        seed: int = 0,
        identity: Identity | None = None,
    ) -> None:
        """Make an engine that has not begun.

        Args:
            grammar: What to evolve sentences of.
            settings: The paper's unless given.
            seed: Whole number >= 0.
            identity: Tells which phenotypes behave the same, for settings that share evaluations;
                without it only equal phenotypes do.
        """
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise ValueError(f"seed: expected a whole number >= 0, got {seed!r}")
        self.grammar = grammar
        self.settings = settings or Settings()
        self.seed = seed
        self.generation = 0
        self.population: tuple[Individual, ...] = ()
        self.offspring: tuple[Individual, ...] = ()
        self.best: Individual | None = None
        self._identity = identity or str
        self._mapper = Mapper(grammar)
        self._trees = DerivationTrees(grammar)
        self._injected: list[Individual] = []
        self._bred: list[Individual] | None = None
        self._worst = WORST_FITNESS
        self._asked: dict[Hashable, Individual] = {}

    @property
    def finished(self) -> bool:
        """All generations of the settings are evaluated."""
        return self.generation >= self.settings.generations

    def ask(self) -> list[Individual]:
        """Breed the next generation; returns who needs an evaluation.

        As in the paper that is every valid individual, also equal ones; settings can have
        individuals that behave the same share one evaluation, and elites evaluated again. What is
        asked depends on nothing but the parameters, the state and the steering: after `withdraw`
        the same individuals are asked again.

        Raises:
            CallOrderError: The individuals asked before were not told.
        """
        if self._bred is not None:
            raise CallOrderError(
                f"ask() called twice: expected tell() with {len(self._asked)} fitness values for "
                f"generation {self.generation + 1} first, or withdraw()"
            )
        tools = self._trees, self.settings, self._random, self._novelty()
        if self.population:
            children = breed(self.population, *tools)
        else:
            children = initial(self._mapper, *tools)
        self._bred = [self._individual(key, child) for key, child in enumerate(children)]
        self._bred += self._injected
        again = self._elites() if self.settings.reevaluate_elites else []
        known = {self._same(one) for one in self.population}
        fresh = (one for one in self._bred if one.phenotype and self._same(one) not in known)
        for one in (*again, *fresh):
            self._asked.setdefault(self._same(one), one)
        return list(self._asked.values())

    def tell(self, fitness: Sequence[float], seconds: float = 0.0) -> GenerationRecord:
        """Give the fitness of the asked individuals, in their order; ends the generation.

        Args:
            fitness: One finite number per asked individual, more is better. What is invalid is
                worth 0, or as little as the worst of them and of the population if that is less.
            seconds: Wall-clock time of the generation, for the record.

        Raises:
            CallOrderError: Nothing was asked.
            FitnessError: Wrong number of values, or a value that cannot be used; nothing is changed
                then, and a correct `tell` may follow.
        """
        if self._bred is None:
            raise CallOrderError("tell() without ask(): expected ask() before each tell()")
        values = _checked_fitness(fitness, list(self._asked.values()))
        told = dict(zip(self._asked, values, strict=True))
        past = {self._same(one): one for one in self.population}
        known = (one.value for one in self.population if one.phenotype is not None)
        self._worst = min([WORST_FITNESS, *values, *known])
        bred = [self._evaluated(one, told, past) for one in self._bred]
        elites, noise = self._elites(), 0.0
        if self.settings.reevaluate_elites:
            noise = noise_of(elites, [told[self._same(one)] for one in elites])
            elites = list(self.population)
        elites = [self._evaluated(one, told, past) for one in elites]
        self.population = self._survivors(elites, bred, noise)
        self.offspring = tuple(bred)
        self.generation += 1
        self.withdraw()
        self._injected = []
        self.best = self._champion()
        return self._record(bred, self.best, seconds)

    def withdraw(self) -> None:
        """Forget the individuals that were asked but not told, if any."""
        self._bred = None
        self._asked = {}

    def inject(self, sentence: str) -> Individual:
        """Add an individual to the next generation, from its phenotype.

        It is evaluated with that generation and enters the population in place of the worst.

        Raises:
            CallOrderError: Individuals are asked and not told.
            NotASentenceError: The grammar does not derive the sentence.
        """
        self._require_between_generations("inject")
        key = self.settings.population + len(self._injected)
        rng = np.random.default_rng((self.seed, self.generation + 1, int(Purpose.INJECTION), key))
        individual = self._individual(key, Child(genome_of(self.grammar, sentence, rng)))
        self._injected.append(individual)
        return individual

    def steer(self, **changes: float) -> None:
        """Change settings from the next generation on: `crossover`, `mutation`, `tournament` ...

        Raises:
            CallOrderError: Individuals are asked and not told.
            SettingsError: A setting cannot be changed any more, or not to this value.
        """
        self._require_between_generations("steer")
        self.settings = self.settings.steered(**changes)

    def state(self) -> State:
        """Everything that `restore` needs besides the parameters, in JSON types.

        Individuals that were asked or injected but not told are not part of it.
        """
        return {
            "generation": self.generation,
            "settings": self.settings.steerable,
            "population": [to_json(one) for one in self.population],
            "best": None if self.best is None else to_json(self.best),
        }

    @classmethod
    def restore(
        cls,
        grammar: Grammar,
        settings: Settings | None,
        seed: int,
        state: Mapping[str, Any],
        identity: Identity | None = None,
    ) -> Engine:
        """An engine that continues exactly where `state` was taken.

        Raises:
            CheckpointError: The state is damaged, or was made with another grammar.
        """
        engine = cls(grammar, settings, seed, identity)
        try:
            engine.generation = int(state["generation"])
            engine.settings = engine.settings.steered(**state["settings"])
            engine.population = tuple(from_json(one) for one in state["population"])
            best = state["best"]
            engine.best = None if best is None else from_json(best)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise CheckpointError(
                "checkpoint: expected generation, settings, population and best as state() gives "
                f"them, got {type(error).__name__}: {error}"
            ) from error
        size = engine.settings.population if engine.generation else 0
        champions = () if engine.best is None else (engine.best,)
        if len(engine.population) != size or len(champions) != bool(size):
            raise CheckpointError(
                f"checkpoint: expected {size} individuals, the best among them, "
                f"got {len(engine.population)}"
            )
        for one in (*engine.population, *champions):
            if engine._mapper.map(one.genome, engine.settings.max_wraps) != (
                one.phenotype,
                one.used,
            ):
                raise CheckpointError(
                    "checkpoint: its genomes do not map to the recorded sentences, expected the "
                    f"grammar and vocabulary of the run, got {grammar.source}"
                )
        return engine

    def _random(self, purpose: Purpose) -> np.random.Generator:
        key = (self.seed, self.generation + 1, int(purpose))
        return np.random.default_rng(np.random.SeedSequence(key))

    def _require_between_generations(self, what: str) -> None:
        if self._bred is not None:
            raise CallOrderError(f"{what}() after ask(): expected tell() or withdraw() first")

    def _individual(self, key: int, child: Child) -> Individual:
        phenotype, used = self._mapper.map(child.genome, self.settings.max_wraps)
        parents = tuple(dict.fromkeys(self.population[at].birth for at in child.parents))
        return Individual(self.generation + 1, key, child.genome, phenotype, used, parents)

    def _novelty(self) -> Callable[[Genome], bool]:
        """Tells whether a genome behaves unlike the population and unlike those told before."""
        known = {self._identity(one.phenotype) for one in self.population if one.phenotype}

        def is_new(genome: Genome) -> bool:
            phenotype = self._mapper.map(genome, self.settings.max_wraps).phenotype
            if phenotype is None:
                return False
            before = len(known)
            known.add(self._identity(phenotype))
            return len(known) > before

        return is_new

    def _same(self, individual: Individual) -> Hashable:
        """Equal for individuals that have one fitness together."""
        if self.settings.share_evaluations and individual.phenotype is not None:
            return self._identity(individual.phenotype)
        return individual.birth

    def _elites(self) -> list[Individual]:
        """Those that survive the coming generation, or are evaluated again, best first."""
        if self.settings.reevaluate_elites:
            valid = [one for one in self.population if one.phenotype is not None]
            return valid[: self.settings.elites]
        everyone = ranked(self.population, 0.0, self.settings.parsimony)
        return self._distinct(everyone)[: self.settings.elites]

    def _distinct(self, individuals: Iterable[Individual]) -> list[Individual]:
        """The first of those that are the same before the others, both in their order."""
        firsts: dict[Hashable, Individual] = {}
        others = []
        for one in individuals:
            if firsts.setdefault(self._same(one), one) is not one:
                others.append(one)
        return [*firsts.values(), *others]

    def _survivors(
        self, elites: list[Individual], bred: list[Individual], noise: float
    ) -> tuple[Individual, ...]:
        """The best of elites and offspring, and the injected whatever they are worth."""
        chosen = self._distinct(ranked([*elites, *bred], noise, self.settings.parsimony))
        size, now = self.settings.population, self.generation + 1
        injected = [one for one in chosen[size:] if one.key >= size and one.generation == now]
        return (*chosen[: size - len(injected)], *injected)

    def _evaluated(
        self,
        individual: Individual,
        told: Mapping[Hashable, float],
        past: Mapping[Hashable, Individual],
    ) -> Individual:
        """With the mean of what is known of it and of those that are the same."""
        if individual.phenotype is None:
            return replace(individual, fitness=self._worst, told=1)
        same = self._same(individual)
        before = past.get(same)
        if before is None:
            return replace(individual, fitness=told[same], told=1)
        if same not in told:
            return replace(individual, fitness=before.fitness, told=before.told)
        total = before.value * before.told + told[same]
        return replace(individual, fitness=total / (before.told + 1), told=before.told + 1)

    def _champion(self) -> Individual:
        if self.settings.reevaluate_elites:  # the first in the ranking of those known best
            return max(self.population, key=lambda one: min(one.told, TRUSTED))
        first = max(self.population, key=lambda one: one.value)
        return first if self.best is None or first.value > self.best.value else self.best

    def _record(self, bred: list[Individual], best: Individual, seconds: float) -> GenerationRecord:
        fitness = [one.value for one in bred]
        return GenerationRecord(
            generation=self.generation,
            best_so_far=best.value,
            best=max(fitness),
            mean=math.fsum(fitness) / len(fitness),
            invalid=sum(one.phenotype is None for one in bred),
            distinct=len({one.phenotype for one in bred} - {None}),
            seconds=seconds,
        )


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
        if not math.isfinite(number):
            raise FitnessError(
                f"fitness of individual {one.key}: expected a finite number, got {value!r}"
            )
        values.append(number)
    return values
