"""What the verbs share: types of arguments, help texts, and one message for every failure."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from typing import TypeAlias

from geswarm.cli.streams import OutputError, abandon_output, prepare_streams

Verbs: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
"""Where each group of verbs adds its own."""

RULES_HELP = (
    "a preset (hand-coded, evo8, evolved, aac, ...), a YAML, text or JSON file, or - for standard "
    "input"
)
CONTROLLERS_HELP = f"{RULES_HELP}; controllers in AutoMoDe's text, too"
SCENARIO_HELP = (
    "a scenario (paper, aac, homing, ...; `geswarm scenarios` lists them) or a YAML file"
)


class UsageError(Exception):
    """What the user asked for cannot be done; the message says why. Exit status 2."""


def run_command(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> int:
    """Parse, run the chosen command and turn every expected failure into one clear message."""
    prepare_streams()
    try:
        try:
            options = parser.parse_args(arguments)
            command: Callable[[argparse.Namespace], int] = options.command
            return command(options)
        finally:
            sys.stdout.flush()
    except (UsageError, ImportError) as error:  # the second: not installed as it should be
        return _end(parser, str(error), 2)
    except BrokenPipeError:  # who read it has seen enough
        abandon_output()
        return 1
    except OutputError as error:
        abandon_output()
        return _end(parser, str(error), 1)
    except KeyboardInterrupt:
        return _end(parser, "stopped", 130)


def _end(parser: argparse.ArgumentParser, message: str, status: int) -> int:
    print(f"{parser.prog}: {message}", file=sys.stderr)
    return status


def add_simulation_options(parser: argparse.ArgumentParser) -> None:
    """Add how often each rule set runs, with which random numbers, and how that is told."""
    parser.add_argument("--runs", type=positive_int, default=50, metavar="N")
    parser.add_argument("--seed", type=non_negative_int, default=0, metavar="N")
    parser.add_argument("--workers", type=positive_int, metavar="N", help="default: all cores")
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")


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
