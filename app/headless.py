"""Evolution without the dashboard: a run directory, a progress bar, a clean stop."""

from __future__ import annotations

import argparse
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)

from geswarm.cli import UsageError
from geswarm.experiment import EvolutionRun, RunConfig
from geswarm.ge import GenerationRecord, Settings, SettingsError, StoreError
from geswarm.sim import ScenarioError, load_scenario

from .run_directory import new_run_directory

STOPPED_STATUS = 130


def evolve_headless(options: argparse.Namespace) -> int:
    """Evolve as the options say; 0 when all generations are done, 130 when stopped before."""
    console = Console(stderr=True)
    try:
        run = _open_run(options)
    except (ScenarioError, SettingsError, StoreError) as error:
        raise UsageError(str(error)) from error
    try:
        with _stop_on_signals() as stop:
            _evolve(run, options.workers, stop, console)
    except StoreError as error:
        console.print(f"geswarm-ui: {error}", markup=False)
        console.print(_how_to_resume(run), markup=False, soft_wrap=True)
        return 1
    finally:
        run.close()
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
        return EvolutionRun.resume(options.resume)
    given = {
        name: getattr(options, name)
        for name in ("generations", "population", "evaluations")
        if getattr(options, name) is not None
    }
    scenario = load_scenario(options.scenario or "paper")
    config = RunConfig(scenario, Settings(**given), options.seed or 0)
    directory = Path(options.out) if options.out is not None else new_run_directory(config)
    return EvolutionRun.create(config, directory)


def _how_to_resume(run: EvolutionRun) -> str:
    return f"Resume with: geswarm-ui --no-ui --resume {run.directory}"


def _evolve(
    run: EvolutionRun, workers: int | None, stop: threading.Event, console: Console
) -> None:
    settings = run.config.settings
    console.print(
        f"{run.config.scenario.name}, seed {run.config.seed}: {settings.generations} generations "
        f"of {settings.population}, {settings.evaluations} runs each, in {run.directory}",
        markup=False,
        soft_wrap=True,
    )
    progress = Progress(
        MofNCompleteColumn(),
        BarColumn(bar_width=None),
        TextColumn("{task.fields[figures]}"),
        TimeRemainingColumn(compact=True),
        TextColumn("left"),
        console=console,
        expand=True,
    )
    with progress:
        done = len(run.history)
        task = progress.add_task("", total=settings.generations, completed=done, figures="")

        def show(record: GenerationRecord) -> None:
            rate = 1 / record.seconds if record.seconds else 0.0
            figures = (
                f"best {record.best_so_far:.1f}, mean {record.mean:.1f}, "
                f"invalid {record.invalid}, {rate:.2g} generations/s,"
            )
            progress.update(task, completed=record.generation, figures=figures)

        run.run(workers, show, stop.is_set)


@contextmanager
def _stop_on_signals() -> Iterator[threading.Event]:
    """An event that Ctrl-C and SIGTERM set; a second Ctrl-C ends the program at once."""
    stop = threading.Event()

    def ask_to_stop(number: int, _frame: object) -> None:
        if stop.is_set() and number == signal.SIGINT:
            raise KeyboardInterrupt
        stop.set()

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number in before:
        signal.signal(number, ask_to_stop)
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
