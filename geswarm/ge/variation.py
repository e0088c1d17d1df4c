"""Breeding: who becomes a parent, and what the children's genomes are.

Random numbers are keyed by (seed, generation, purpose), so that a restored engine breeds the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import NamedTuple, TypeAlias

import numpy as np

from geswarm.ge.derivation import DerivationTrees, exact
from geswarm.ge.individual import Individual
from geswarm.ge.mapping import Genome, Mapper
from geswarm.ge.operators import (
    above_the_least,
    mutate,
    random_genome,
    roulette,
    single_point_crossover,
    tournament,
)
from geswarm.ge.settings import Settings

_INITIAL_DEPTHS = (4, 12)  # nested choices of the shallowest and the deepest initial individual
_MOST_CHANGES = 20  # local ones, to a child
_ATTEMPTS = 20  # to make an individual that is new


class Purpose(IntEnum):
    """What random numbers are for; part of their key."""

    INITIALISATION = 0
    SELECTION = 1
    CROSSOVER = 2
    MUTATION = 3
    INJECTION = 4


IsNew: TypeAlias = Callable[[Genome], bool]
"""Whether a genome behaves unlike all that are known; remembers the genome."""

Random: TypeAlias = Callable[[Purpose], np.random.Generator]
"""The generator of a purpose in the generation that is bred."""


class Child(NamedTuple):
    """A genome and whose it was, as indices into the population."""

    genome: Genome
    parents: tuple[int, ...] = ()


def initial(
    mapper: Mapper, trees: DerivationTrees, settings: Settings, random: Random, is_new: IsNew
) -> list[Child]:
    """The genomes of the first generation."""
    rng = random(Purpose.INITIALISATION)
    longest = settings.max_codons
    if settings.initialisation == "random":
        return [Child(random_genome(mapper, longest, rng)) for _ in range(settings.population)]
    children = []
    for depth in np.linspace(*_INITIAL_DEPTHS, settings.population).round():
        for _ in range(_ATTEMPTS):
            genome = trees.grow_to(int(depth), rng)
            if len(genome) <= longest and is_new(genome):
                break
        else:
            genome = random_genome(mapper, longest, rng)
        children.append(Child(genome))
    return children


def breed(
    population: Sequence[Individual],
    trees: DerivationTrees,
    settings: Settings,
    random: Random,
    is_new: IsNew,
) -> list[Child]:
    """Select parents and vary them: `settings.population` children."""
    if settings.variation == "derivation":
        return _on_derivations(population, trees, settings, random, is_new)
    return _on_codons(population, settings, random)


def _select(
    population: Sequence[Individual], count: int, settings: Settings, rng: np.random.Generator
) -> list[int]:
    """Indices of parents; a population is in the order of its ranking."""
    if settings.selection == "roulette":
        shares = above_the_least([one.value for one in population]).tolist()
        best = max(shares) or 1.0
        if settings.scaling != 1.0:
            shares = [(share / best) ** settings.scaling for share in shares]
        return roulette(shares, count, rng)
    return tournament(len(population), count, settings.tournament, rng)


def _on_codons(population: Sequence[Individual], settings: Settings, random: Random) -> list[Child]:
    """Crossover of neighbouring pairs, then mutation (GEVA 2.0)."""
    size = settings.population
    chosen = _select(population, size + size % 2, settings, random(Purpose.SELECTION))
    children = [Child(population[index].genome, (index,)) for index in chosen]
    rng = random(Purpose.CROSSOVER)
    for at in range(0, len(children), 2):
        if rng.random() < settings.crossover:
            first, second = children[at : at + 2]
            one, other = single_point_crossover(
                first.genome, second.genome, settings.max_codons, rng
            )
            children[at] = Child(one, first.parents + second.parents)
            children[at + 1] = Child(other, second.parents + first.parents)
    rng = random(Purpose.MUTATION)
    return [
        Child(mutate(child.genome, settings.mutation, rng), child.parents)
        for child in children[:size]
    ]


def _on_derivations(
    population: Sequence[Individual],
    trees: DerivationTrees,
    settings: Settings,
    random: Random,
    is_new: IsNew,
) -> list[Child]:
    """Sub-derivation crossover and local changes, until the child is new."""
    valid = [at for at, one in enumerate(population) if one.phenotype is not None]
    parents = [population[at] for at in valid]
    genomes = [exact(one.genome, one.used) or one.genome for one in parents]
    size = settings.population
    mothers, fathers = np.reshape(
        _select(parents, 2 * size, settings, random(Purpose.SELECTION)), (2, size)
    ).tolist()
    crossing, mutating = random(Purpose.CROSSOVER), random(Purpose.MUTATION)
    children = []
    for mother, father in zip(mothers, fathers, strict=True):
        genome, family = genomes[mother], [mother]
        if crossing.random() < settings.crossover:
            genome = trees.swap(genome, genomes[father], settings.max_codons, crossing)
            family.append(father)
        for _ in range(_MOST_CHANGES):
            if mutating.random() >= settings.mutation:
                break
            genome = trees.edit(genome, settings.max_codons, mutating)
        for _ in range(_ATTEMPTS):
            if is_new(genome):
                break
            genome = trees.edit(genome, settings.max_codons, mutating)
        children.append(Child(genome, tuple(valid[at] for at in family)))
    return children
