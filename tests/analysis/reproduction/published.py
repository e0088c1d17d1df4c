"""The published campaign (static/reproduction), read back from its tables.

    python -m tests.analysis.reproduction.published DIRECTORY

writes what is made of them: the report, and the tables of claims, comparisons and scaling.
"""

import csv
import sys
from pathlib import Path

from geswarm.analysis.reproduction import Plan, Results, studies
from geswarm.analysis.reproduction.report import files_of
from geswarm.analysis.reproduction.results import best_of, parse_samples
from geswarm.ge import GenerationRecord
from geswarm.rules import load_preset, read_rule_set

PLACE = Path(__file__).parents[3] / "static" / "reproduction"


def text_of(name):
    """The content of a published file."""
    return (PLACE / name).read_text(encoding="utf-8")


def rows_of(text):
    """The lines of a table as dicts."""
    return list(csv.DictReader(text.splitlines()))


def evolved_rules(name):
    """The best rules of a run."""
    return read_rule_set(text_of(f"rules/{name.replace(' ', '-')}.yaml"))


def published():
    """What the campaign found."""
    plan = Plan.from_yaml(text_of("campaign.yaml"))
    histories = {studies.evolved_name(seed): [] for seed in plan.seeds}
    for row in rows_of(text_of("history.csv")):
        figures = [float(row[name]) for name in ("best_so_far", "best", "mean")]
        counts = [int(row[name]) for name in ("generation", "invalid", "distinct")]
        record = GenerationRecord(counts[0], *figures, *counts[1:], seconds=0.0)
        histories[row["rules"]].append(record)

    def samples(name, cases):
        return parse_samples(text_of(f"{name}.csv"), cases, plan.evaluations)

    performance = samples("performance", studies.performance(list(histories)))
    best = best_of(performance, list(histories))
    return Results(
        plan,
        histories,
        {
            **{name: evolved_rules(name) for name in histories},
            studies.EVO_8: load_preset("evo8"),
            studies.HAND_CODED: load_preset("hand-coded"),
        },
        performance,
        **{name: samples(name, cases) for name, cases in studies.others(best).items()},
    )


def main(directory):
    """Write it, as the directory of a campaign."""
    files = {"campaign.yaml": text_of("campaign.yaml"), **files_of(published())}
    for name, text in files.items():
        path = Path(directory) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
