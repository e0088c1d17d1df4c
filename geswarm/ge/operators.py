"""Genetic operators on strings of codons, as in GEVA 2.0 (the library that the paper used).

Every operator takes the random generator that it draws from; equal generators give equal results.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from geswarm.ge.mapping import CODON_LIMIT, Genome, Mapper

INITIAL_CODONS = 200
"""Length of an initial genome whose derivation needs no more: GEVA's random initialiser's."""

_DERIVATION_ATTEMPTS = 1000


def random_genome(mapper: Mapper, max_codons: int, rng: np.random.Generator) -> Genome:
    """A random derivation from the start symbol, as its codons and an unused tail.

    Productions are chosen at random until a sentence is complete (paper, section 2.2); a codon
    drawn uniformly chooses uniformly. A derivation that needs more than `max_codons` choices is
    redrawn. The genome has `INITIAL_CODONS` codons at least: without the tail, which crossover and
    mutation draw on, populations get stuck with a dozen codons that are read again and again.

    Raises:
        ValueError: Random derivations of this grammar practically never end.
    """
    for _ in range(_DERIVATION_ATTEMPTS):
        codons = tuple(rng.integers(CODON_LIMIT, size=max_codons).tolist())
        derivation = mapper.map(codons, max_wraps=0)
        if derivation.phenotype is not None:
            return codons[: max(derivation.used, INITIAL_CODONS)]
    raise ValueError(
        f"{mapper.grammar.source}: none of {_DERIVATION_ATTEMPTS} random derivations ended within "
        f"{max_codons} choices, expected a grammar whose recursion ends more often than it grows "
        "(or a larger max_codons)"
    )


def single_point_crossover(
    first: Genome, second: Genome, max_codons: int, rng: np.random.Generator
) -> tuple[Genome, Genome]:
    """Exchange the tails behind one random point per parent.

    The points are drawn over the whole chromosomes, unused codons included (GEVA's defaults); no
    child is empty. A child that would be longer than `max_codons` is cut off there.
    """
    cut = int(rng.integers(len(first)))
    other_cut = int(rng.integers(len(second)))
    return (
        (first[:cut] + second[other_cut:])[:max_codons],
        (second[:other_cut] + first[cut:])[:max_codons],
    )


def mutate(genome: Genome, rate: float, rng: np.random.Generator) -> Genome:
    """Redraw every codon with probability `rate`, uniformly, over the whole chromosome."""
    codons = np.array(genome, dtype=np.int64)
    hit = rng.random(codons.size) < rate
    codons[hit] = rng.integers(CODON_LIMIT, size=int(hit.sum()))
    return tuple(codons.tolist())


def above_the_least(fitness: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Shares of a wheel: fitness, or half of what it is above the least if that is negative."""
    values = np.asarray(fitness, dtype=np.float64)
    least = values.min()
    return values if least >= 0 else values / 2 - least / 2  # halves: the whole may be too large


def roulette(fitness: Sequence[float], count: int, rng: np.random.Generator) -> list[int]:
    """Draw `count` indices with replacement, proportionally to fitness.

    If some are negative, to what they are above the least. If all come to 0 then, all are equally
    likely.

    Raises:
        ValueError: A fitness is not finite, or there is none.
    """
    shares = np.asarray(fitness, dtype=np.float64)
    if shares.ndim != 1 or not shares.size:
        raise ValueError(f"fitness: expected at least one value, got shape {shares.shape}")
    if not np.isfinite(shares).all():
        at = int(np.flatnonzero(~np.isfinite(shares))[0])
        raise ValueError(f"fitness[{at}]: expected a finite number, got {shares[at]}")
    shares = above_the_least(shares)
    if not shares.any():
        return [int(index) for index in rng.integers(shares.size, size=count)]
    wheel = np.cumsum(shares / shares.max())
    spins = rng.random(count) * wheel[-1]
    # The last slot with a share catches a spin that rounding puts on the wheel's very end.
    drawn = np.minimum(np.searchsorted(wheel, spins, side="right"), np.flatnonzero(shares)[-1])
    return [int(index) for index in drawn]


def tournament(size: int, count: int, contenders: int, rng: np.random.Generator) -> list[int]:
    """Draw `count` places of a ranking: each the best of `contenders` drawn with replacement.

    Args:
        size: Length of the ranking; place 0 is the best.
        count: How many to draw.
        contenders: Per tournament; 1 is no selection.
        rng: Where the contenders come from.
    """
    return [int(at) for at in rng.integers(size, size=(count, contenders)).min(axis=1)]
