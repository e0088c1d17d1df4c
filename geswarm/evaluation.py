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

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from geswarm.sim import Controller, Objective, Scenario, Simulation, Stop, evaluate

_RUNS_PER_CALL = 128  # between two reports of progress; fills the SIMD lanes of two threads


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One rule set in one scenario, run after run.

    Attributes:
        objective: What was to be maximised or minimised.
        fitness: Its values, float64, shape (runs,); run i has the same random streams for every
            rule set.
        measures: What was counted, by name, the same shape.
    """

    objective: Objective
    fitness: npt.NDArray[np.float64]
    measures: Mapping[str, npt.NDArray[np.float64]]

    @property
    def mean(self) -> float:
        """Mean of the objective."""
        return float(self.fitness.mean())

    @property
    def gains(self) -> npt.NDArray[np.float64]:
        """The fitness of each run such that more is better, for comparisons."""
        return self.objective.gain(self.fitness)

    def figures(self) -> dict[str, float]:
        """What tables show; sd is the sample standard deviation, `lost_mean` a foraging swarm's."""
        figures = {
            "mean": self.mean,
            "sd": float(self.fitness.std(ddof=1)) if self.fitness.size > 1 else 0.0,
            "median": float(np.median(self.fitness)),
        }
        lost = {"lost_mean": float(self.measures["lost"].mean())} if "lost" in self.measures else {}
        return figures | lost

    def summary(self) -> dict[str, Any]:
        """The runs and their figures, as JSON values."""
        collected = self.measures.get("collected")
        return {
            "objective": self.objective.document(),
            "fitness": self.fitness.tolist(),
            "measures": {name: values.tolist() for name, values in self.measures.items()},
            **({} if collected is None else {"collected": collected.astype(int).tolist()}),
            **self.figures(),
        }

    def _repr_html_(self) -> str:
        """How notebooks show it: a table of its figures."""
        figures = {"runs": float(self.fitness.size), **self.figures()}
        heads = "".join(f"<th>{name.replace('_', ', ')}</th>" for name in figures)
        cells = "".join(f"<td>{value:.5g}</td>" for value in figures.values())
        return f"<table><tr>{heads}</tr><tr>{cells}</tr></table>"


def shown(value: float) -> str:
    """A figure as tables show it: one decimal, or three digits if it is small."""
    return f"{value:.1f}" if abs(value) >= 10.0 or value == 0.0 else f"{value:.3g}"


def evaluate_rule_sets(
    rule_sets: Sequence[Controller],
    scenario: Scenario,
    runs: int = 50,
    seed: int = 0,
    workers: int | None = None,
    stop: Stop | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> list[Evaluation]:
    """Run every rule set `runs` times; the result does not depend on the number of workers.

    Args:
        rule_sets: What to evaluate; state machines of AutoMoDe, too.
        scenario: Where.
        runs: Simulations of each.
        seed: Keys the random streams, together with the number of the run.
        workers: Threads; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        on_progress: Called with (simulations done, simulations in all).

    Raises:
        EvaluationStopped: `stop` returned True.
    """
    total, found = len(rule_sets) * runs, []
    for first in range(0, total, _RUNS_PER_CALL):
        part = [
            Simulation(table=at // runs, seed=seed, replicate=at % runs)
            for at in range(first, min(first + _RUNS_PER_CALL, total))
        ]
        result = evaluate(rule_sets, scenario, part, workers=workers, stop=stop)
        found.append(np.stack([result.fitness, *result.measures.values()]))
        if on_progress:
            on_progress(first + len(part), total)
    names = tuple(result.measures)
    values = np.concatenate(found, axis=1).reshape(-1, len(rule_sets), runs)
    return [
        Evaluation(scenario.objective, values[0, at], dict(zip(names, values[1:, at], strict=True)))
        for at in range(len(rule_sets))
    ]
