"""Evaluation on many machines: an executor on a Dask scheduler (extra `cluster`)."""

from __future__ import annotations

import pickle
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, TimeoutError
from contextlib import contextmanager
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
        say: Called, in another thread, with what keeps the work from being done: no workers, or a
            scheduler that does not answer.

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
    said, again, workers = "", 0.0, 0
    while not ended.wait(_LOOK_SECONDS):
        if not executor.is_waiting:
            continue
        before = workers
        try:
            workers = len(_workers(executor.client))
        except Exception:  # whatever a connection that is no more raises
            problem = f"the scheduler at {address} does not answer"
        else:
            some = "left" if before or "left" in said else "yet"
            problem = "" if workers else f"no workers {some} at {address}, waiting"
        now = time.monotonic()
        if problem and (problem != said or now > again) and not ended.is_set():
            say(problem)
            again = now + _AGAIN_SECONDS
        if said and not problem:
            say(f"{workers} worker{'s' * (workers > 1)} at {address}, going on")
        said = problem


def _workers(client: Any) -> dict[str, int]:
    """Addresses of the workers and their threads, as the scheduler knows them now."""
    if client.status != "running":
        raise ConnectionError(client.status)
    workers: dict[str, int] = client.sync(client.scheduler.ncores, callback_timeout=_PATIENCE)
    return workers
