"""The loop: ask, evaluate, tell, write down, until all generations are done or it is stopped."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geswarm.ge.engine import Engine
from geswarm.ge.individual import Individual
from geswarm.ge.record import GenerationRecord
from geswarm.ge.steering import Steering
from geswarm.ge.store import RunStore

Objective: TypeAlias = Callable[[int, Sequence[Individual]], Sequence[float]]
"""(generation, individuals) -> one fitness per individual, more is better."""


class Stopped(Exception):  # noqa: N818  (not an error: an objective raises it to stop early)
    """Raised by an objective that was told to stop; the generation at work is lost, no more."""


@dataclass(frozen=True)
class Result:
    """What a call of `evolve` did.

    Attributes:
        best: The best individual since the beginning of the run; None before any generation.
        records: The generations of this call, not those before a resume.
        finished: All generations are done; False if it was stopped.
    """

    best: Individual | None
    records: tuple[GenerationRecord, ...]
    finished: bool


def evolve(
    engine: Engine,
    objective: Objective,
    store: RunStore | None = None,
    on_generation: Callable[[GenerationRecord], None] | None = None,
    stop: Callable[[], bool] | None = None,
    steering: Callable[[], Iterable[Steering]] | None = None,
) -> Result:
    """Run an engine to its last generation.

    Whatever ends the loop, the engine is left after its last complete generation, and a further
    call continues from there.

    Args:
        engine: New or restored.
        objective: Evaluates the valid individuals of a generation. It may raise `Stopped`.
        store: Every generation is committed to it before `on_generation` hears of it.
        on_generation: Called after each generation, in the calling thread; while it blocks, the
            evolution pauses.
        stop: Asked before each generation, for example `threading.Event().is_set`.
        steering: Asked before each generation for what is to change from it on; applied to the
            engine and committed to the store.

    Raises:
        FitnessError: The objective gave something else than one fitness per individual.
        StoreError: A generation could not be written; those before it are safe.
    """
    records: list[GenerationRecord] = []
    while not engine.finished and not (stop and stop()):
        for change in steering() if steering else ():
            change.apply(engine)
            if store:
                store.record_steering(engine.generation + 1, change)
        began = time.perf_counter()
        try:
            asked = engine.ask()
            fitness = objective(engine.generation + 1, asked) if asked else ()
            record = engine.tell(fitness, time.perf_counter() - began)
        except Stopped:
            break
        finally:
            engine.withdraw()
        if store and engine.best:
            store.append(record, engine.best, engine.state(), engine.offspring)
        records.append(record)
        if on_generation:
            on_generation(record)
    return Result(engine.best, tuple(records), engine.finished)
