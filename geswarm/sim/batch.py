"""Batch evaluation: many simulations to their end, by control table, on all cores."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from geswarm.rules.control_table import ControlTable
from geswarm.sim.compiled import run_simulations
from geswarm.sim.encoding import encode_scenario, encode_tables, room_for
from geswarm.sim.kernels.state import COLLECTED, LOST, PICKED
from geswarm.sim.scenario import Scenario

_CHUNK_ROBOT_STEPS = 1_000_000
"""Work between two looks at `stop`: a few hundredths of a second."""


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
    stop: Callable[[], bool] | None = None,
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
    workers = _available_cores() if workers is None else workers
    if workers < 1:
        raise ValueError(f"workers: expected at least 1, got {workers}")
    todo = _checked(simulations, len(tables))
    tallies = np.zeros((len(todo), 3), dtype=np.int64)
    if len(todo):
        physics = encode_scenario(scenario)
        upto, outcomes = encode_tables(tables)

        def run(chunk: slice) -> None:
            if stop is not None and stop():
                raise EvaluationStopped("the evaluation was stopped")
            robots, objects = room_for(scenario)
            run_simulations(
                physics,
                robots,
                objects,
                upto,
                outcomes,
                todo[chunk],
                scenario.steps,
                tallies[chunk],
            )

        _run_all(run, _chunks(len(todo), scenario.robots * scenario.steps, workers), workers)
    return BatchResult(
        collected=tallies[:, COLLECTED].copy(),
        lost=tallies[:, LOST].copy(),
        picked=tallies[:, PICKED].copy(),
    )


def _available_cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


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


def _chunks(simulations: int, robot_steps: int, workers: int) -> list[slice]:
    """Contiguous shares: small enough to stop soon and to keep all workers busy to the end."""
    size = min(_CHUNK_ROBOT_STEPS // robot_steps, -(-simulations // (4 * workers)))
    size = max(1, size)
    return [slice(first, first + size) for first in range(0, simulations, size)]


def _run_all(run: Callable[[slice], None], chunks: list[slice], workers: int) -> None:
    """Run all chunks; the first exception ends it."""
    if workers == 1 or len(chunks) == 1:
        for chunk in chunks:
            run(chunk)
        return
    pool = ThreadPoolExecutor(min(workers, len(chunks)), thread_name_prefix="geswarm-evaluate")
    try:
        futures = [pool.submit(run, chunk) for chunk in chunks]
        wait(futures, return_when=FIRST_EXCEPTION)
        for future in futures:
            if future.done():
                future.result()
    finally:
        pool.shutdown(cancel_futures=True)
