"""How fast the presets of the evolutionary algorithm find good rules: the tables of the README.

    python -m geswarm.analysis.presets_table runs/presets --runs 10 --generations 1000
    python -m geswarm.analysis.presets_table runs/aac --scenario epuck-aac --presets modern \
        --generations 50 --evaluations 2 --rivals published.txt

Each run lies in its own directory below the given one. The command may be stopped at any time;
called again it goes on where it stopped, also with more generations, and what is done is not done
again.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geswarm.analysis.statistics import compare
from geswarm.automode import AutoMoDeError, Runnable, find_controllers
from geswarm.evaluation import Evaluation, evaluate_rule_sets, shown
from geswarm.evolution import EvolutionRun, RunConfig, preset_for
from geswarm.ge import PRESETS, RunStore
from geswarm.rules import RuleSet, RuleSetError
from geswarm.sim import (
    ControllerError,
    Scenario,
    ScenarioError,
    load_scenario,
    parts_of,
    require_runnable,
    vocabulary_of,
)

MARKS = (50, 100, 300, 1000)
"""Generations after which the best rules so far are judged."""

RIVALS = ("hand-coded", "evo8")
JUDGING_RUNS = 50
JUDGING_SEED = 1_000_000  # of random numbers that no evolution has seen


@dataclass(frozen=True)
class Standing:
    """What the best rules of some runs are worth after some generations.

    Attributes:
        preset: Of the settings.
        generation: After which the best so far were taken.
        simulations: Spent until then by a run, mean; those that individuals which behave alike
            shared are counted for each.
        minutes: Wall-clock time of a run until then, mean.
        means: Mean fitness of each run's best, 50 simulations each.
        beats: For each rival, how many of them are better, p < 0.001.
    """

    preset: str
    generation: int
    simulations: float
    minutes: float
    means: tuple[float, ...]
    beats: dict[str, int]


def evolve_all(
    directory: Path,
    scenario: Scenario,
    presets: Sequence[str],
    runs: int,
    generations: int,
    evaluations: int | None = None,
    workers: int | None = None,
) -> None:
    """Run, resume or extend what is not finished, seed after seed."""
    for seed in range(1, runs + 1):
        for preset in presets:
            place = _place(directory, preset, seed)
            if (place / "run.db").exists():
                run = EvolutionRun.resume(place)
                if generations > run.settings.generations:
                    run.extend(generations)
            else:
                given = {} if evaluations is None else {"evaluations": evaluations}
                settings = preset_for(scenario, preset, generations=generations, **given)
                run = EvolutionRun.create(RunConfig(scenario, settings, seed), place)
            try:
                run.run(workers)
            finally:
                run.close()
            print(f"{place}: {generations} generations", file=sys.stderr, flush=True)


def standings(
    directory: Path,
    scenario: Scenario,
    presets: Sequence[str],
    runs: int,
    rivals: Mapping[str, Evaluation],
    marks: Sequence[int] = MARKS,
    workers: int | None = None,
) -> Iterator[Standing]:
    """Judge the best of all runs at all marks that every run of a preset has reached.

    Args:
        directory: Where the runs are.
        scenario: Theirs.
        presets: Theirs.
        runs: Seeds from 1 to this.
        rivals: By name, as `judged` runs them.
        marks: Generations.
        workers: Threads; None for one per core.
    """
    for preset in presets:
        places = [_place(directory, preset, seed) for seed in range(1, runs + 1)]
        for mark in marks:
            found = [_found(place, mark) for place in places]
            if None in found:
                break
            best, spent, minutes = zip(*(one for one in found if one is not None), strict=True)
            evaluations = judged(best, scenario, workers)
            beats = {
                name: sum(_beats(evaluation, rival) for evaluation in evaluations)
                for name, rival in rivals.items()
            }
            means = tuple(one.mean for one in evaluations)
            yield Standing(
                preset, mark, float(np.mean(spent)), float(np.mean(minutes)), means, beats
            )


def markdown(rows: Sequence[Standing], rivals: Mapping[str, Evaluation]) -> str:
    """The table as the README shows it."""
    heads = [f"beats {name} ({shown(rival.mean)})" for name, rival in rivals.items()]
    fixed = ("preset", "generations", "simulations", "minutes", "mean of the best", "least", "most")
    lines = [
        f"| {' | '.join([*fixed, *heads])} |",
        f"| --- |{' ---: |' * (len(fixed) - 1 + len(heads))}",
    ]
    for row in rows:
        values = [float(np.mean(row.means)), min(row.means), max(row.means)]
        beats = [f"{row.beats[name]} of {len(row.means)}" for name in rivals]
        cells = [f"{row.simulations:,.0f}", f"{row.minutes:.1f}", *map(shown, values), *beats]
        lines.append(f"| `{row.preset}` | {row.generation} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Evolve, judge and print the table; returns the exit status."""
    parser = argparse.ArgumentParser(prog="presets_table", description=__doc__)
    parser.add_argument("directory", type=Path, help="where the runs are kept")
    parser.add_argument("--presets", nargs="+", default=list(PRESETS), choices=list(PRESETS))
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--generations", type=int, default=MARKS[-1])
    parser.add_argument("--evaluations", type=int, help="default: what the scenario asks for")
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--rivals", nargs="+", default=list(RIVALS), metavar="RULES")
    parser.add_argument("--marks", nargs="+", type=int, default=list(MARKS), metavar="GENERATION")
    parser.add_argument("--workers", type=int)
    options = parser.parse_args(arguments)
    try:
        scenario = load_scenario(options.scenario)
        known = vocabulary_of(scenario)
        named: dict[str, Runnable] = {}
        for each in find_controllers(options.rivals):
            named |= each.read(known, options.scenario)
        require_runnable(named, parts_of(scenario))
    except (ScenarioError, RuleSetError, AutoMoDeError, ControllerError) as error:
        parser.error(str(error))
    common = options.directory, scenario, options.presets, options.runs
    evolve_all(*common, options.generations, options.evaluations, options.workers)
    evaluations = judged(list(named.values()), scenario, options.workers)
    rivals = dict(zip(named, evaluations, strict=True))
    print(markdown(list(standings(*common, rivals, options.marks, options.workers)), rivals))
    return 0


def _place(directory: Path, preset: str, seed: int) -> Path:
    return directory / f"{preset}-{seed}"


def _found(place: Path, generation: int) -> tuple[RuleSet, int, float] | None:
    """A run's best rules after a generation, simulations and minutes; None if it is not there."""
    with RunStore.open(place, read_only=True) as store:
        best = store.best(generation)
        config = RunConfig.from_yaml(store.config)
        history = store.history()[:generation]
    if best is None or len(history) < generation:
        return None
    settings = config.settings
    bred = sum(settings.population - record.invalid for record in history)
    again = settings.elites * (generation - 1) if settings.reevaluate_elites else 0
    minutes = sum(record.seconds for record in history) / 60
    rules = config.composition.rule_set(best.phenotype)
    return rules, settings.evaluations * (bred + again), minutes


def judged(
    controllers: Sequence[Runnable], scenario: Scenario, workers: int | None = None
) -> list[Evaluation]:
    """Runs of what is to be compared, with random numbers that no evolution has seen."""
    return evaluate_rule_sets(controllers, scenario, JUDGING_RUNS, JUDGING_SEED, workers)


def _beats(evaluation: Evaluation, rival: Evaluation) -> bool:
    return compare(evaluation.gains, rival.gains).winner == 1


if __name__ == "__main__":
    sys.exit(main())
