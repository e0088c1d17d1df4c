"""What runs mean: statistics over samples of collected objects, and what made the difference."""

from geswarm.analysis.ablation import Piece, Worth, pieces, without, worth_of_pieces
from geswarm.analysis.statistics import Comparison, PairedDifference, compare, paired_difference

__all__ = [
    "Comparison",
    "PairedDifference",
    "Piece",
    "Worth",
    "compare",
    "paired_difference",
    "pieces",
    "without",
    "worth_of_pieces",
]
