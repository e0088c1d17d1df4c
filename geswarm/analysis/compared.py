"""Any rule sets in any scenarios, each compared with one of them: figures, table, page, JSON."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

from geswarm.analysis.cases import Case, Contrast, Samples, contrasts
from geswarm.automode import Runnable, format_controller
from geswarm.evaluation import shown
from geswarm.rules import RuleSet

HEADINGS = ("scenario", "rules", "mean", "median", "sd", "p", "p (Holm)", "effect")
"""Of `Compared.rows`."""


@dataclass(frozen=True, eq=False)
class Compared:
    """What was run, what came of it, and how it compares.

    Attributes:
        rule_sets: By the names that the cases use.
        samples: What came of each case; every scenario has the same rule sets, or is still
            without that of the others.
        against: Name of the rule set that the others are compared with.
        runs: Simulations of each case.
        seed: Of their random streams.
    """

    rule_sets: Mapping[str, Runnable]
    samples: Samples
    against: str
    runs: int
    seed: int

    @cached_property
    def contrasts(self) -> dict[Case, Contrast]:
        """Each case of another rule set against the same scenario's case of `against`."""
        pairs = [(case, Case(self.against, case.scenario)) for case in self.samples]
        known = [(a, b) for a, b in pairs if a != b and b in self.samples]
        return {contrast.a: contrast for contrast in contrasts(self.samples, known)}

    @property
    def explanation(self) -> str:
        """What the last three columns of the table are; empty if nothing is compared."""
        if not self.contrasts:
            return ""
        return (
            f"p: two-sided Mann-Whitney against {self.against}, and corrected by Holm for all "
            f"comparisons of this table; effect: probability that a run is better than one of "
            f"{self.against} (ties count half)."
        )

    def rows(self) -> list[Sequence[str]]:
        """A line per case, under `HEADINGS`."""
        rows: list[Sequence[str]] = []
        for case, evaluation in self.samples.items():
            found = evaluation.figures()
            figures = [shown(found[key]) for key in ("mean", "median", "sd")]
            contrast = self.contrasts.get(case)
            if contrast is None:
                compared = ["", "", ""]
            else:
                comparison = contrast.comparison
                compared = [f"{comparison.p_value:#.2g}", f"{contrast.p_holm:#.2g}"]
                compared.append(f"{comparison.effect:.2f}")
            rows.append([case.scenario.name, case.rules, *figures, *compared])
        return rows

    def document(self) -> dict[str, Any]:
        """All of it as JSON values: every run, and the figures as numbers."""
        results = []
        for case, evaluation in self.samples.items():
            contrast = self.contrasts.get(case)
            results.append(
                {
                    "rules": case.rules,
                    "scenario": case.scenario.name,
                    **evaluation.summary(),
                    "p_value": contrast and contrast.comparison.p_value,
                    "p_holm": contrast and contrast.p_holm,
                    "effect": contrast and contrast.comparison.effect,
                }
            )
        return {"runs": self.runs, "seed": self.seed, "results": results}

    @property
    def objective(self) -> str:
        """What the figures are of, for titles."""
        labels = [evaluation.objective.label for evaluation in self.samples.values()]
        return " / ".join(dict.fromkeys(labels))

    def csv(self) -> str:
        """One line per run: fitness and all measures; what a scenario does not count is empty."""
        counted = [name for evaluation in self.samples.values() for name in evaluation.measures]
        names = list(dict.fromkeys(counted))
        lines = io.StringIO()
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(("rules", "scenario", "robots", "run", "fitness", *names))
        for case, evaluation in self.samples.items():
            for run, fitness in enumerate(evaluation.fitness.tolist()):
                measures = [
                    evaluation.measures[name][run].item() if name in evaluation.measures else ""
                    for name in names
                ]
                where = case.scenario
                writer.writerow((case.rules, where.name, where.robots, run, fitness, *measures))
        return lines.getvalue()

    def page(self) -> str:
        """A page that needs nothing else: box plots, the table, and the rules."""
        from geswarm.analysis.figures import box_plots
        from geswarm.analysis.page import figure_html, page, table_html

        figure = box_plots(self.samples)
        figure.update_layout(width=1000, height=480)
        caption = f"{self.runs} runs each, seed {self.seed}."
        tables = "\n".join(
            f"<div><h3>{escape(name)}</h3>\n{_as_html(each)}</div>"
            for name, each in self.rule_sets.items()
        )
        body = f"""<h1>Compared rule sets</h1>
{figure_html(figure, "fitness", caption)}
{table_html(HEADINGS, self.rows(), texts=2)}
<p class="muted">{escape(self.explanation)}</p>
<h2>Rules</h2>
<div class="side-by-side rules">{tables}</div>"""
        return page("GESwarm: compared rule sets", body)


def _as_html(controller: Runnable) -> str:
    """A table of rules, or AutoMoDe's text."""
    from geswarm.exports import format_html

    if isinstance(controller, RuleSet):
        return format_html(controller)
    return f"<p><code>{escape(format_controller(controller))}</code></p>"
