"""Whether e-pucks do here what they do in AutoMoDe's own stack: a table of one and the other.

    python -m geswarm.analysis.epuck_agreement reference.json --runs 128

The file holds runs of that stack (ARGoS 3.0.0-beta48, argos3-epuck 48, reference model 1.2):
{"cases": [{"mission", "controller", "machine", "parameters", "objective", "statistics"}, ...]},
with a number for each run in `objective`, and [mean, deviation] over runs in `statistics`, of
`state_occupancy` one for each state. Figures agree if they differ by at most a tenth, or by two
standard errors of both.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats

from geswarm.analysis.epuck_statistics import figures_of
from geswarm.automode import AutoMoDeError, Machine, read_machines
from geswarm.evaluation import shown
from geswarm.sim import Scenario, load_scenario

MISSIONS = {
    "aac": "epuck-aac",
    "aac-arena": "epuck-aac",
    "aggregation": "epuck-aggregation",
    "homing": "epuck-homing",
    "xor": "epuck-xor",
}
"""Names there of scenarios that have another one here."""
PSEUDO_REALITY = ", pseudo-reality"
_OF_PSEUDO_REALITY = {"loss": 0.9, "wheels": 0.15, "lightnoise": 0.9}
_NUMBERS = {
    "loss": "rab_loss",
    "wheels": "wheel_noise",
    "prox": "proximity_noise",
    "lightnoise": "light_noise",
    "ground": "ground_noise",
}
COMPARED = ("black", "white", "nn", "speed", "still", "turn_rate")
"""Statistics that are compared, beside the time in each state."""
_TENTH, _ERRORS = 0.1, 2.0
_ROUNDING = 5e-5
"""Statistics come with four digits behind the point."""
_RANKED = 3
"""From so many machines of a mission on, their order is compared."""
_COPIES = 2000


@dataclass(frozen=True)
class Figure:
    """One number of a case, there and here.

    Attributes:
        name: `objective`, a statistic, or `state 2`.
        there: Mean of the real stack's runs.
        here: Mean of ours.
        error: Standard error of their difference.
    """

    name: str
    there: float
    here: float
    error: float

    @property
    def z(self) -> float:
        """The difference in standard errors."""
        return (self.here - self.there) / self.error if self.error else 0.0

    @property
    def agrees(self) -> bool:
        """Whether they differ by at most a tenth, or by two standard errors."""
        bound = max(_TENTH * abs(self.there), _ERRORS * self.error) + _ROUNDING
        return abs(self.here - self.there) <= bound


@dataclass(frozen=True)
class Case:
    """A machine in a mission, run there.

    Attributes:
        mission: As the file names it.
        controller: What the machine is called.
        machine: The machine.
        scenario: What it runs in here.
        objective: The value of each run there.
        statistics: [mean, deviation] over runs, or one for each state.
    """

    mission: str
    controller: str
    machine: Machine
    scenario: Scenario
    objective: npt.NDArray[np.float64]
    statistics: Mapping[str, Any]

    @staticmethod
    def of(given: Mapping[str, Any]) -> Case:
        """A case of the file."""
        (machine,) = read_machines(given["machine"], given["controller"])
        objective = np.array(given["objective"], dtype=np.float64)
        scenario = scenario_of(given["mission"], given["parameters"])
        names = (given["mission"], given["controller"])
        return Case(*names, machine, scenario, objective, given["statistics"])

    def compared(self, runs: int, seed: int) -> list[Figure]:
        """The objective, and each statistic that both sides have."""
        found = figures_of(self.machine, self.scenario, runs, seed)
        there = {"objective": (float(self.objective.mean()), float(self.objective.std(ddof=1)))}
        there |= {name: self.statistics[name] for name in COMPARED if name in self.statistics}
        occupied = self.statistics.get("state_occupancy", ())[: len(self.machine.states)]
        there |= {f"state {at}": each for at, each in enumerate(occupied)}
        return [
            Figure(name, mean, float(here.mean()), self._error(deviation, here))
            for name, (mean, deviation) in there.items()
            if (here := found.get(name)) is not None
        ]

    def _error(self, deviation: float, here: npt.NDArray[np.float64]) -> float:
        return math.hypot(
            deviation / math.sqrt(len(self.objective)), here.std(ddof=1) / math.sqrt(len(here))
        )


def scenario_of(mission: str, parameters: Mapping[str, Any]) -> Scenario:
    """The scenario of a case.

    Args:
        mission: Its name, `, pseudo-reality` behind it for that noise.
        parameters: seconds, robots, rab (m), light ([x, y, height, intensity] or intensity), and
            loss, wheels, prox, lightnoise, ground (noise).

    Raises:
        ScenarioError: There is no such mission.
    """
    name = mission.removesuffix(PSEUDO_REALITY)
    scenario = load_scenario(MISSIONS.get(name, name))
    given = {**(_OF_PSEUDO_REALITY if mission != name else {}), **parameters}
    arena = scenario.arena
    if "light" in given:
        lights = [_light(given["light"], each) for each in arena.lights]
        arena = replace(arena, lights=tuple(each for each in lights if each.intensity > 0.0))
    changed = {known: float(given[key]) for key, known in _NUMBERS.items() if key in given}
    return scenario.with_changes(
        arena=arena,
        robots=given["robots"],
        duration=float(given["seconds"]),
        rab_range=given["rab"],
        numbers=tuple({**dict(scenario.numbers), **changed}.items()),
    )


def _light(given: float | Sequence[float], known: Any) -> Any:
    if isinstance(given, Sequence):
        x, y, height, intensity = map(float, given)
        return replace(known, x=x, y=y, height=height, intensity=intensity)
    return replace(known, intensity=float(given))


def ranks(cases: Sequence[Case], here: Sequence[float]) -> Iterator[tuple[str, int, float, float]]:
    """Of each mission with enough machines: Spearman's correlation, there to here.

    Args:
        cases: All cases.
        here: The mean objective of each.

    Yields:
        Mission, machines, correlation, and what two copies of the real stack with as many runs
        have between them on average.
    """
    rng = np.random.default_rng(0)
    for mission in dict.fromkeys(case.mission for case in cases):
        which = [at for at, case in enumerate(cases) if case.mission == mission]
        if len(which) < _RANKED:
            continue
        runs = [cases[at].objective for at in which]
        means = np.array([each.mean() for each in runs])
        errors = np.array([each.std(ddof=1) / math.sqrt(len(each)) for each in runs])
        copies = rng.normal(means, errors, (2, _COPIES, len(means)))
        between = [stats.spearmanr(*pair).statistic for pair in zip(*copies, strict=True)]
        alike = float(np.mean(between))
        found = stats.spearmanr(means, [here[at] for at in which]).statistic
        yield mission, len(which), float(found), alike


def markdown(cases: Sequence[Case], found: Sequence[Sequence[Figure]]) -> str:
    """The tables: objectives, statistics that miss, order of the machines."""
    lines = ["| mission | machine | there | here | difference | z | agrees |"]
    lines += ["| --- | --- | ---: | ---: | ---: | ---: | --- |"]
    for case, (objective, *_) in zip(cases, found, strict=True):
        lines.append(f"| {case.mission} | {case.controller} | {_cells(objective)} |")
    of_cases = [figures[0].agrees for figures in found]
    lines += ["", f"{sum(of_cases)} of {len(cases)} objectives agree.", ""]
    others = [
        (case, figure) for case, (_, *more) in zip(cases, found, strict=True) for figure in more
    ]
    missed = [(case, figure) for case, figure in others if not figure.agrees]
    lines.append(
        f"{len(others) - len(missed)} of {len(others)} statistics agree; those that do not:"
    )
    lines += ["", "| mission | machine | statistic | there | here | difference | z | agrees |"]
    lines.append("| --- | --- | --- | ---: | ---: | ---: | ---: | --- |")
    for case, figure in missed:
        lines.append(f"| {case.mission} | {case.controller} | {figure.name} | {_cells(figure)} |")
    lines += ["", "| mission | machines | rank correlation | of two copies of the real stack |"]
    lines.append("| --- | ---: | ---: | ---: |")
    for mission, number, rank, alike in ranks(cases, [figures[0].here for figures in found]):
        lines.append(f"| {mission} | {number} | {rank:.2f} | {alike:.2f} |")
    return "\n".join(lines)


def _cells(figure: Figure) -> str:
    there, here = shown(figure.there), shown(figure.here)
    part = 100.0 * (figure.here - figure.there) / abs(figure.there) if figure.there else 0.0
    said = "yes" if figure.agrees else "no"
    return f"{there} | {here} | {part:+.1f} % | {figure.z:+.1f} | {said}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all cases and print the tables; returns the exit status."""
    parser = argparse.ArgumentParser(prog="epuck_agreement", description=__doc__)
    parser.add_argument("file", type=Path, help="runs of the real stack, JSON")
    parser.add_argument("--runs", type=int, default=128)
    parser.add_argument("--seed", type=int, default=7)
    options = parser.parse_args(arguments)
    try:
        document = json.loads(options.file.read_text(encoding="utf-8"))
        cases = [Case.of(each) for each in document["cases"]]
    except (OSError, KeyError, TypeError, ValueError, AutoMoDeError) as error:
        parser.error(f"{options.file}: {type(error).__name__}: {error}")
    found = []
    for case in cases:
        found.append(case.compared(options.runs, options.seed))
        print(f"{case.mission}: {case.controller}", file=sys.stderr, flush=True)
    print(markdown(cases, found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
