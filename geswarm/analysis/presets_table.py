"""How fast the presets of the evolutionary algorithm find good rules: the README's table.

    python -m geswarm.analysis.presets_table runs/presets --runs 10 --generations 1000

Each run lies in its own directory below the given one. The command may be stopped at any time;
called again it goes on where it stopped, and what is done is not done again.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geswarm.analysis.statistics import compare
from geswarm.evaluation import Evaluation, evaluate_rule_sets
from geswarm.evolution import EvolutionRun, RunConfig
from geswarm.ge import PRESETS, RunStore, Settings
from geswarm.rules import RuleSet, load_preset
from geswarm.sim import Scenario, load_scenario

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
        means: Mean fitness of each run's best, 50 simulations each.
        beats: For each rival, how many of them collect more, p < 0.001.
    """

    preset: str
    generation: int
    simulations: float
    means: tuple[float, ...]
    beats: dict[str, int]


def evolve_all(
    directory: Path,
    scenario: Scenario,
    presets: Sequence[str],
    runs: int,
    generations: int,
    workers: int | None = None,
) -> None:
    """Run or resume what is not finished, seed after seed."""
    for seed in range(1, runs + 1):
        for preset in presets:
            place = _place(directory, preset, seed)
            if (place / "run.db").exists():
                run = EvolutionRun.resume(place)
            else:
                settings = Settings.preset(preset, generations=generations)
                run = EvolutionRun.create(RunConfig(scenario, settings, seed), place)
            try:
                run.run(workers)
            finally:
                run.close()


def standings(
    directory: Path,
    scenario: Scenario,
    presets: Sequence[str],
    runs: int,
    workers: int | None = None,
) -> Iterator[Standing]:
    """Judge the best of all runs at all marks that every run of a preset has reached."""
    rivals = _judge([load_preset(name) for name in RIVALS], scenario, workers)
    for preset in presets:
        places = [_place(directory, preset, seed) for seed in range(1, runs + 1)]
        for mark in MARKS:
            found = [_found(place, mark) for place in places]
            if None in found:
                break
            best, spent = zip(*(one for one in found if one is not None), strict=True)
            judged = _judge(best, scenario, workers)
            beats = {
                name: sum(_beats(evaluation, rival) for evaluation in judged)
                for name, rival in zip(RIVALS, rivals, strict=True)
            }
            means = tuple(one.mean for one in judged)
            yield Standing(preset, mark, float(np.mean(spent)), means, beats)


def markdown(rows: Sequence[Standing]) -> str:
    """The table as the README shows it."""
    lines = [
        "| preset | generations | simulations | mean of the best | least | most "
        "| beats hand-coded | beats EVO 8 |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for row in rows:
        of = f"of {len(row.means)}"
        lines.append(
            f"| `{row.preset}` | {row.generation} | {row.simulations:,.0f} "
            f"| {np.mean(row.means):.1f} | {min(row.means):.1f} | {max(row.means):.1f} "
            f"| {row.beats['hand-coded']} {of} | {row.beats['evo8']} {of} |"
        )
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Evolve, judge and print the table; returns the exit status."""
    parser = argparse.ArgumentParser(prog="presets_table", description=__doc__)
    parser.add_argument("directory", type=Path, help="where the runs are kept")
    parser.add_argument("--presets", nargs="+", default=list(PRESETS), choices=list(PRESETS))
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--generations", type=int, default=MARKS[-1])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--workers", type=int)
    options = parser.parse_args(arguments)
    scenario = load_scenario(options.scenario)
    common = scenario, options.presets, options.runs
    evolve_all(options.directory, *common, options.generations, options.workers)
    print(markdown(list(standings(options.directory, *common, options.workers))))
    return 0


def _place(directory: Path, preset: str, seed: int) -> Path:
    return directory / f"{preset}-{seed}"


def _found(place: Path, generation: int) -> tuple[RuleSet, int] | None:
    """A run's best rules after a generation and the simulations; None if it is not there yet."""
    with RunStore.open(place, read_only=True) as store:
        best = store.best(generation)
        config = RunConfig.from_yaml(store.config)
        history = store.history()[:generation]
    if best is None:
        return None
    settings = config.settings
    bred = sum(settings.population - record.invalid for record in history)
    again = settings.elites * (generation - 1) if settings.reevaluate_elites else 0
    return config.composition.rule_set(best.phenotype), settings.evaluations * (bred + again)


def _judge(
    rule_sets: Sequence[RuleSet], scenario: Scenario, workers: int | None
) -> list[Evaluation]:
    return evaluate_rule_sets(rule_sets, scenario, JUDGING_RUNS, JUDGING_SEED, workers)


def _beats(evaluation: Evaluation, rival: Evaluation) -> bool:
    return compare(evaluation.gains, rival.gains).winner == 1


if __name__ == "__main__":
    sys.exit(main())
