"""Evaluation on many machines: an executor on a Dask scheduler (extra `cluster`)."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module

_PATIENCE = 10.0  # seconds that the scheduler has to answer


class ClusterError(RuntimeError):
    """There is no cluster to evaluate on; says why and what to do."""


@contextmanager
def cluster_executor(address: str) -> Iterator[Executor]:
    """An executor on the workers of a Dask scheduler.

    Work of a worker that is lost is given to another one. The workers need this package.

    Args:
        address: Of the scheduler, for example `tcp://10.0.0.1:8786`.

    Raises:
        ClusterError: `distributed` is not installed, or no scheduler answers there.
    """
    try:
        distributed = import_module("distributed")
    except ImportError as error:
        raise ClusterError(
            "--cluster needs Dask, which is not installed here: pip install 'geswarm[cluster]'"
        ) from error
    try:
        client = distributed.Client(address, timeout=_PATIENCE)
    except (OSError, ValueError) as error:
        raise ClusterError(
            f"{address}: expected a Dask scheduler, for example tcp://host:8786, "
            f"got no answer: {error}"
        ) from error
    with client:
        yield client.get_executor(pure=False)
