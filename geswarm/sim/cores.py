"""How many threads are of use."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_ROOT = Path("/sys/fs/cgroup")
"""Where Linux shows its control groups: containers, jobs of a cluster, limits of a user."""
_OWN = Path("/proc/self/cgroup")
"""The groups of this process, a line `number:controllers:path` each; version 2 is `0::path`."""


def available_cores() -> int:
    """The number of processor cores that this process may use: of a job or a container, its own."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    return max(1, min([cores, *map(math.ceil, _quotas())]))


def _quotas() -> Iterator[float]:
    """Cores that each group which this process is in, or a group around it, may keep busy."""
    for folder in set(_groups()):
        for read in (_quota, _quota_of_version_1):
            with suppress(OSError, ValueError, ZeroDivisionError):  # no such file, or no limit
                yield read(folder)


def _groups() -> Iterator[Path]:
    """The folders of the groups, seen by this container or not."""
    yield from (_ROOT, _ROOT / "cpu")
    try:
        lines = _OWN.read_text(encoding="utf-8", errors="surrogateescape").splitlines()
    except OSError:
        return
    for line in lines:
        _, controllers, path = line.split(":", 2)
        if not controllers:
            tops = [_ROOT]
        elif "cpu" in controllers.split(","):
            tops = [_ROOT / "cpu", _ROOT / controllers]
        else:
            continue
        for top in tops:
            group = top / path.lstrip("/")
            yield from (group, *(around for around in group.parents if around.is_relative_to(top)))


def _quota(folder: Path) -> float:
    """Microseconds of processor time, or `max`, in so many microseconds."""
    quota, period = (folder / "cpu.max").read_text(encoding="ascii").split()
    return int(quota) / int(period)


def _quota_of_version_1(folder: Path) -> float:
    quota, period = (
        int((folder / f"cpu.cfs_{name}_us").read_text(encoding="ascii"))
        for name in ("quota", "period")
    )
    if quota <= 0:
        raise ValueError("no limit")
    return quota / period
