"""`geswarm reproduce`: the paper's experiments, from evolution to the report, in one command."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from geswarm.cli.arguments import UsageError, Verbs, non_negative_int, positive_int
from geswarm.cli.output import progress_columns
from geswarm.cli.stopping import STOPPED_STATUS, compile_first, every, stop_on_signals

if TYPE_CHECKING:
    from geswarm.analysis.reproduction import Campaign, Results
    from geswarm.analysis.reproduction.progress import OnProgress

_LOG_SECONDS = 10.0
_PLAN = ("runs", "generations", "seed")


def add_reproduce(verbs: Verbs) -> None:
    """Add reproduce."""
    reproduce = verbs.add_parser(
        "reproduce",
        help="repeat the paper's experiments and report which of its claims hold",
        description="Repeat the paper's experiments and report which of its claims hold. "
        "Called again with the same DIR it goes on where it was interrupted; with more --runs or "
        "--generations what is there is kept and goes on, too.",
    )
    reproduce.add_argument("--out", metavar="DIR", required=True, help="where everything is kept")
    reproduce.add_argument("--runs", type=positive_int, metavar="N", help="default: 10")
    reproduce.add_argument("--generations", type=positive_int, metavar="N", help="default: 1000")
    reproduce.add_argument("--seed", type=non_negative_int, metavar="N", help="default: 1")
    reproduce.add_argument(
        "--quick", action="store_true", help="3 runs of 50 generations, 20 evaluations: minutes"
    )
    reproduce.add_argument("--workers", type=positive_int, metavar="N", help="default: all cores")
    reproduce.add_argument(
        "--cluster", metavar="ADDRESS", help="evolve on the workers of a Dask scheduler"
    )
    reproduce.set_defaults(command=_reproduce)


def _reproduce(options: argparse.Namespace) -> int:
    """Exit status 0 if the report is written, whatever it says; 130 if it was stopped before."""
    if options.cluster is not None and options.workers is not None:
        raise UsageError("--workers is for this machine, not for --cluster")
    with stop_on_signals() as stop:
        from geswarm.analysis.reproduction import QUICK, Campaign, CampaignError

        asked = {name: getattr(options, name) for name in _PLAN}
        asked = {name: value for name, value in asked.items() if value is not None}
        if options.quick:
            asked = {**QUICK, **asked}
        try:
            campaign = Campaign.at(options.out, **asked)
        except CampaignError as error:
            raise UsageError(str(error)) from error
        for remark in campaign.remarks:
            _say(remark)
        return _carry_out(campaign, options, stop)


def _carry_out(campaign: Campaign, options: argparse.Namespace, stop: threading.Event) -> int:
    from geswarm.analysis.reproduction import CampaignError
    from geswarm.evolution import ClusterError, EvaluationError, cluster_executor
    from geswarm.ge import StoreError
    from geswarm.sim import EvaluationStopped

    go_on = f"Go on with: geswarm reproduce --out {campaign.directory}"
    compile_first(f"Stopped. {go_on}")
    with ExitStack() as resources:
        try:
            executor = None
            if options.cluster is not None:
                executor = resources.enter_context(cluster_executor(options.cluster, _say))
            with _progress() as on_progress:
                results = campaign.run(options.workers, executor, on_progress, stop.is_set)
        except ClusterError as error:
            raise UsageError(str(error)) from error
        except EvaluationStopped:
            print(f"Stopped. {go_on}", file=sys.stderr)
            return STOPPED_STATUS
        except (CampaignError, StoreError, EvaluationError) as error:
            print(f"geswarm: {error}\n{go_on}", file=sys.stderr)
            return 1
    _print_claims(results)
    print(f"Report: {campaign.directory / 'report.html'}", file=sys.stderr)
    return 0


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


@contextmanager
def _progress() -> Iterator[OnProgress]:
    """A bar over the whole campaign with the time left; where there is no terminal, lines."""
    from rich.console import Console
    from rich.progress import Progress, TaskProgressColumn

    console = Console(stderr=True)
    progress = Progress(
        *progress_columns(TaskProgressColumn, "{task.description}"),
        console=console,
        disable=not console.is_terminal,
        expand=True,
        speed_estimate_period=300,
    )
    log_is_due = every(_LOG_SECONDS)
    with progress:
        task = progress.add_task("", total=1.0)

        def show(share: float, doing: str) -> None:
            progress.update(task, completed=share, description=doing)
            if not console.is_terminal and log_is_due():
                seconds = progress.tasks[task].time_remaining
                left = "" if seconds is None else f", {_duration(seconds)} left"
                progress.console.print(f"{share:.1%}: {doing}{left}", soft_wrap=True)

        yield show


def _duration(seconds: float) -> str:
    """Like 40 s, 12 min or 1.5 h."""
    if seconds < 60:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _print_claims(results: Results) -> None:
    """One line per claim: verdict, where it stands in the paper, what it says."""
    from geswarm.analysis.reproduction import claims

    for claim in claims(results):
        print(f"{claim.verdict.value:<15} {claim.where:<15} {claim.paper}")
