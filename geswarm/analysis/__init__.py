"""What runs mean: statistics over samples of collected objects."""

from geswarm.analysis.statistics import Comparison, compare

__all__ = ["Comparison", "compare"]
