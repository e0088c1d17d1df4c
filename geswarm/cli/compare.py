"""`geswarm compare`: any rule sets in any scenarios, as a table, JSON or a page with box plots."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING

from geswarm.cli.arguments import (
    CONTROLLERS_HELP,
    SCENARIO_HELP,
    UsageError,
    Verbs,
    add_simulation_options,
)
from geswarm.cli.controllers import read_runnable
from geswarm.cli.output import print_table, progress_bar, require_writable, write_files
from geswarm.cli.stopping import compile_first

if TYPE_CHECKING:
    from geswarm.analysis.compared import Compared


def add_compare(verbs: Verbs) -> None:
    """Add compare."""
    compare = verbs.add_parser("compare", help="compare rule sets in several scenarios")
    compare.add_argument("rules", nargs="+", metavar="RULES", help=CONTROLLERS_HELP)
    compare.add_argument("--scenario", nargs="+", action="extend", metavar="S", help=SCENARIO_HELP)
    compare.add_argument("--html", metavar="FILE", help="write a page with box plots")
    add_simulation_options(compare)
    compare.set_defaults(command=_compare)


def _compare(options: argparse.Namespace) -> int:
    from geswarm.analysis.cases import Case, run_cases
    from geswarm.analysis.compared import Compared

    names = options.scenario or ["paper"]
    for what, given in (("rules", options.rules), ("scenario", names)):
        if twice := [one for one in given if given.count(one) > 1]:
            raise UsageError(f"{what}: expected each one once, got {twice[0]} twice")
    scenarios, read = read_runnable(options.rules, names)
    rule_sets = dict(read)
    if options.html is not None:
        require_writable(options.html)
    compile_first("geswarm: stopped", *scenarios)
    cases = [Case(name, scenario) for scenario in scenarios for name in rule_sets]
    with progress_bar() as on_progress:
        samples = run_cases(
            cases,
            rule_sets,
            options.runs,
            options.seed,
            options.workers,
            on_progress=on_progress,
        )
    compared = Compared(rule_sets, samples, next(iter(rule_sets)), options.runs, options.seed)
    try:
        if options.json:
            print(json.dumps(compared.document()))
        else:
            _print_table(compared)
    finally:  # whichever cannot be written, the other one is
        if options.html is not None:
            write_files({options.html: compared.page()})
    return 0


def _print_table(compared: Compared) -> None:
    from rich.console import Console

    from geswarm.analysis.compared import HEADINGS

    title = f"{compared.objective}, {compared.runs} runs each, seed {compared.seed}"
    print_table(title, HEADINGS[:2], HEADINGS[2:], compared.rows())
    if compared.explanation:
        Console().print(compared.explanation, markup=False, highlight=False)
