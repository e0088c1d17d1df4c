"""Does the swarm collect in proportion to its size (paper, section 3.2.2)?"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

from geswarm.analysis.cases import Samples
from geswarm.analysis.reproduction.studies import SWARM_SIZES

_Z = 1.96  # of a 95 % interval


@dataclass(frozen=True)
class Scaling:
    """Collected objects over swarm size: a straight line, and whether it is one.

    Attributes:
        slope: Objects per robot, by least squares over all runs.
        intercept: Objects.
        r2: Share of the variance that the line explains.
        gain: What a robot adds from 10 to 20 robots, relative to what one adds from 5 to 10: 1 on
            a straight line, less if robots hinder each other. NaN if more do not collect more.
        low: Lower end of its 95 % interval (delta method).
        high: Upper end.
    """

    slope: float
    intercept: float
    r2: float
    gain: float
    low: float
    high: float


def scaling(samples: Samples, rules: str) -> Scaling:
    """Fit what a rule set collected with 5, 10 and 20 robots."""
    found = {case.scenario.robots: samples[case] for case in samples if case.rules == rules}
    groups = [found[size].fitness for size in SWARM_SIZES]
    sizes = np.repeat(SWARM_SIZES, [group.size for group in groups])
    line = stats.linregress(sizes, np.concatenate(groups))
    intercept = round(line.intercept, 9)  # 0.75 may be a bit less with another version of SciPy
    return Scaling(line.slope, intercept, line.rvalue**2, *_gain(groups))


def _gain(groups: list[np.ndarray]) -> tuple[float, float, float]:
    small, middle, large = SWARM_SIZES
    means = [float(group.mean()) for group in groups]
    first = (means[1] - means[0]) / (middle - small)
    second = (means[2] - means[1]) / (large - middle)
    if first <= 0 or second <= 0:
        return math.nan, math.nan, math.nan
    gain = second / first
    derivatives = (
        gain / first / (middle - small),
        -1 / first / (large - middle) - gain / first / (middle - small),
        1 / first / (large - middle),
    )
    variances = [float(group.var(ddof=1)) / group.size for group in groups]
    reach = _Z * math.sqrt(sum(d**2 * v for d, v in zip(derivatives, variances, strict=True)))
    return gain, gain - reach, gain + reach
