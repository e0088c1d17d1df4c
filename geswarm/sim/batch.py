"""Batch evaluation: many simulations to their end, by control table, on all cores.

Small swarms run side by side, many simulations in one call of a kernel; large ones run one by one,
with a search for neighbours that suits them. Which way is a matter of the scenario alone.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.automode import Machine, Tree
from geswarm.rules.findings import RuleSetError
from geswarm.rules.model import RuleSet
from geswarm.sim.assembly.kernel import assemble
from geswarm.sim.assembly.records import OBJECT, Records, robot_type, room
from geswarm.sim.assembly.source import Layout
from geswarm.sim.controllers.encoding import fails, fill_robots, is_wide, numbers_by_name
from geswarm.sim.controllers.program import Instances
from geswarm.sim.controllers.starting import start_of
from geswarm.sim.controllers.tables import Controller, Controllers, compile_controllers
from geswarm.sim.cores import available_cores
from geswarm.sim.kernels.state import LANES
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.scenario.objective import OF_THE_RUN
from geswarm.sim.swarm import Swarm

_ROBOT_STEPS_PER_CALL = 2_000_000
"""Work between two looks at `stop`: up to about a tenth of a second."""
_LANES_OF_A_VECTOR = 16
_ROBOTS_SIDE_BY_SIDE, _OBJECTS_SIDE_BY_SIDE = 64, 128
"""Beyond these, comparing each robot with each robot and object takes longer than a grid."""

Stop: TypeAlias = Callable[[], bool]
Simulations: TypeAlias = npt.NDArray[np.int64]
"""Table, seed, individual, replicate; shape (simulations, 4)."""
Values: TypeAlias = npt.NDArray[np.float64]


class Simulation(NamedTuple):
    """One run: which table, and the numbers that key its random numbers (all at least 0)."""

    table: int
    seed: int
    individual: int = 0
    replicate: int = 0


class EvaluationStopped(Exception):  # noqa: N818, it is not an error
    """An evaluation was stopped before its end; it has no result."""


@dataclass(frozen=True)
class BatchResult:
    """What came of simulations, in the order given.

    Attributes:
        fitness: Value of the scenario's objective, float64, shape (simulations,).
        measures: Each measure by name, float64, shape (simulations,).
    """

    fitness: Values
    measures: Mapping[str, Values]


def evaluate(
    tables: Sequence[Controller],
    scenario: Scenario,
    simulations: Sequence[Simulation] | Sequence[tuple[int, int, int, int]],
    *,
    workers: int | None = None,
    stop: Stop | None = None,
) -> BatchResult:
    """Run simulations; each result depends on its table, scenario and numbers alone.

    Args:
        tables: Rule sets, their control tables, or controllers of AutoMoDe.
        scenario: The same for all simulations.
        simulations: (table, seed, individual, replicate) each.
        workers: Number of threads; None is one per available core.
        stop: Asked now and then, for example `threading.Event().is_set`; True ends the evaluation.

    Raises:
        EvaluationStopped: `stop` returned True.
        ValueError: A simulation names a table that does not exist or has a number out of range, a
            table is for another vocabulary, or workers < 1.
    """
    workers = available_cores() if workers is None else workers
    if workers < 1:
        raise ValueError(f"workers: expected at least 1, got {workers}")
    todo = _checked(simulations, len(tables))
    parts = parts_of(scenario)
    values = np.zeros((len(todo), len(parts.measures)))
    for alike in _alike(tables):
        here = np.isin(todo[:, 0], alike)
        own = todo[here]
        own[:, 0] = np.searchsorted(alike, own[:, 0])
        if len(own):
            values[here] = _run([tables[at] for at in alike], scenario, own, workers, stop)
    measures = {each.name: values[:, at].copy() for at, each in enumerate(parts.measures)}
    return BatchResult(fitness_of(scenario, measures), measures)


def _alike(tables: Sequence[Controller]) -> list[list[int]]:
    """The numbers of tables that can be compiled together: AutoMoDe's apart from rules."""
    automata = [at for at, each in enumerate(tables) if isinstance(each, Machine | Tree)]
    return [[at for at in range(len(tables)) if at not in set(automata)], automata]


def _run(
    tables: Sequence[Controller],
    scenario: Scenario,
    todo: Simulations,
    workers: int,
    stop: Stop | None,
) -> Values:
    """What each simulation counts, shape (simulations, measures)."""
    parts = parts_of(scenario)
    values = np.zeros((len(todo), len(parts.measures)))
    controllers = compile_controllers(tables, fails(scenario, parts), parts)
    together = runs_side_by_side(scenario)
    run_share = _run_side_by_side if together else _run_one_by_one

    def run(share: slice) -> None:
        run_share(controllers, scenario, todo[share], values[share], stop)

    _run_all(run, _shares(len(todo), workers) if together else _ones(len(todo)), workers)
    return values


def can_run(rule_set: RuleSet, scenario: Scenario) -> bool:
    """Whether rules in a scenario's words are within the simulator's limits."""
    try:
        Instances.of(rule_set, parts_of(scenario))
    except RuleSetError:
        return False
    return True


def fitness_of(scenario: Scenario, measures: Mapping[str, Values | float]) -> Values:
    """The scenario's objective, of measures by name.

    Raises:
        ObjectiveError: It names something else.
    """
    known = {name: getattr(scenario, name) for name in OF_THE_RUN}
    return scenario.objective.of({**known, **measures})


