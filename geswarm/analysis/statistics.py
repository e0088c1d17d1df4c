"""Comparing two samples of runs by their ranks.

Significant is p < 0.001, as in the paper (section 3.2), which does not name its test.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

SIGNIFICANCE = 0.001
"""A difference with a lower p-value is one (paper, section 3.2)."""


@dataclass(frozen=True)
class Comparison:
    """Two-sided Mann-Whitney test of sample a against sample b.

    Attributes:
        p_value: Probability of ranks at least this different if a and b were the same.
        effect: Probability that a run of a beats a run of b; ties count half (Vargha and
            Delaney's A).
    """

    p_value: float
    effect: float

    @property
    def winner(self) -> int:
        """1 if a is significantly better, -1 if b is, 0 if there is no telling."""
        if self.p_value >= SIGNIFICANCE:
            return 0
        return 1 if self.effect > 0.5 else -1


@dataclass(frozen=True)
class PairedDifference:
    """Mean of a minus mean of b over paired runs.

    Attributes:
        difference: Of the means.
        low: Lower end of its 95 % interval (Student's t).
        high: Upper end.
        p_value: Two-sided paired t-test: below 0.05 exactly if the interval excludes 0.
    """

    difference: float
    low: float
    high: float
    p_value: float


def paired_difference(a: ArrayLike, b: ArrayLike) -> PairedDifference:
    """Compare two samples whose runs had the same random streams.

    Raises:
        ValueError: They are not of the same length, or have fewer than two runs.
    """
    first, second = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if first.shape != second.shape or first.size < 2:
        raise ValueError(
            f"expected two samples of equal length >= 2, got {first.size} and {second.size} values"
        )
    differences = first - second
    mean = float(differences.mean())
    error = float(differences.std(ddof=1)) / first.size**0.5
    reach = float(stats.t.ppf(0.975, first.size - 1)) * error
    if error > 0:
        p_value = 2.0 * float(stats.t.sf(abs(mean) / error, first.size - 1))
    else:
        p_value = 0.0 if mean else 1.0
    return PairedDifference(mean, mean - reach, mean + reach, p_value)


def compare(a: ArrayLike, b: ArrayLike) -> Comparison:
    """Compare two samples in which more is better.

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


def holm(p_values: Sequence[float]) -> list[float]:
    """Correct the p-values of a family of tests by Holm's step-down procedure (1979).

    The chance that any of the family falls below a level by luck alone is at most that level.

    Returns:
        The corrected p-values, in the order given.
    """
    corrected = [1.0] * len(p_values)
    largest = 0.0
    for rank, at in enumerate(sorted(range(len(p_values)), key=lambda at: p_values[at])):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p_values[at]))
        corrected[at] = largest
    return corrected
