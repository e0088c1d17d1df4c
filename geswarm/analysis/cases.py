"""Rule sets in scenarios: run each combination, and compare what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geswarm.analysis.statistics import Comparison, compare, holm
from geswarm.automode import Runnable
from geswarm.evaluation import Evaluation, evaluate_rule_sets
from geswarm.sim import Scenario


@dataclass(frozen=True)
class Case:
    """A rule set in a scenario.

    Attributes:
        rules: What the rule set is called.
        scenario: Where it runs.
    """

    rules: str
    scenario: Scenario


Samples: TypeAlias = dict[Case, Evaluation]
"""What came of each case, run by run."""


@dataclass(frozen=True)
class Contrast:
    """Two cases compared, as one of a family of comparisons.

    Attributes:
        a: The first case.
        b: What it is compared with.
        comparison: Mann-Whitney test and effect size, a against b.
        p_holm: The p-value corrected for the size of the family.
    """

    a: Case
    b: Case
    comparison: Comparison
    p_holm: float


def run_cases(
    cases: Iterable[Case],
    rule_sets: Mapping[str, Runnable],
    runs: int,
    seed: int,
    workers: int | None = None,
    stop: Callable[[], bool] | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> Samples:
    """Run every case, scenario after scenario; run i has the same random streams in all of them.

    Args:
        cases: What to run.
        rule_sets: Rule sets, or machines of AutoMoDe, by the names that the cases use.
        runs: Simulations of each case.
        seed: Keys the random streams, together with the number of the run.
        workers: Threads; None for one per core.
        stop: Asked now and then; True ends the evaluation.
        on_progress: Called with (work done, work in all), in simulations times robots.

    Raises:
        EvaluationStopped: `stop` returned True.
    """
    cases = list(cases)
    total = runs * sum(case.scenario.robots for case in cases)
    by_scenario: dict[Scenario, list[Case]] = {}
    for case in cases:
        by_scenario.setdefault(case.scenario, []).append(case)
    samples: Samples = {}
    finished = 0
    for scenario, here in by_scenario.items():
        swarms = [rule_sets[case.rules] for case in here]
        robots = scenario.robots

        def report(done: int, _: int, before: int = finished, robots: int = robots) -> None:
            if on_progress:
                on_progress(before + done * robots, total)

        found = evaluate_rule_sets(swarms, scenario, runs, seed, workers, stop, report)
        samples.update(zip(here, found, strict=True))
        finished += runs * len(here) * robots
    return {case: samples[case] for case in cases}


def contrasts(samples: Samples, pairs: Sequence[tuple[Case, Case]]) -> list[Contrast]:
    """Compare the cases of each pair; all pairs together are the family that is corrected for."""
    found = [compare(samples[a].gains, samples[b].gains) for a, b in pairs]
    corrected = holm([comparison.p_value for comparison in found])
    return [
        Contrast(a, b, comparison, p_holm)
        for (a, b), comparison, p_holm in zip(pairs, found, corrected, strict=True)
    ]
