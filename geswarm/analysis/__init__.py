"""What runs mean: statistics over samples of collected objects."""

from geswarm.analysis.statistics import Comparison, PairedDifference, compare, paired_difference

__all__ = ["Comparison", "PairedDifference", "compare", "paired_difference"]
