"""What runs mean: statistics over samples of fitness, and what made the difference.

Figures are plotly figures, which notebooks show by themselves:

>>> from geswarm.analysis.cases import Case, run_cases
>>> from geswarm.analysis.figures import box_plots
>>> from geswarm.rules import load_preset
>>> from geswarm.sim import load_scenario
>>> rule_sets = {"EVO 8": load_preset("evo8"), "hand-coded": load_preset("hand-coded")}
>>> short = load_scenario("paper").with_changes(duration=100.0)
>>> samples = run_cases([Case(name, short) for name in rule_sets], rule_sets, runs=20, seed=1)
>>> figure = box_plots(samples)
>>> [box.name for box in figure.data]
['EVO 8', 'hand-coded']
>>> figure._repr_html_().lstrip().startswith("<div")
True

`geswarm.analysis.page` makes self-contained pages of them.
"""

from geswarm.analysis.ablation import Piece, Worth, pieces, without, worth_of_pieces
from geswarm.analysis.statistics import (
    Comparison,
    PairedDifference,
    compare,
    holm,
    paired_difference,
)

__all__ = [
    "Comparison",
    "PairedDifference",
    "Piece",
    "Worth",
    "compare",
    "holm",
    "paired_difference",
    "pieces",
    "without",
    "worth_of_pieces",
]
