"""What the verbs share: types of arguments, help texts, and one message for every failure."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from io import TextIOWrapper
from typing import TypeAlias

Verbs: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
"""Where each group of verbs adds its own."""

RULES_HELP = (
    "a preset (hand-coded, evo8, evolved), a YAML, text or JSON file, or - for standard input"
)
SCENARIO_HELP = "a scenario (paper, ideal-sensing, scalability-5, ...) or a YAML file"


class UsageError(Exception):
    """What the user asked for cannot be done; the message says why. Exit status 2."""


def run_command(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> int:
    """Parse, run the chosen command and turn every expected failure into one clear message."""
    if isinstance(sys.stdout, TextIOWrapper):  # rather \u2190 than an error where it has no ←
        sys.stdout.reconfigure(errors="backslashreplace")
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
