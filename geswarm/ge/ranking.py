"""Who is better than whom, also where evaluations are noisy.

The best-looking of many individuals that were evaluated once owes most of that to luck. Where
individuals are evaluated again, a mean therefore counts less its standard error: the lower bound of
what can be believed (Rakshit et al. 2017). How noisy an evaluation is follows from the evaluations
themselves; where they always come out the same, there is no doubt.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from geswarm.ge.individual import Individual

CODON_COST = 0.0002
"""Share of its fitness that each codon costs an individual in the ranking, under parsimony."""


def noise_of(before: Sequence[Individual], values: Sequence[float]) -> float:
    """Standard deviation of an evaluation; 0 if there is nothing to tell it from.

    Args:
        before: Individuals with a fitness.
        values: What each was worth when it was evaluated once more.
    """
    if not before:
        return 0.0
    told = np.array([one.told for one in before])
    means = np.array([one.value for one in before])
    # A value and a mean of n others differ by the variances of both: 1 + 1/n of a value's. The
    # means of few were selected for their luck, so those of many count for more.
    squares = (np.array(values) - means) ** 2 * told / (told + 1)
    return float(np.sqrt(np.average(squares, weights=told)))


def ranked(individuals: Sequence[Individual], noise: float, parsimony: bool) -> list[Individual]:
    """Best first; equals in their order, or under parsimony the smaller first.

    Args:
        individuals: All with a fitness.
        noise: Standard deviation of an evaluation.
        parsimony: Codons cost `CODON_COST` each (Luke and Panait 2002: parametric pressure).
    """

    def key(one: Individual) -> tuple[float, int]:
        size = one.used if parsimony else 0
        cost = 1 + CODON_COST * size
        worth = one.value / cost if one.value > 0 else one.value * cost
        return noise / math.sqrt(one.told) - worth, size

    return sorted(individuals, key=key)
