"""The verbs that run simulations and print figures: evaluate, bench."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from geswarm.cli.arguments import (
    RULES_HELP,
    SCENARIO_HELP,
    UsageError,
    Verbs,
    add_simulation_options,
)
from geswarm.cli.output import print_table, progress_bar
from geswarm.cli.stopping import compile_first

if TYPE_CHECKING:
    from geswarm.analysis import Comparison
    from geswarm.evaluation import Evaluation


def add_experiment_verbs(verbs: Verbs) -> None:
    """Add evaluate and bench."""
    evaluate = verbs.add_parser("evaluate", help="run rule sets in a scenario and compare them")
    evaluate.add_argument("rules", nargs="+", metavar="RULES", help=RULES_HELP)
    evaluate.add_argument("--scenario", default="paper", metavar="S", help=SCENARIO_HELP)
    add_simulation_options(evaluate)
    evaluate.set_defaults(command=_evaluate)

    bench = verbs.add_parser("bench", help="measure the speed of everything on this machine")
    bench.add_argument("--json", action="store_true", help="one JSON object on stdout")
    bench.set_defaults(command=_bench)


def _evaluate(options: argparse.Namespace) -> int:
    from geswarm.analysis import compare
    from geswarm.evaluation import evaluate_rule_sets
    from geswarm.rules import RuleSetError, load_rule_set
    from geswarm.sim import ScenarioError, load_scenario

    try:
        rule_sets = [load_rule_set(reference) for reference in options.rules]
        scenario = load_scenario(options.scenario)
    except (RuleSetError, ScenarioError) as error:
        raise UsageError(str(error)) from error
    compile_first("geswarm: stopped")
    with progress_bar() as on_progress:
        evaluations = evaluate_rule_sets(
            rule_sets,
            scenario,
            options.runs,
            options.seed,
            options.workers,
            on_progress=on_progress,
        )
    pairs = [
        (a, b, compare(evaluations[a].collected, evaluations[b].collected))
        for a in range(len(evaluations))
        for b in range(a + 1, len(evaluations))
    ]
    if options.json:
        document = {
            "scenario": options.scenario,
            "runs": options.runs,
            "seed": options.seed,
            "results": [
                {"rules": name, **evaluation.summary()}
                for name, evaluation in zip(options.rules, evaluations, strict=True)
            ],
            "comparisons": [
                {
                    "a": options.rules[a],
                    "b": options.rules[b],
                    "p_value": comparison.p_value,
                    "effect": comparison.effect,
                }
                for a, b, comparison in pairs
            ],
        }
        print(json.dumps(document))
    else:
        _print_evaluations(options, evaluations, pairs)
    return 0


def _print_evaluations(
    options: argparse.Namespace,
    evaluations: Sequence[Evaluation],
    pairs: Sequence[tuple[int, int, Comparison]],
) -> None:
    from rich.console import Console

    title = f"Collected objects, scenario {options.scenario}, {options.runs} runs each"
    summaries = [evaluation.summary() for evaluation in evaluations]
    rows = [
        [name, *(f"{summary[key]:.1f}" for key in ("mean", "sd", "median", "lost_mean"))]
        for name, summary in zip(options.rules, summaries, strict=True)
    ]
    print_table(title, ["rules"], ["mean", "sd", "median", "lost (mean)"], rows)
    console = Console(markup=False, emoji=False)
    for a, b, comparison in pairs:
        ahead, behind, effect = a, b, comparison.effect
        if effect < 0.5:
            ahead, behind, effect = b, a, 1 - effect
        console.print(
            f"{options.rules[ahead]} beats {options.rules[behind]} in {effect:.0%} of pairs of runs"
            f" (Mann-Whitney, two-sided: p = {comparison.p_value:.2g})",
            soft_wrap=True,
        )


def _bench(options: argparse.Namespace) -> int:
    from geswarm.bench import command

    print(command(options.json, lambda line: print(line, file=sys.stderr)))
    return 0
