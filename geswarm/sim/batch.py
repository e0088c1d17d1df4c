"""Batch evaluation: many simulations to their end, by control table, on all cores.

Small swarms run side by side, many simulations in one call of a kernel; large ones run one by one,
with a search for neighbours that suits them. Which way is a matter of the scenario alone.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.control_table import ControlTable
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import footbot
from geswarm.sim.compiled import run_lanes, run_simulation, start_lanes, start_world
from geswarm.sim.cores import available_cores
from geswarm.sim.encoding import (
    Words,
    encode_scenario,
    encode_tables,
    in_single_precision,
    room_for,
)
from geswarm.sim.kernels.state import (
    COLLECTED,
    GROUP,
    LANES,
    LOST,
    OBJECT_LANES,
    PICKED,
    ROBOT_LANES,
)
from geswarm.sim.scenario import Scenario

_ROBOT_STEPS_PER_CALL = 2_000_000
"""Work between two looks at `stop`: up to about a tenth of a second."""
_LANES_OF_A_VECTOR = 16
_ROBOTS_SIDE_BY_SIDE, _OBJECTS_SIDE_BY_SIDE = 64, 128
"""Beyond these, comparing each robot with each robot and object takes longer than a grid."""

Stop: TypeAlias = Callable[[], bool]
Counts: TypeAlias = npt.NDArray[np.int64]
"""Shape (simulations, 3): picked, collected, lost."""


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
    """Counts of objects per simulation, int64, shape (simulations,), in the order given.

    Attributes:
        collected: Dropped inside the nest: the fitness (paper, section 3.1.2).
        lost: Dropped elsewhere.
        picked: Picked up; also counts those still carried at the end.
    """

    collected: npt.NDArray[np.int64]
    lost: npt.NDArray[np.int64]
    picked: npt.NDArray[np.int64]


def evaluate(
    tables: Sequence[ControlTable],
    scenario: Scenario,
    simulations: Sequence[Simulation] | Sequence[tuple[int, int, int, int]],
    *,
    workers: int | None = None,
    stop: Stop | None = None,
) -> BatchResult:
    """Run simulations; each result depends on its table, scenario and numbers alone.

    Args:
        tables: Control tables of the rule sets.
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
    tallies = np.zeros((len(todo), 3), dtype=np.int64)
    if len(todo):
        words = encode_tables(tables, scenario.zone_miss)
        together = runs_side_by_side(scenario)
        run_share = _run_side_by_side if together else _run_one_by_one

        def run(share: slice) -> None:
            run_share(words, scenario, todo[share], tallies[share], stop)

        _run_all(run, _shares(len(todo), workers) if together else _ones(len(todo)), workers)
    return BatchResult(
        collected=tallies[:, COLLECTED].copy(),
        lost=tallies[:, LOST].copy(),
        picked=tallies[:, PICKED].copy(),
    )


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
    turn = min(
        scenario.turn_gain * np.pi,
        2.0 * scenario.max_speed / footbot.WHEEL_BASE,
    )
    extent = max(scenario.width, scenario.length)
    advance = scenario.max_speed * CONTROL_STEP
    return bool(
        scenario.robots <= _ROBOTS_SIDE_BY_SIDE
        and scenario.objects <= _OBJECTS_SIDE_BY_SIDE
        and turn * CONTROL_STEP <= np.pi / 2.0  # for which its sine is good
        and advance >= extent / 2.0**15  # a thousand times what positions are rounded to
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
        robots: Of ROBOT_LANES, shape (robots,).
        objects: Of OBJECT_LANES, shape (objects,).
        counts: Of GROUP.
    """

    def __init__(self, words: Words, scenario: Scenario, simulations: Counts) -> None:
        """Start simulations (table, seed, individual, replicate)."""
        self.width = _LANES_OF_A_VECTOR * -(-len(simulations) // _LANES_OF_A_VECTOR)
        filled = np.pad(simulations, ((0, self.width - len(simulations)), (0, 0)), mode="edge")
        self.robots = np.zeros(scenario.robots, dtype=ROBOT_LANES)
        self.objects = np.zeros(scenario.objects, dtype=OBJECT_LANES)
        self.counts = np.zeros(1, dtype=GROUP)[0]
        self.counts["table"][: self.width] = filled[:, 0] * words.words[0].size
        self.counts["slot_bits"][: self.width] = words.slot_bits[filled[:, 0]]
        self._words = words
        physics = encode_scenario(scenario)
        self._physics = in_single_precision(physics)
        room = room_for(scenario)
        start_lanes(physics, *room[:4], filled, self.robots, self.objects)

    def run(self, first: int, steps: int) -> None:
        """Run control steps first..first+steps-1."""
        words = self._words.words.reshape(-1)
        run_lanes(
            self._physics,
            self.robots,
            self.objects,
            self.counts,
            words,
            self._words.row_bits,
            self.width,
            first,
            steps,
        )


def _run_side_by_side(
    words: Words, scenario: Scenario, simulations: Counts, tallies: Counts, stop: Stop | None
) -> None:
    """Run at most LANES simulations."""
    group = Group(words, scenario, simulations)
    for first, steps in _segments(scenario, group.width, stop):
        group.run(first, steps)
    for position, name in ((PICKED, "picked"), (COLLECTED, "collected"), (LOST, "lost")):
        tallies[:, position] = group.counts[name][: len(tallies)]


def _run_one_by_one(
    words: Words, scenario: Scenario, simulations: Counts, tallies: Counts, stop: Stop | None
) -> None:
    """Run simulations one after the other."""
    physics = encode_scenario(scenario)
    room = room_for(scenario)
    for (table, *key), tally in zip(simulations.tolist(), tallies, strict=True):
        start_world(physics, *room[:4], *key)
        of_table, slot_bits = words.words[table], int(words.slot_bits[table])
        for first, steps in _segments(scenario, 1, stop):
            run_simulation(physics, *room, tally, of_table, slot_bits, first, steps)


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
