"""Evaluation on many machines: an executor on a Dask scheduler (extra `cluster`)."""

from __future__ import annotations

import pickle
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, TimeoutError
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

_PATIENCE = 10.0  # seconds that the scheduler has to answer
_LOOK_SECONDS = 2.0  # between two looks at the workers
_AGAIN_SECONDS = 60.0  # until the same is said again


class ClusterError(RuntimeError):
    """There is no cluster to evaluate on; says why and what to do."""


@contextmanager
def cluster_executor(address: str, say: Callable[[str], None]) -> Iterator[Executor]:
    """An executor on the workers of a Dask scheduler.

    Work of a worker that is lost is given to another one, and workers that come late are used. The
    workers need this package.

    Args:
        address: Of the scheduler, for example `tcp://10.0.0.1:8786`.
        say: Called, in another thread, with what keeps the work from being done: no workers, none
            that takes work, or a scheduler that does not answer.

    Raises:
        ClusterError: `distributed` is not installed, or no scheduler answers there.
    """
    try:
        distributed = import_module("distributed")
    except ImportError as error:
        raise ClusterError(
            "--cluster needs Dask, which is not installed here: pip install 'geswarm[cluster]'"
        ) from error
    with _connected(distributed, address) as client:
        executor, ended = _ClusterExecutor(client), threading.Event()
        watch = threading.Thread(
            target=_watch, args=(executor, address, say, ended), name="cluster", daemon=True
        )
        watch.start()
        try:
            yield executor
        finally:
            ended.set()


def _connected(distributed: Any, address: str) -> Any:
    """A client; given up after a while, also where something listens that is no scheduler.

    Raises:
        ClusterError: No scheduler answers.
    """
    found: Future[Any] = Future()

    def connect() -> None:
        try:
            found.set_result(distributed.Client(address, timeout=_PATIENCE))
        except Exception as error:
            found.set_exception(error)

    threading.Thread(target=connect, name="cluster", daemon=True).start()
    try:
        return found.result(2 * _PATIENCE)
    except (OSError, ValueError, TimeoutError) as error:
        raise ClusterError(
            f"{address}: expected a Dask scheduler, for example tcp://host:8786, "
            f"got no answer: {str(error) or 'something else listens there'}"
        ) from error


class _ClusterExecutor(Executor):
    """A client's executor; what is submitted is pickled here and unpickled within the task.

    So a worker without this package fails at its task, where Dask's own way would end the worker
    (dask/distributed#1341), and one after the other.
    """

    def __init__(self, client: Any) -> None:
        self.client = client
        self._executor: Executor = client.get_executor(pure=False)
        self._waiting: set[Future[Any]] = set()

    @property
    def is_waiting(self) -> bool:
        """Something was submitted that is not done."""
        return bool(self._waiting)

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Have a worker call a function of a module."""
        if kwargs:
            raise TypeError("expected positional arguments only")
        future = self._executor.submit(pickle.loads, pickle.dumps(_Call(function, args)))
        self._waiting.add(future)
        future.add_done_callback(self._waiting.discard)
        return future


class _Call:
    """A call that is made when it is unpickled: what comes out is the function's result."""

    def __init__(self, function: Callable[..., Any], args: tuple[Any, ...]) -> None:
        self._call = function, args

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return self._call


def _watch(
    executor: _ClusterExecutor, address: str, say: Callable[[str], None], ended: threading.Event
) -> None:
    """Say what keeps the work from being done: soon, when it changes, and again now and then."""
    said, again, able = "", 0.0, 0
    while not ended.wait(_LOOK_SECONDS):
        if not executor.is_waiting and not said:
            continue
        before = able
        try:
            workers = _workers(executor.client)
        except Exception:  # whatever a connection that is no more raises
            problem = f"the scheduler at {address} does not answer"
        else:
            able = sum(worker.able for worker in workers)
            held_up = executor.is_waiting and not able
            some_before = bool(before) or "left" in said
            problem = _why_idle(workers, some_before, address) if held_up else ""
        now = time.monotonic()
        if problem and (problem != said or now > again) and not ended.is_set():
            say(problem)
            again = now + _AGAIN_SECONDS
        if said and not problem and able:
            say(f"{_count(able)} at {address}, going on")
        said = problem


@dataclass(frozen=True)
class _Worker:
    """A worker: what it is doing, in Dask's words, and how many tasks it takes at once."""

    status: str
    threads: int

    @property
    def able(self) -> bool:
        return self.status == "running" and self.threads > 0


def _workers(client: Any) -> list[_Worker]:
    """The workers, as the scheduler knows them now."""
    if client.status != "running":
        raise ConnectionError(client.status)
    found = client.sync(client.scheduler.identity, callback_timeout=_PATIENCE)
    return [_Worker(one["status"], one["nthreads"]) for one in found["workers"].values()]


def _why_idle(workers: list[_Worker], some_before: bool, address: str) -> str:
    """What to say of workers of which none takes work."""
    if not workers:
        return f"no workers {'left' if some_before else 'yet'} at {address}, waiting"
    reasons = Counter(one.status if one.threads > 0 else "without threads" for one in workers)
    listed = ", ".join(f"{number} {reason}" for reason, number in sorted(reasons.items()))
    return (
        f"{_count(len(workers))} at {address}, but none takes work ({listed}), waiting; "
        "Dask pauses those that run out of memory"
    )


def _count(workers: int) -> str:
    return f"{workers} worker{'s' * (workers > 1)}"