def _checked(
    simulations: Sequence[Simulation] | Sequence[tuple[int, int, int, int]], tables: int
) -> npt.NDArray[np.int64]:
    """The simulations as an array of shape (simulations, 4)."""
    for number, simulation in enumerate(simulations):
        table, *key = simulation
        if not 0 <= table < tables:
            expected = f"a table from 0 to {tables - 1}"
            raise ValueError(f"simulations[{number}]: expected {expected}, got {table}")
        if len(key) != 3 or not all(0 <= part < 2**63 for part in key):
            expected = "seed, individual, replicate in [0, 2**63)"
            raise ValueError(f"simulations[{number}]: expected {expected}, got {tuple(key)}")
    return np.array(simulations, dtype=np.int64).reshape(-1, 4)


def runs_side_by_side(scenario: Scenario) -> bool:
    """Whether small swarms' way of running suits: few robots, and single precision is enough."""
    return bool(
        scenario.robots <= _ROBOTS_SIDE_BY_SIDE
        and scenario.objects <= _OBJECTS_SIDE_BY_SIDE
        and not is_wide(scenario)
    )


def _ones(simulations: int) -> list[slice]:
    return [slice(number, number + 1) for number in range(simulations)]


def _shares(simulations: int, workers: int) -> list[slice]:
    """Contiguous shares of at most LANES: as many for each worker, whole vectors but the last."""
    vectors = -(-simulations // _LANES_OF_A_VECTOR)
    per_worker = -(-vectors * _LANES_OF_A_VECTOR // (LANES * workers))
    number = min(vectors, workers * per_worker)
    ends = [_LANES_OF_A_VECTOR * (vectors * k // number) for k in range(number + 1)]
    return [slice(*pair) for pair in itertools.pairwise(ends)]


class Group:
    """Up to LANES simulations side by side; the last vector is filled with copies of the last one.

    Attributes:
        robots: Of `assembly.records.robot_type`, shape (robots,).
        objects: Of OBJECT, shape (objects,).
    """

    def __init__(
        self, controllers: Controllers, scenario: Scenario, simulations: Simulations
    ) -> None:
        """Start simulations (table, seed, individual, replicate)."""
        layout, parts = Layout(), controllers.parts
        self._arena, self._of_places = scenario.arena, parts.of_places
        self._kernel = assemble(parts, layout)
        self._numbers = numbers_by_name(scenario, self._kernel.numbers, parts)
        self.width = _LANES_OF_A_VECTOR * -(-len(simulations) // _LANES_OF_A_VECTOR)
        filled = np.pad(simulations, ((0, self.width - len(simulations)), (0, 0)), mode="edge")
        self.robots = room(scenario.robots, robot_type(parts, layout))
        self.objects = room(scenario.objects, OBJECT)
        self._controller = controllers.for_lanes(filled[:, 0])
        began = start_of(scenario, filled, parts)
        for name in ("x", "y"):
            self.objects[name][:, : self.width] = began.objects[:, :, "xy".index(name)].T
        self._fill(began.robots)

    def _fill(self, began: Records) -> None:
        lanes = np.zeros((len(self.robots), LANES), dtype=began.dtype)
        lanes[:, : self.width] = began.T
        fill_robots(self.robots, lanes)

    def run(self, first: int, steps: int) -> None:
        """Run control steps first..first+steps-1."""
        records = (self._numbers, self.robots, self.objects)
        self._kernel.run(*records, *self._controller, self.width, first, steps)

    def measured(self, name: str) -> Values:
        """A measure of each simulation, shape (LANES,)."""
        if measure := self._of_places.get(name):
            x, y = (self.robots[along][:, : self.width] for along in "xy")
            return np.pad(measure.of(x, y, self._arena), (0, LANES - self.width))
        total: Values = self.robots[name].sum(axis=0, dtype=np.float64)
        return total


def _run_side_by_side(
    controllers: Controllers,
    scenario: Scenario,
    simulations: Simulations,
    values: Values,
    stop: Stop | None,
) -> None:
    """Run at most LANES simulations."""
    group = Group(controllers, scenario, simulations)
    for first, steps in _segments(scenario, group.width, stop):
        group.run(first, steps)
    for at, measure in enumerate(controllers.parts.measures):
        values[:, at] = group.measured(measure.name)[: len(values)]


def _run_one_by_one(
    controllers: Controllers,
    scenario: Scenario,
    simulations: Simulations,
    values: Values,
    stop: Stop | None,
) -> None:
    """Run simulations one after the other."""
    swarm = Swarm(scenario, rules=False)
    for (table, *key), row in zip(simulations, values, strict=True):
        swarm.start(*key)
        controller = controllers.for_lanes(np.full(LANES, table))
        for _, steps in _segments(scenario, 1, stop):
            swarm.run(controller, steps)
        row[:] = [swarm.measured(each.name) for each in swarm.parts.measures]


def _segments(scenario: Scenario, lanes: int, stop: Stop | None) -> Iterator[tuple[int, int]]:
    """(first control step, number of steps) of each call of a kernel; asks `stop` before each."""
    length = max(1, _ROBOT_STEPS_PER_CALL // (scenario.robots * lanes))
    for first in range(0, scenario.steps, length):
        if stop is not None and stop():
            raise EvaluationStopped("the evaluation was stopped")
        yield first, min(length, scenario.steps - first)


def _run_all(run: Callable[[slice], None], shares: list[slice], workers: int) -> None:
    """Run all shares; the first exception ends it."""
    if workers == 1 or len(shares) == 1:
        for share in shares:
            run(share)
        return
    pool = ThreadPoolExecutor(min(workers, len(shares)), thread_name_prefix="geswarm-evaluate")
    try:
        futures = [pool.submit(run, share) for share in shares]
        wait(futures, return_when=FIRST_EXCEPTION)
        for future in futures:
            if future.done():
                future.result()
    finally:
        pool.shutdown(cancel_futures=True)
