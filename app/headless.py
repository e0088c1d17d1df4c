"""Evolution without the dashboard: a run directory, a progress bar, a clean stop."""

from __future__ import annotations

import argparse
import threading
from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress

from geswarm.cli import UsageError
from geswarm.cli.output import progress_columns
from geswarm.cli.stopping import STOPPED_STATUS, compile_first, every, stop_on_signals
from geswarm.evaluation import shown
from geswarm.evolution import (
    ClusterError,
    EvaluationError,
    EvolutionRun,
    InjectionError,
    RunConfig,
    cluster_executor,
    nearest_offered,
    preset_for,
)
from geswarm.ge import GenerationRecord, SettingsError, StoreError, fall_in_words
from geswarm.rules import RuleSetError, find_rule_set
from geswarm.sim import ScenarioError, load_scenario, vocabulary_of

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
            run = _open_run(options, say)
        except InjectionError as error:
            raise UsageError(f"--start-from {options.start_from}: {error}") from error
        except (ClusterError, ScenarioError, SettingsError, StoreError, RuleSetError) as error:
            raise UsageError(str(error)) from error
        resources.callback(run.close)
        return _evolve_and_report(run, options, executor, console)


def _evolve_and_report(
    run: EvolutionRun, options: argparse.Namespace, executor: Executor | None, console: Console
) -> int:
    try:
        with stop_on_signals() as stop:
            compile_first(f"Stopped. {_how_to_resume(run)}", run.config.scenario)
            _evolve(run, options.workers, executor, stop, console)
    except (StoreError, EvaluationError) as error:
        console.print(f"geswarm-ui: {error}", markup=False, soft_wrap=True)
        console.print(_how_to_resume(run), markup=False, soft_wrap=True)
        return 1
    if not run.finished:
        console.print(f"Stopped. {_how_to_resume(run)}", markup=False, soft_wrap=True)
        return STOPPED_STATUS
    objective, best = run.config.scenario.objective, run.directory / "best.yaml"
    value = shown(objective.gain(run.history[-1].best_so_far))
    written_for = run.best.scenario if run.best else ""  # foraging's rules do not say
    elsewhere = f" --scenario {options.scenario or written_for}" if written_for else ""
    console.print(
        f"Finished: {objective.label} of {best}: {value} on average. "
        f"See it: geswarm-ui --rules {best}{elsewhere}",
        markup=False,
        soft_wrap=True,
    )
    return 0


def _open_run(options: argparse.Namespace, say: Callable[[str], None]) -> EvolutionRun:
    if options.resume is not None:
        return EvolutionRun.resume(options.resume, options.generations, with_code=True)
    given = {
        name: getattr(options, name)
        for name in ("generations", "population", "evaluations")
        if getattr(options, name) is not None
    }
    scenario = load_scenario(options.scenario or "paper")
    config = RunConfig(
        scenario, preset_for(scenario, options.preset or "paper", **given), options.seed or 0
    )
    first = None
    if options.start_from is not None:
        words, named = vocabulary_of(scenario), options.scenario or "paper"
        written = find_rule_set(options.start_from).read(words, named)
        first, changed = nearest_offered(written, words)
        if changed:
            terms = ", ".join(f"{each} as {near}" for each, near in changed.items())
            say(f"Starts from {options.start_from} with the nearest numbers that evolve: {terms}")
    directory = Path(options.out) if options.out is not None else new_run_directory(config)
    return EvolutionRun.create(config, directory, first)


def _how_to_resume(run: EvolutionRun) -> str:
    return f"Resume with: geswarm-ui --no-ui --resume {run.directory}"


def _evolve(
    run: EvolutionRun,
    workers: int | None,
    executor: Executor | None,
    stop: threading.Event,
    console: Console,
) -> None:
    settings, objective = run.config.settings, run.config.scenario.objective
    for remark in run.remarks:
        console.print(remark, markup=False, soft_wrap=True)
    console.print(
        f"{run.config.scenario.name}, seed {run.config.seed}: {settings.generations} generations "
        f"of {settings.population}, {settings.evaluations} runs each, in {run.directory}; "
        f"to {'maximise' if objective.maximise else 'minimise'} {objective.label}",
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

        def fitness(gain: float) -> str:
            return shown(objective.gain(gain))

        def show(record: GenerationRecord) -> None:
            rate = 1 / record.seconds if record.seconds else 0.0
            fall = fall_in_words([one.best_so_far for one in run.history], fitness)
            figures = (
                f"best {fitness(record.best_so_far)}{fall and f' ({fall})'}, "
                f"mean {fitness(record.mean)}, "
                f"invalid {record.invalid}, {rate:.2g} generations/s,"
            )
            progress.update(task, completed=record.generation, figures=figures)
            if not console.is_terminal and log_is_due():  # a log file: lines, not a bar
                progress.console.print(
                    f"generation {record.generation}: {figures.rstrip(',')}", soft_wrap=True
                )

        run.run(workers, show, stop.is_set, executor)
