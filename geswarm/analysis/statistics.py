"""Comparing two samples of runs, as the paper does (section 3.2): rank tests at p < 0.001."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats


@dataclass(frozen=True)
class Comparison:
    """Two-sided Mann-Whitney test of sample a against sample b.

    Attributes:
        p_value: Probability of ranks at least this different if a and b were the same.
        effect: Probability that a run of a beats a run of b; ties count half.
    """

    p_value: float
    effect: float


def compare(a: ArrayLike, b: ArrayLike) -> Comparison:
    """Compare two samples of collected objects.

    Raises:
        ValueError: A sample is empty.
    """
    first, second = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if not first.size or not second.size:
        raise ValueError(f"expected two samples, got {first.size} and {second.size} values")
    result = stats.mannwhitneyu(first, second, alternative="two-sided")
    p_value = float(result.pvalue)
    return Comparison(
        p_value=1.0 if np.isnan(p_value) else p_value,
        effect=float(result.statistic) / (first.size * second.size),
    )
