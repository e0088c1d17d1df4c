"""Running rule sets many times in a scenario.

>>> from geswarm.evaluation import evaluate_rule_sets
>>> from geswarm.rules import load_rule_set
>>> from geswarm.sim import load_scenario
>>> short = load_scenario("paper").with_changes(duration=500.0)
>>> evo8, hand_coded = map(load_rule_set, ("evo8", "hand-coded"))
>>> first, second = evaluate_rule_sets([evo8, hand_coded], short, runs=20, seed=0)
>>> first.mean > second.mean
True
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from geswarm.rules import RuleSet
from geswarm.sim import Scenario, Simulation, Stop, evaluate

_RUNS_PER_CALL = 128  # between two reports of progress; fills the SIMD lanes of two threads


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One rule set in one scenario, run after run.

    Attributes:
        collected: Objects dropped in the nest, int64, shape (runs,); run i has the same random
            streams for every rule set.
        lost: Objects dropped elsewhere, the same shape.
    """

    collected: npt.NDArray[np.int64]
    lost: npt.NDArray[np.int64]

    @property
    def mean(self) -> float:
        """Mean of the collected objects."""
        return float(self.collected.mean())

    def summary(self) -> dict[str, Any]:
        """The runs and their figures, as JSON values; sd is the sample standard deviation."""
        return {
            "collected": self.collected.tolist(),
            "mean": self.mean,
            "sd": float(self.collected.std(ddof=1)) if self.collected.size > 1 else 0.0,
            "median": float(np.median(self.collected)),
            "lost_mean": float(self.lost.mean()),
        }

    def _repr_html_(self) -> str:
        """How notebooks show it: a table of its figures."""
        figures = {"runs": float(self.collected.size), **self.summary()}
        del figures["collected"]
        heads = "".join(f"<th>{name.replace('_', ', ')}</th>" for name in figures)
        cells = "".join(f"<td>{value:.5g}</td>" for value in figures.values())
        return f"<table><tr>{heads}</tr><tr>{cells}</tr></table>"


def evaluate_rule_sets(
    rule_sets: Sequence[RuleSet],
    scenario: Scenario,
    runs: int = 50,
    seed: int = 0,
    workers: int | None = None,
    stop: Stop | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> list[Evaluation]:
    """Run every rule set `runs` times; the result does not depend on the number of workers.

    Args:
        rule_sets: What to evaluate.
        scenario: Where.
        runs: Simulations of each.
        seed: Keys the random streams, together with the number of the run.
        workers: Threads; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        on_progress: Called with (simulations done, simulations in all).

    Raises:
        EvaluationStopped: `stop` returned True.
    """
    total, counts = len(rule_sets) * runs, []
    for first in range(0, total, _RUNS_PER_CALL):
        part = [
            Simulation(table=at // runs, seed=seed, replicate=at % runs)
            for at in range(first, min(first + _RUNS_PER_CALL, total))
        ]
        result = evaluate(rule_sets, scenario, part, workers=workers, stop=stop)
        counts.append(np.stack([result.collected, result.lost]))
        if on_progress:
            on_progress(first + len(part), total)
    collected, lost = np.concatenate(counts, axis=1).reshape(2, len(rule_sets), runs)
    return [Evaluation(*pair) for pair in zip(collected, lost, strict=True)]
