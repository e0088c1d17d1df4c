"""The `geswarm` verbs: evaluate, show, check, equal, export.

JSON goes to stdout alone, progress and warnings to stderr. Heavy modules are imported by the verb
that needs them, so that help comes at once.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geswarm import __version__

if TYPE_CHECKING:
    from geswarm.analysis import Comparison
    from geswarm.experiment import Evaluation
    from geswarm.rules import RuleSet

RULES_HELP = "a preset (hand-coded, evo8), a YAML, text or JSON file, or - for standard input"
SCENARIO_HELP = "a scenario (paper, ideal-sensing, scalability-5, ...) or a YAML file"
EXPORT_FORMS = (
    "yaml", "text", "json", "english", "markdown", "latex",
    "mermaid", "dot", "svg", "argos-lua", "automode",
)  # fmt: skip


class UsageError(Exception):
    """What the user asked for cannot be done; the message says why. Exit status 2."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point of `geswarm`; returns the exit status."""
    return run_command(_parser(), arguments)


def run_command(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> int:
    """Parse, run the chosen command and turn every expected failure into one clear message."""
    options = parser.parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.command
    try:
        return command(options)
    except UsageError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        sys.stderr.close()
        return 1
    except KeyboardInterrupt:
        print(f"{parser.prog}: stopped", file=sys.stderr)
        return 130


def positive_int(text: str) -> int:
    """Argument type: a whole number of at least 1."""
    return _whole_number(text, 1)


def non_negative_int(text: str) -> int:
    """Argument type: a whole number of at least 0."""
    return _whole_number(text, 0)


def _whole_number(text: str, least: int) -> int:
    try:
        value = int(text)
    except ValueError:
        value = least - 1
    if not least <= value < 2**63:
        raise argparse.ArgumentTypeError(f"expected a whole number >= {least}, got {text!r}")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="geswarm", description="Evaluate, read and carry the rules of a robot swarm."
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    verbs = parser.add_subparsers(required=True, metavar="VERB")

    evaluate = verbs.add_parser("evaluate", help="run rule sets in a scenario and compare them")
    evaluate.add_argument("rules", nargs="+", metavar="RULES", help=RULES_HELP)
    evaluate.add_argument("--scenario", default="paper", metavar="S", help=SCENARIO_HELP)
    evaluate.add_argument("--runs", type=positive_int, default=50, metavar="N")
    evaluate.add_argument("--seed", type=non_negative_int, default=0, metavar="N")
    evaluate.add_argument("--workers", type=positive_int, metavar="N", help="default: all cores")
    evaluate.add_argument("--json", action="store_true", help="one JSON object on stdout")
    evaluate.set_defaults(command=_evaluate)

    show = verbs.add_parser("show", help="print a rule set")
    show.add_argument("rules", metavar="RULES", help=RULES_HELP)
    show.add_argument("--as", dest="form", choices=["table", "text", "yaml"], default="table")
    show.set_defaults(command=_show)

    check = verbs.add_parser("check", help="list everything that is wrong with a rule set")
    check.add_argument("rules", metavar="RULES", help=RULES_HELP)
    check.set_defaults(command=_check)

    bench = verbs.add_parser("bench", help="measure the speed of everything on this machine")
    bench.add_argument("--json", action="store_true", help="one JSON object on stdout")
    bench.set_defaults(command=_bench)

    equal = verbs.add_parser("equal", help="tell whether two rule sets make robots do the same")
    equal.add_argument("a", metavar="A", help=RULES_HELP)
    equal.add_argument("b", metavar="B", help=RULES_HELP)
    equal.add_argument("--json", action="store_true", help="one JSON object on stdout")
    equal.set_defaults(command=_equal)

    export = verbs.add_parser("export", help="write a rule set in a form for use elsewhere")
    export.add_argument("rules", metavar="RULES", help=RULES_HELP)
    export.add_argument("--to", dest="form", choices=EXPORT_FORMS, required=True)
    export.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    export.add_argument("--scenario", metavar="S", help=f"argos-lua: {SCENARIO_HELP}")
    export.add_argument(
        "--experiment", metavar="FILE", help="argos-lua: also write the scenario for ARGoS"
    )
    export.add_argument(
        "--strict", action="store_true", help="automode: refuse what cannot be expressed"
    )
    export.set_defaults(command=_export)
    return parser


def _show(options: argparse.Namespace) -> int:
    from geswarm.rules import FORMATS, RuleSetError, format_table, load_rule_set

    try:
        rule_set = load_rule_set(options.rules)
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    form = format_table if options.form == "table" else FORMATS[options.form]
    sys.stdout.write(form(rule_set))
    return 0


def _check(options: argparse.Namespace) -> int:
    """Exit 1 if there is an error or a warning; hints are about pieces without effect."""
    from geswarm.rules import RuleSetError, RuleSetNotFoundError, check, load_rule_set

    try:
        findings: Sequence[Any] = check(load_rule_set(options.rules))
    except RuleSetNotFoundError as error:
        raise UsageError(str(error)) from error
    except RuleSetError as error:
        findings = error.findings
    for finding in findings:
        print(f"{finding.severity}: {finding}")
    if not findings:
        print(f"{options.rules}: no findings")
    return int(any(finding.severity != "hint" for finding in findings))


def _equal(options: argparse.Namespace) -> int:
    """Exit 1 if there is a situation in which the two decide differently."""
    from geswarm.rules import RuleSetError, first_difference, load_rule_set

    try:
        difference = first_difference(load_rule_set(options.a), load_rule_set(options.b))
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    if options.json:
        found = None if difference is None else vars(difference)
        print(json.dumps({"a": options.a, "b": options.b, "equal": not found, "difference": found}))
    elif difference is None:
        print("equal")
    else:
        print(f"different {difference.situation}:")
        for name, decisions in ((options.a, difference.first), (options.b, difference.second)):
            print(f"  {name}")
            for decision, p in decisions.items():
                print(f"    {p:<9.6g} {decision}")
    return int(difference is not None)


def _export(options: argparse.Namespace) -> int:
    """Exit 1 if `--strict` refuses; nothing is written then."""
    from geswarm.rules import RuleSetError, load_rule_set
    from geswarm.rules.exports import EXPORTS

    for option, form in (
        ("scenario", "argos-lua"),
        ("experiment", "argos-lua"),
        ("strict", "automode"),
    ):
        if getattr(options, option) and options.form != form:
            raise UsageError(f"--{option} goes with --to {form}, not with --to {options.form}")
    try:
        rule_set = load_rule_set(options.rules)
        if options.form == "automode" and not _automode_says_all(rule_set, options):
            return 1
        if options.form == "argos-lua":
            files = _argos_files(rule_set, options)
        else:
            files = {options.output: EXPORTS[options.form](rule_set)}
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    _write(files)
    return 0


def _automode_says_all(rule_set: RuleSet, options: argparse.Namespace) -> bool:
    """List on stderr what AutoMoDe cannot express; False if that is a reason to refuse."""
    from geswarm.rules.exports import to_automode

    warnings = to_automode(rule_set).warnings
    severity = "error" if options.strict else "warning"
    for warning in warnings:
        print(f"{severity}: AutoMoDe: {warning}", file=sys.stderr)
    return not (warnings and options.strict)


def _argos_files(rule_set: RuleSet, options: argparse.Namespace) -> dict[str | None, str]:
    """The controller script and, if asked for, the experiment and its floor beside it."""
    from geswarm.rules.exports import format_argos_experiment, format_argos_lua, format_floor
    from geswarm.sim import ScenarioError, load_scenario

    try:
        scenario = load_scenario(options.scenario or "paper")
    except ScenarioError as error:
        raise UsageError(str(error)) from error
    files: dict[str | None, str] = {options.output: format_argos_lua(rule_set, scenario)}
    if options.experiment:
        if not options.output:
            raise UsageError("--experiment refers to the script by its name: give it one with -o")
        experiment = Path(options.experiment)
        floor = experiment.with_name(f"{experiment.stem}-floor.ppm")
        script = os.path.relpath(options.output, experiment.parent)
        files[str(floor)] = format_floor(scenario)
        files[str(experiment)] = format_argos_experiment(scenario, script, floor.name)
        if len(files) < 3:
            raise UsageError("the script and the experiment must be different files")
    return files


def _write(files: dict[str | None, str]) -> None:
    """Write each text to its file, as a whole, or to standard output."""
    from geswarm.rules.library import write_whole

    for path, text in files.items():
        if path is None:
            sys.stdout.write(text)
            continue
        try:
            write_whole(text, path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise UsageError(f"{path}: cannot be written: {reason}") from error


def _evaluate(options: argparse.Namespace) -> int:
    from geswarm.analysis import compare
    from geswarm.experiment import evaluate_rule_sets
    from geswarm.rules import RuleSetError, load_rule_set
    from geswarm.sim import ScenarioError, is_compiled, load_scenario, warm_up

    try:
        rule_sets = [load_rule_set(reference) for reference in options.rules]
        scenario = load_scenario(options.scenario)
    except (RuleSetError, ScenarioError) as error:
        raise UsageError(str(error)) from error
    if not is_compiled():
        warm_up()
    with _progress() as on_progress:
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


def _bench(options: argparse.Namespace) -> int:
    from geswarm.bench import command

    print(command(options.json, lambda line: print(line, file=sys.stderr)))
    return 0


@contextmanager
def _progress() -> Iterator[Callable[[int, int], None]]:
    """A progress bar on stderr that is gone when the work is done."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("simulating", total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)


def _print_evaluations(
    options: argparse.Namespace,
    evaluations: Sequence[Evaluation],
    pairs: Sequence[tuple[int, int, Comparison]],
) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    table = Table(title=f"Collected objects, scenario {options.scenario}, {options.runs} runs each")
    table.add_column("rules")
    for heading in ("mean", "sd", "median", "lost (mean)"):
        table.add_column(heading, justify="right")
    for name, evaluation in zip(options.rules, evaluations, strict=True):
        row = evaluation.summary()
        figures = [f"{row[key]:.1f}" for key in ("mean", "sd", "median", "lost_mean")]
        table.add_row(name, *figures)
    console.print(table)
    for a, b, comparison in pairs:
        ahead, behind, effect = a, b, comparison.effect
        if effect < 0.5:
            ahead, behind, effect = b, a, 1 - effect
        console.print(
            f"{options.rules[ahead]} beats {options.rules[behind]} in {effect:.0%} of pairs of runs"
            f" (Mann-Whitney, two-sided: p = {comparison.p_value:.2g})",
            soft_wrap=True,
        )


if __name__ == "__main__":
    sys.exit(main())
