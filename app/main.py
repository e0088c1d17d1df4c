"""`geswarm-ui`: the dashboard, or with `--no-ui` headless evolution."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from geswarm import __version__
from geswarm.cli import (
    RULES_HELP,
    SCENARIO_HELP,
    UsageError,
    non_negative_int,
    positive_int,
    run_command,
)

_DASHBOARD_ONLY = ("host", "port", "allow_host", "rules")
_SET_BY_THE_RUN = (
    "scenario", "preset", "population", "evaluations", "seed", "start_from", "out",
)  # fmt: skip
_HEADLESS_ONLY = (*_SET_BY_THE_RUN[1:], "generations", "resume", "cluster")


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point of `geswarm-ui`; returns the exit status."""
    return run_command(_parser(), arguments)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="geswarm-ui",
        description="Watch a robot swarm, change its rules while it runs, and evolve better ones.",
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    parser.add_argument("--scenario", metavar="S", help=f"{SCENARIO_HELP}; default: paper")
    parser.add_argument("--workers", type=positive_int, metavar="N", help="evaluation threads")
    dashboard = parser.add_argument_group("dashboard")
    dashboard.add_argument("--host", metavar="H", help="default: 127.0.0.1, this machine only")
    dashboard.add_argument("--port", type=_port, metavar="P", help="default: 8080")
    dashboard.add_argument(
        "--allow-host",
        action="append",
        type=_name,
        metavar="NAME",
        help="let in who reaches it under this name, through a proxy or a tunnel, with :PORT if "
        "the browser's address has one; may be given several times",
    )
    dashboard.add_argument(
        "--token",
        action="store_true",
        help="let in only who has the token in the address; always so if other machines can come",
    )
    dashboard.add_argument("--rules", metavar="R", help=f"{RULES_HELP}; default: evo8")
    dashboard.add_argument("--dark", action="store_true", help="light text on a dark ground")
    headless = parser.add_argument_group("headless evolution")
    headless.add_argument("--no-ui", action="store_true", help="evolve without the dashboard")
    headless.add_argument("--preset", metavar="P", help="paper (default) or modern")
    headless.add_argument("--generations", type=positive_int, metavar="N", help="default: 1000")
    headless.add_argument(
        "--population", type=positive_int, metavar="N", help="default: 100, in modern 200"
    )
    headless.add_argument(
        "--evaluations",
        type=positive_int,
        metavar="N",
        help="runs per individual; default: 3, in modern 1",
    )
    headless.add_argument("--seed", type=non_negative_int, metavar="N", help="default: 0")
    headless.add_argument(
        "--start-from", metavar="R", help="rules that enter the first generation, named as --rules"
    )
    headless.add_argument("--out", metavar="DIR", help="run directory; default: a new one in runs/")
    headless.add_argument(
        "--resume",
        metavar="DIR",
        help="continue the run of a directory; with --generations N to another end",
    )
    headless.add_argument(
        "--cluster", metavar="ADDRESS", help="evaluate on the workers of a Dask scheduler"
    )
    parser.set_defaults(command=_start)
    return parser


def _port(text: str) -> int:
    port = non_negative_int(text)
    if port > 65535:
        raise argparse.ArgumentTypeError(f"expected 0 to 65535, got {text!r}")
    return port


def _name(text: str) -> tuple[str, int | None]:
    from .server.access import parse_name

    try:
        return parse_name(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _start(options: argparse.Namespace) -> int:
    if options.no_ui:
        _refuse(options, _DASHBOARD_ONLY, "is for the dashboard, not for --no-ui")
        if options.cluster is not None:
            _refuse(options, ("workers",), "is for this machine, not for --cluster")
        if options.resume is not None:
            _refuse(options, _SET_BY_THE_RUN, "is fixed by the run that --resume continues")
        from .headless import evolve_headless

        return evolve_headless(options)
    _refuse(options, _HEADLESS_ONLY, "needs --no-ui")
    from .dashboard import run_dashboard

    return run_dashboard(options)


def _refuse(options: argparse.Namespace, names: Sequence[str], reason: str) -> None:
    given = [f"--{name.replace('_', '-')}" for name in names if getattr(options, name) is not None]
    if given:
        raise UsageError(f"{', '.join(given)} {reason}")


if __name__ == "__main__":
    sys.exit(main())
