"""How many threads are of use."""

from __future__ import annotations

import math
import os
from pathlib import Path

_QUOTA = Path("/sys/fs/cgroup/cpu.max")
"""Of a container on Linux: microseconds of processor time (or max) in so many microseconds."""


def available_cores() -> int:
    """The number of processor cores that this process may use: of a job or a container, its own."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    try:
        quota, period = map(int, _QUOTA.read_text(encoding="ascii").split())
    except (OSError, ValueError):
        return cores
    return min(cores, max(1, math.ceil(quota / period)))
