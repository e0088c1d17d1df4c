"""The verbs that run simulations and print figures: evaluate, bench."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from geswarm.cli.arguments import (
    CONTROLLERS_HELP,
    SCENARIO_HELP,
    UsageError,
    Verbs,
    add_simulation_options,
)
from geswarm.cli.controllers import read_runnable
from geswarm.cli.output import print_table, progress_bar
from geswarm.cli.stopping import compile_first

if TYPE_CHECKING:
    from geswarm.analysis import Comparison
    from geswarm.evaluation import Evaluation


def add_experiment_verbs(verbs: Verbs) -> None:
    """Add evaluate and bench."""
    evaluate = verbs.add_parser("evaluate", help="run rule sets in a scenario and compare them")
    evaluate.add_argument("rules", nargs="+", metavar="RULES", help=CONTROLLERS_HELP)
    evaluate.add_argument("--scenario", default="paper", metavar="S", help=SCENARIO_HELP)
    add_simulation_options(evaluate)
    evaluate.set_defaults(command=_evaluate)

    bench = verbs.add_parser("bench", help="measure the speed of everything on this machine")
    bench.add_argument(
        "--scenario", metavar="S", help=f"what each term costs there: {SCENARIO_HELP}"
    )
    bench.add_argument("--json", action="store_true", help="one JSON object on stdout")
    bench.set_defaults(command=_bench)


def _evaluate(options: argparse.Namespace) -> int:
    from geswarm.analysis import compare
    from geswarm.evaluation import evaluate_rule_sets

    (scenario,), found = read_runnable(options.rules, [options.scenario])
    compile_first("geswarm: stopped", scenario)
    with progress_bar() as on_progress:
        evaluations = evaluate_rule_sets(
            [each for _, each in found],
            scenario,
            options.runs,
            options.seed,
            options.workers,
            on_progress=on_progress,
        )
    names = [name for name, _ in found]
    pairs = [
        (a, b, compare(evaluations[a].gains, evaluations[b].gains))
        for a in range(len(evaluations))
        for b in range(a + 1, len(evaluations))
    ]
    if options.json:
        document = {
            "scenario": options.scenario,
            "runs": options.runs,
            "seed": options.seed,
            "objective": scenario.objective.document(),
            "results": [
                {"rules": name, **evaluation.summary()}
                for name, evaluation in zip(names, evaluations, strict=True)
            ],
            "comparisons": [
                {
                    "a": names[a],
                    "b": names[b],
                    "p_value": comparison.p_value,
                    "effect": comparison.effect,
                }
                for a, b, comparison in pairs
            ],
        }
        print(json.dumps(document))
    else:
        _print_evaluations(options, names, evaluations, pairs)
    return 0


def _print_evaluations(
    options: argparse.Namespace,
    names: Sequence[str],
    evaluations: Sequence[Evaluation],
    pairs: Sequence[tuple[int, int, Comparison]],
) -> None:
    from rich.console import Console

    from geswarm.evaluation import shown

    objective = evaluations[0].objective
    title = f"{objective.label}, scenario {options.scenario}, {options.runs} runs each"
    figures = [evaluation.figures() for evaluation in evaluations]
    rows = [[name, *map(shown, found.values())] for name, found in zip(names, figures, strict=True)]
    print_table(title, ["rules"], [name.replace("_mean", " (mean)") for name in figures[0]], rows)
    console = Console(markup=False, emoji=False)
    for a, b, comparison in pairs:
        ahead, behind, effect = a, b, comparison.effect
        if effect < 0.5:
            ahead, behind, effect = b, a, 1 - effect
        console.print(
            f"{names[ahead]} beats {names[behind]} in {effect:.0%} of pairs of runs"
            f" (Mann-Whitney, two-sided: p = {comparison.p_value:.2g})",
            soft_wrap=True,
        )


def _bench(options: argparse.Namespace) -> int:
    if options.scenario is not None:
        return _bench_scenario(options)
    from geswarm.bench import command

    print(command(options.json, _say))
    return 0


def _bench_scenario(options: argparse.Namespace) -> int:
    from geswarm.costs import measure_costs
    from geswarm.sim import ScenarioError, load_scenario

    try:
        scenario = load_scenario(options.scenario)
    except ScenarioError as error:
        raise UsageError(str(error)) from error
    costs = measure_costs(scenario, _say)
    document = costs.document()
    if options.json:
        print(json.dumps(document))
        return 0
    rules = f"rules {costs.rules}" if costs.rules else "no rules"
    print(
        f"{options.scenario}, {scenario.robots} robots, {rules}: "
        f"{costs.nanoseconds:.1f} ns per robot and control step\n"
    )
    rows = [
        [each["name"], each["kind"], *(_ns(each[key]) for key in ("ns_without", "costs_ns"))]
        for each in document["terms"]
    ]
    print_table("Each term left out", ["term", "kind"], ["ns without", "costs ns"], rows)
    return 0


def _ns(value: float | None) -> str:
    """Nanoseconds; a dash where there is no doing without."""
    return "-" if value is None else f"{value:.1f}"


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
