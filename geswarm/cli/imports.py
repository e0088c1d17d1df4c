"""`geswarm import`: controllers of others, shown in words and written as rules."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geswarm.cli.arguments import SCENARIO_HELP, UsageError, Verbs, positive_int
from geswarm.cli.output import print_texts, write_files

if TYPE_CHECKING:
    from geswarm.automode import Controller, Conversion
    from geswarm.rules import RuleSet, Vocabulary
    from geswarm.sim import Scenario


def add_import(verbs: Verbs) -> None:
    """Add import."""
    reads = verbs.add_parser(
        "import", help="read controllers of AutoMoDe, show them and write them as rules"
    )
    reads.add_argument("file", metavar="FILE", help="a file, or - for standard input")
    reads.add_argument("--from", dest="origin", choices=["automode"], required=True)
    reads.add_argument("--number", type=positive_int, metavar="N", help="the Nth of several")
    reads.add_argument(
        "--as",
        dest="form",
        choices=["rules", "machine"],
        help="write rules (YAML) or AutoMoDe's text; default: show them in words, rules with -o",
    )
    reads.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    reads.add_argument(
        "--scenario", metavar="S", help=f"in whose words rules are written: {SCENARIO_HELP}"
    )
    reads.add_argument(
        "--write-scenario",
        metavar="FILE",
        help="with --scenario and -o: also write a scenario that offers what the rules need",
    )
    reads.set_defaults(command=_import)


def _import(options: argparse.Namespace) -> int:
    """Exit 1 if rules are asked for and cannot say exactly the same; nothing is written then."""
    from geswarm.automode import format_controller

    if options.write_scenario is not None and (not options.scenario or not options.output):
        raise UsageError("--write-scenario: expected --scenario S and -o FILE with it")
    if options.write_scenario is not None and options.write_scenario == options.output:
        raise UsageError(f"--write-scenario and -o: expected two files, got {options.output} twice")
    controllers = _chosen(_read(options.file), options.number)
    form = options.form or ("rules" if options.output else None)
    if form == "machine":
        text = "".join(f"{format_controller(each)}\n" for each in controllers)
    elif form == "rules":
        conversion = _as_rules(controllers, options)
        if not conversion.exact:
            for departure in conversion.departures:
                print(f"error: AutoMoDe: {departure}", file=sys.stderr)
            return 1
        if options.write_scenario is not None:
            write_files(_with_scenario(conversion, options))
            return 0
        text = _yaml(conversion, options.scenario)
    else:
        _show(controllers, options)
        return 0
    write_files({options.output: text})
    return 0


def _read(file: str) -> tuple[Controller, ...]:
    from geswarm.automode import AutoMoDeError, read_controllers
    from geswarm.plain_text import NotTextError, read_file
    from geswarm.rules.library import read_stdin
    from geswarm.rules.limits import MAX_CHARACTERS

    source = "<stdin>" if file == "-" else file
    try:
        text = read_stdin() if file == "-" else read_file(file, MAX_CHARACTERS)
        return read_controllers(text, source)
    except AutoMoDeError as error:
        raise UsageError(str(error)) from error
    except NotTextError as error:
        raise UsageError(f"{source}: {error}") from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{source}: cannot be read: {reason}") from error


def _chosen(controllers: Sequence[Controller], number: int | None) -> Sequence[Controller]:
    if number is None:
        return controllers
    if number > len(controllers):
        raise UsageError(f"--number: expected 1 to {len(controllers)}, got {number}")
    return controllers[number - 1 : number]


def _as_rules(controllers: Sequence[Controller], options: argparse.Namespace) -> Conversion:
    """The rules of the only controller."""
    from geswarm.automode import Machine, to_rules

    if len(controllers) > 1:
        raise UsageError(
            f"rules: expected one controller, got {len(controllers)}: choose with --number"
        )
    (controller,) = controllers
    if not isinstance(controller, Machine):
        raise UsageError("rules: expected a machine, got a behaviour tree, which rules cannot say")
    name = "AutoMoDe" if options.file == "-" else Path(options.file).stem
    return to_rules(controller, name, _scenario(options.scenario).name if options.scenario else "")


def _yaml(conversion: Conversion, scenario: str | None) -> str:
    from geswarm.rules import format_yaml

    if missing := _missing(conversion, scenario):
        raise UsageError(missing)
    return format_yaml(conversion.rule_set)


def _with_scenario(conversion: Conversion, options: argparse.Namespace) -> dict[str | None, str]:
    """The scenario's file and that of the rules, which are in its words.

    It offers their probabilities beside its own, so that evolution can start from them.
    """
    from geswarm.rules import format_yaml
    from geswarm.sim import vocabulary_of

    file, known = Path(options.write_scenario), _scenario(options.scenario)
    used = {action.p for rule in conversion.rule_set.rules for action in rule.actions}
    changes: dict[str, Any] = {"probabilities": tuple(sorted({*known.probabilities, *used}))}
    if conversion.register:
        others = (each for each in known.registers if not each.startswith("STATE("))
        changes["registers"] = (*others, conversion.register)
    rule_set = replace(conversion.rule_set, scenario=file.stem)
    needed = known.with_changes(**changes)
    if missing := _missing_in(rule_set, vocabulary_of(needed), options.scenario):
        raise UsageError(missing)
    base = options.scenario
    if Path(base).is_file():
        base = os.path.relpath(base, file.parent)
    lines = ["# With what the rules of a machine of AutoMoDe need.", f"extends: {json.dumps(base)}"]
    lines += [f"{name}: {json.dumps(list(values))}" for name, values in changes.items()]
    return {options.write_scenario: "\n".join(lines) + "\n", options.output: format_yaml(rule_set)}


def _missing(conversion: Conversion, scenario: str | None) -> str:
    """What a scenario does not offer of what the rules mention; empty if it offers everything."""
    from geswarm.sim import vocabulary_of

    if scenario is None:
        return ""
    return _missing_in(conversion.rule_set, vocabulary_of(_scenario(scenario)), scenario)


def _missing_in(rule_set: RuleSet, vocabulary: Vocabulary, scenario: str) -> str:
    from geswarm.rules.names import name_errors, unknown_terms

    if unknown := unknown_terms(rule_set, vocabulary):
        return f"{scenario} does not offer {', '.join(unknown)}"
    errors = dict.fromkeys(each.message for each in name_errors(rule_set, vocabulary))
    return "\n".join(f"{scenario}: {message}" for message in errors)


def _scenario(name: str) -> Scenario:
    from geswarm.sim import ScenarioError, load_scenario

    try:
        return load_scenario(name)
    except ScenarioError as error:
        raise UsageError(str(error)) from error


def _show(controllers: Sequence[Controller], options: argparse.Namespace) -> None:
    from geswarm.automode import Machine, describe, to_rules

    for number, controller in enumerate(controllers, start=options.number or 1):
        is_machine = isinstance(controller, Machine)
        title = f"{'State machine' if is_machine else 'Behaviour tree'} {number}"
        headings = ("state", "behaviour", "transitions") if is_machine else ("node", "is", "")
        print_texts(title, headings, describe(controller))
        if isinstance(controller, Machine):
            _print_verdict(to_rules(controller), options.scenario)
        print()


def _print_verdict(conversion: Conversion, scenario: str | None) -> None:
    if conversion.exact:
        register = f", with the register {conversion.register}" if conversion.register else ""
        print(f"{len(conversion.rule_set.rules)} rules say exactly the same{register}.")
    else:
        print("Rules cannot say exactly the same; the greatest differences:")
        for departure in conversion.departures:
            print(f"  {departure}")
    if missing := _missing(conversion, scenario):
        print(missing)
