"""Evolution without the dashboard: a run directory, a progress bar, a clean stop."""

from __future__ import annotations

import argparse
import threading
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress

from geswarm.cli import UsageError
from geswarm.cli.output import progress_columns
from geswarm.cli.stopping import STOPPED_STATUS, compile_first, every, stop_on_signals
from geswarm.evolution import (
    ClusterError,
    EvaluationError,
    EvolutionRun,
    RunConfig,
    cluster_executor,
)
from geswarm.ge import GenerationRecord, Settings, SettingsError, StoreError, fall_in_words
from geswarm.sim import ScenarioError, load_scenario

from .run_directory import new_run_directory

_LOG_SECONDS = 10.0


def evolve_headless(options: argparse.Namespace) -> int:
    """Evolve as the options say; 0 when all generations are done, 130 when stopped before."""
    console = Console(stderr=True)

    def say(text: str) -> None:
        console.print(text, markup=False, soft_wrap=True)

    with ExitStack() as resources:
        try:
            executor = None
            if options.cluster is not None:
                executor = resources.enter_context(cluster_executor(options.cluster, say))
            run = _open_run(options)
        except (ClusterError, ScenarioError, SettingsError, StoreError) as error:
            raise UsageError(str(error)) from error
        resources.callback(run.close)
        return _evolve_and_report(run, options.workers, executor, console)


def _evolve_and_report(
    run: EvolutionRun, workers: int | None, executor: Executor | None, console: Console
) -> int:
    try:
        with stop_on_signals() as stop:
            compile_first(f"Stopped. {_how_to_resume(run)}")
            _evolve(run, workers, executor, stop, console)
    except (StoreError, EvaluationError) as error:
        console.print(f"geswarm-ui: {error}", markup=False, soft_wrap=True)
        console.print(_how_to_resume(run), markup=False, soft_wrap=True)
        return 1
    if not run.finished:
        console.print(f"Stopped. {_how_to_resume(run)}", markup=False, soft_wrap=True)
        return STOPPED_STATUS
    console.print(
        f"Finished: {run.directory / 'best.yaml'} collected {run.history[-1].best_so_far:.1f} "
        f"on average. See it: geswarm-ui --rules {run.directory / 'best.yaml'}",
        markup=False,
        soft_wrap=True,
    )
    return 0


def _open_run(options: argparse.Namespace) -> EvolutionRun:
    if options.resume is not None:
        return EvolutionRun.resume(options.resume, options.generations)
    given = {
        name: getattr(options, name)
        for name in ("generations", "population", "evaluations")
        if getattr(options, name) is not None
    }
    scenario = load_scenario(options.scenario or "paper")
    config = RunConfig(
        scenario, Settings.preset(options.preset or "paper", **given), options.seed or 0
    )
    directory = Path(options.out) if options.out is not None else new_run_directory(config)
    return EvolutionRun.create(config, directory)


def _how_to_resume(run: EvolutionRun) -> str:
    return f"Resume with: geswarm-ui --no-ui --resume {run.directory}"


def _evolve(
    run: EvolutionRun,
    workers: int | None,
    executor: Executor | None,
    stop: threading.Event,
    console: Console,
) -> None:
    settings = run.config.settings
    for remark in run.remarks:
        console.print(remark, markup=False, soft_wrap=True)
    console.print(
        f"{run.config.scenario.name}, seed {run.config.seed}: {settings.generations} generations "
        f"of {settings.population}, {settings.evaluations} runs each, in {run.directory}",
        markup=False,
        soft_wrap=True,
    )
    progress = Progress(
        *progress_columns(MofNCompleteColumn, "{task.fields[figures]}"),
        console=console,
        expand=True,
    )
    with progress:
        done = len(run.history)
        task = progress.add_task("", total=settings.generations, completed=done, figures="")
        log_is_due = every(_LOG_SECONDS)

        def show(record: GenerationRecord) -> None:
            rate = 1 / record.seconds if record.seconds else 0.0
            fall = fall_in_words([one.best_so_far for one in run.history])
            figures = (
                f"best {record.best_so_far:.1f}{fall and f' ({fall})'}, mean {record.mean:.1f}, "
                f"invalid {record.invalid}, {rate:.2g} generations/s,"
            )
            progress.update(task, completed=record.generation, figures=figures)
            if not console.is_terminal and log_is_due():  # a log file: lines, not a bar
                progress.console.print(
                    f"generation {record.generation}: {figures.rstrip(',')}", soft_wrap=True
                )

        run.run(workers, show, stop.is_set, executor)
