"""What a campaign found, and its files: one table of runs per experiment."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm.analysis.cases import Case, Samples
from geswarm.analysis.reproduction.plan import Plan
from geswarm.evaluation import Evaluation
from geswarm.ge import GenerationRecord
from geswarm.rules import RuleSet
from geswarm.sim import load_scenario


@dataclass(frozen=True)
class Results:
    """Everything that the claims are held to.

    Attributes:
        plan: What was asked for.
        histories: Of the evolutionary runs, by the name of the rule set that each ended with.
        rule_sets: The paper's and the evolved ones, by name.
        performance: All rule sets in the scenario of the evolution (Figure 2b).
        scalability: More robots at the same density (Figure 3a).
        flexibility: More robots at four times the density, with half the objects (Figure 3b).
        sensitivity: EVO 8 and hand-coded over `zone_miss`.
        agreement: The same cases as in ARGoS 3.
    """

    plan: Plan
    histories: dict[str, list[GenerationRecord]]
    rule_sets: dict[str, RuleSet]
    performance: Samples
    scalability: Samples
    flexibility: Samples
    sensitivity: Samples
    agreement: Samples

    @property
    def evolved(self) -> list[str]:
        """Names of the evolved rule sets, in the order of their seeds."""
        return list(self.histories)

    @property
    def by_rules(self) -> dict[str, Evaluation]:
        """What each rule set collected where they evolved, by its name."""
        return {case.rules: evaluation for case, evaluation in self.performance.items()}

    @property
    def best(self) -> str:
        """Name of the best evolved rule set."""
        return best_of(self.performance, self.evolved)


def best_of(samples: Samples, evolved: Sequence[str]) -> str:
    """The rule set with the highest mean; of equals the first."""
    means = {case.rules: evaluation.mean for case, evaluation in samples.items()}
    return max(evolved, key=lambda name: means[name])


_COUNTED = ("collected", "lost")
_COLUMNS = ("rules", "scenario", "robots", "zone_miss", "run", *_COUNTED)


def foraged(collected: npt.ArrayLike, lost: npt.ArrayLike) -> Evaluation:
    """What robots that forage brought home and lost, run by run."""
    counts = (np.asarray(values, dtype=np.float64) for values in (collected, lost))
    measures = dict(zip(_COUNTED, counts, strict=True))
    return Evaluation(load_scenario("paper").objective, measures["collected"], measures)


def format_samples(samples: Samples) -> str:
    """One line per run, as CSV."""
    rows = [
        (case.rules, scenario.name, scenario.robots, f"{scenario.zone_miss:g}", run, *counts)
        for case, evaluation in samples.items()
        for scenario in [case.scenario]
        for run, counts in enumerate(
            zip(*(evaluation.measures[name].astype(int) for name in _COUNTED), strict=True)
        )
    ]
    return format_csv(_COLUMNS, rows)


def parse_samples(text: str, cases: Sequence[Case], runs: int) -> Samples:
    """Read what `format_samples` wrote.

    Args:
        text: The CSV.
        cases: Those that it must have, in this order.
        runs: So many of each.

    Raises:
        ValueError: It is something else.
    """
    counts = [line.rsplit(",", 2)[1:] for line in text.splitlines()[1:]]
    numbers = np.array(counts, dtype=np.int64).reshape(len(cases), runs, 2)
    samples = {
        case: foraged(of_case[:, 0], of_case[:, 1])
        for case, of_case in zip(cases, numbers, strict=True)
    }
    if format_samples(samples) != text:
        raise ValueError("expected other cases")
    return samples


def format_histories(histories: dict[str, list[GenerationRecord]]) -> str:
    """One line per run and generation, as CSV; without the time that it took."""
    header = GenerationRecord.csv_header().split(",")[:-1]
    rows = [
        (name, *record.csv_row().split(",")[:-1])
        for name, records in histories.items()
        for record in records
    ]
    return format_csv(("rules", *header), rows)


def format_csv(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
