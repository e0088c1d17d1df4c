"""The `geswarm` verbs, from evaluate to bench.

JSON goes to stdout alone, progress and warnings to stderr. Heavy modules are imported by the verb
that needs them, so that help comes at once.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from geswarm import __version__
from geswarm.cli.arguments import (
    RULES_HELP,
    SCENARIO_HELP,
    UsageError,
    non_negative_int,
    positive_int,
    run_command,
)
from geswarm.cli.compare import add_compare
from geswarm.cli.experiments import add_experiment_verbs
from geswarm.cli.imports import add_import
from geswarm.cli.library import add_library_verbs
from geswarm.cli.reproduce import add_reproduce
from geswarm.cli.rules import add_rule_verbs

__all__ = [
    "RULES_HELP",
    "SCENARIO_HELP",
    "UsageError",
    "main",
    "non_negative_int",
    "positive_int",
    "run_command",
]


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point of `geswarm`; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="geswarm", description="Evaluate, read and carry the rules of a robot swarm."
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    verbs = parser.add_subparsers(required=True, metavar="VERB")
    add_experiment_verbs(verbs)
    add_compare(verbs)
    add_reproduce(verbs)
    add_rule_verbs(verbs)
    add_import(verbs)
    add_library_verbs(verbs)
    return run_command(parser, arguments)
