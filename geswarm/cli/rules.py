"""The verbs that read and carry rule sets: show, check, equal, export."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geswarm.cli.arguments import RULES_HELP, UsageError, Verbs
from geswarm.cli.output import shortened, write_files
from geswarm.cli.words import WORDS_HELP, Words, words_of

if TYPE_CHECKING:
    from geswarm.rules import RuleSet

EXPORT_FORMS = (
    "yaml", "text", "json", "english", "markdown", "latex",
    "mermaid", "dot", "svg", "argos-lua", "automode",
)  # fmt: skip

# `SCHEMA_FILE` of the export, without importing it: help comes at once.
_JSON_SCHEMA = Path(__file__).parents[1] / "exports" / "rule-set.schema.json"


def add_rule_verbs(verbs: Verbs) -> None:
    """Add show, check, equal and export."""
    show = verbs.add_parser("show", help="print a rule set")
    show.add_argument("rules", metavar="RULES", help=RULES_HELP)
    show.add_argument("--as", dest="form", choices=["table", "text", "yaml"], default="table")
    show.add_argument("--scenario", metavar="S", help=WORDS_HELP)
    show.set_defaults(command=_show)

    check = verbs.add_parser("check", help="list everything that is wrong with a rule set")
    check.add_argument("rules", metavar="RULES", help=RULES_HELP)
    check.add_argument("--scenario", metavar="S", help=WORDS_HELP)
    check.set_defaults(command=_check)

    equal = verbs.add_parser("equal", help="tell whether two rule sets make robots do the same")
    equal.add_argument("a", metavar="A", help=RULES_HELP)
    equal.add_argument("b", metavar="B", help=RULES_HELP)
    equal.add_argument("--scenario", metavar="S", help=WORDS_HELP)
    equal.add_argument("--json", action="store_true", help="one JSON object on stdout")
    equal.set_defaults(command=_equal)

    export = verbs.add_parser(
        "export",
        help="write a rule set in a form for use elsewhere",
        epilog=f"What --to json writes is described by {_JSON_SCHEMA} (JSON Schema).",
    )
    export.add_argument("rules", metavar="RULES", help=RULES_HELP)
    export.add_argument("--to", dest="form", choices=EXPORT_FORMS, required=True)
    export.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    export.add_argument(
        "--scenario", metavar="S", help=f"{WORDS_HELP}; argos-lua: also its parameters"
    )
    export.add_argument(
        "--experiment", metavar="FILE", help="argos-lua: also write the scenario for ARGoS"
    )
    export.add_argument(
        "--strict", action="store_true", help="automode: refuse what cannot be expressed"
    )
    export.set_defaults(command=_export)


def _show(options: argparse.Namespace) -> int:
    from geswarm.rules import FORMATS, RuleSetError, find_rule_set, format_table

    try:
        found = find_rule_set(options.rules)
        rule_set = words_of([found], options.scenario).read(found)
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    form = format_table if options.form == "table" else FORMATS[options.form]
    sys.stdout.write(form(rule_set))
    return 0


def _check(options: argparse.Namespace) -> int:
    """Exit 1 if there is an error or a warning; hints are about pieces without effect."""
    from geswarm.rules import RuleSetError, RuleSetNotFoundError, check, find_rule_set

    try:
        found = find_rule_set(options.rules)
        words = words_of([found], options.scenario)
        findings: Sequence[Any] = check(words.read(found), words.vocabulary)
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
    from geswarm.rules import RuleSetError, find_rule_set, first_difference

    try:
        found = [find_rule_set(name) for name in (options.a, options.b)]
        words = words_of(found, options.scenario)
        a, b = map(words.read, found)
        difference = first_difference(a, b, words.vocabulary)
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    if options.json:
        told = None if difference is None else vars(difference)
        print(json.dumps({"a": options.a, "b": options.b, "equal": not told, "difference": told}))
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
    from geswarm.exports import EXPORTS
    from geswarm.rules import RuleSetError, find_rule_set

    for option, form in (("experiment", "argos-lua"), ("strict", "automode")):
        if getattr(options, option) and options.form != form:
            raise UsageError(f"--{option} goes with --to {form}, not with --to {options.form}")
    try:
        found = find_rule_set(options.rules)
        words = words_of([found], options.scenario)
        rule_set = words.read(found)
        if options.form == "automode" and not _automode_says_all(rule_set, words, options.strict):
            return 1
        if options.form == "argos-lua":
            files = _argos_files(rule_set, words, options)
        else:
            files = {options.output: EXPORTS[options.form](rule_set, words.vocabulary)}
    except RuleSetError as error:
        raise UsageError(str(error)) from error
    write_files(files)
    return 0


def _automode_says_all(rule_set: RuleSet, words: Words, strict: bool) -> bool:
    """List on stderr what AutoMoDe cannot express; False if that is a reason to refuse."""
    from geswarm.exports import to_automode

    warnings = to_automode(rule_set, words.vocabulary).warnings
    severity = "error" if strict else "warning"
    for warning in warnings:
        print(f"{severity}: AutoMoDe: {warning}", file=sys.stderr)
    return not (warnings and strict)


def _argos_files(
    rule_set: RuleSet, words: Words, options: argparse.Namespace
) -> dict[str | None, str]:
    """The controller script and, if asked for, the experiment and its floor beside it."""
    from geswarm.exports import format_argos_experiment, format_argos_lua, format_floor

    scenario = words.scenario
    files: dict[str | None, str] = {options.output: format_argos_lua(rule_set, scenario)}
    if options.experiment:
        if not options.output:
            raise UsageError("--experiment refers to the script by its name: give it one with -o")
        if not (scenario.arena.banded and scenario.nest and scenario.source and scenario.light):
            raise UsageError(
                f"--experiment: the arena of {words.name} has no counterpart there, expected a "
                "rectangle with nest and source along its walls"
            )
        experiment = Path(options.experiment)
        if not experiment.name:
            raise UsageError(f"--experiment: expected a file, got {options.experiment!r}")
        floor = experiment.with_name(f"{shortened(experiment.stem)}-floor.ppm")
        script = os.path.relpath(options.output, experiment.parent)
        files[str(floor)] = format_floor(scenario)
        files[str(experiment)] = format_argos_experiment(scenario, script, floor.name)
        if len(files) < 3:
            raise UsageError("the script and the experiment must be different files")
    return files
