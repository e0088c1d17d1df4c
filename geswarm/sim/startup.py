"""Compiling the simulator ahead of its first use, and saying so."""

from __future__ import annotations

import contextlib
import platform
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import numba

from geswarm.rules import ControlTable, RuleSet
from geswarm.sim import compiled
from geswarm.sim.batch import evaluate
from geswarm.sim.kernels.jit import vector_settings
from geswarm.sim.scenario import load_scenario
from geswarm.sim.world import World

COMPILING = "Compiling the simulator for this machine, once: about 15 s …"


def is_compiled() -> bool:
    """Whether `warm_up` has compiled this version on this machine before, and the cache is there.

    Without a cache that can be written, everything is compiled in each process: False.
    """
    return _mark().exists()


def warm_up(announce: Callable[[str], None] | None = None) -> None:
    """Compile everything, or load it if it has been compiled before (a fraction of a second).

    Args:
        announce: Called with a message if compiling is going to take time; None writes it to
            stderr.
    """
    if not is_compiled():
        (announce or _to_stderr)(COMPILING)
    small = load_scenario("paper").with_changes(duration=0.1)
    large = small.with_changes(robots=100, width=10.0)
    table = ControlTable.compile(RuleSet())
    for scenario in (small, large):
        evaluate([table], scenario, [(0, 0, 0, 0)], workers=1)
    World(small, RuleSet()).step()
    with contextlib.suppress(OSError):  # no place for a cache: the message comes each time
        _mark().touch()


def _to_stderr(message: str) -> None:
    print(message, file=sys.stderr, flush=True)


def _mark() -> Path:
    """A file beside numba's cache that says what has been compiled, for what."""
    machine = (platform.python_version(), numba.__version__, *vector_settings())
    key = zlib.crc32("|".join(machine).encode(), compiled.VERSION)
    return Path(compiled.run_lanes.stats.cache_path) / f"compiled-{key:08x}"
