"""Compiling the simulator ahead of its first use, and saying so."""

from __future__ import annotations

import contextlib
import os
import platform
import subprocess  # nosec B404
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import numba

from geswarm.rules import RuleSet
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import compiled
from geswarm.sim.assembly.kernel import source_of
from geswarm.sim.assembly.source import Layout
from geswarm.sim.batch import evaluate
from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.cores import available_cores
from geswarm.sim.kernels import cache
from geswarm.sim.kernels.jit import vector_settings
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario, load_scenario
from geswarm.sim.world import World

COMPILING = "Compiling the simulator for this machine, once: about 25 s …"
COMPILING_EACH_TIME = "Compiling the simulator for this machine, each time: about 25 s …"
NOT_KEPT = (
    "The compiled simulator cannot be kept ({trouble}), so it compiles each time; "
    "NUMBA_CACHE_DIR can name another folder for it"
)


def is_compiled(scenario: Scenario | None = None) -> bool:
    """Whether `warm_up` has compiled this version on this machine before, and the cache is there.

    A scenario of the same terms and the same form of arena is as good; None is `paper`.

    Without a folder that can be written, everything is compiled in each process: False.
    """
    return os.path.exists(_mark(scenario))  # noqa: PTH110, unlike Path's it is no error in a locked folder


def warm_up(
    announce: Callable[[str], None] | None = None, scenario: Scenario | None = None
) -> None:
    """Compile everything, or load it if it has been compiled before (a fraction of a second).

    Args:
        announce: Called with a message if compiling is going to take time, and with another one
            if it will again the next time; None writes them to stderr.
        scenario: For which; None for `paper`.
    """
    announce = announce or _to_stderr
    compiled_before = is_compiled(scenario)
    if not compiled_before:
        announce(COMPILING if cache.trouble() is None else COMPILING_EACH_TIME)
    helper = None if compiled_before else _compile_beside()
    small = (scenario or load_scenario("paper")).with_changes(duration=CONTROL_STEP)
    World(small, RuleSet()).step()
    if helper is not None:
        helper.wait()
    evaluate([RuleSet()], small, [(0, 0, 0, 0)], workers=1)
    if not compiled_before:
        _remember(announce, scenario)


def compile_tables() -> None:
    """Compile what makes control tables, which takes half of the time."""
    scenario = load_scenario("paper")
    parts = parts_of(scenario)
    compile_controllers([RuleSet()], fails(scenario, parts), parts)


def _compile_beside() -> subprocess.Popen[bytes] | None:
    """Another process that does that, if there is a core for it and a place to keep the code."""
    if cache.trouble() is not None or available_cores() < 2 or not sys.executable:
        return None
    command = f"from {__name__} import compile_tables; compile_tables()"
    nowhere = subprocess.DEVNULL
    with contextlib.suppress(OSError):
        return subprocess.Popen(
            [sys.executable, "-c", command], stdin=nowhere, stdout=nowhere, stderr=nowhere
        )
    return None


def _remember(announce: Callable[[str], None], scenario: Scenario | None) -> None:
    """Leave a mark that everything has been compiled and kept, or say why it is not."""
    trouble = cache.trouble()
    if trouble is None:
        with contextlib.suppress(OSError):
            _mark(scenario).touch()
    else:
        announce(NOT_KEPT.format(trouble=trouble))


def _to_stderr(message: str) -> None:
    print(message, file=sys.stderr, flush=True)


def _mark(scenario: Scenario | None = None) -> Path:
    """A file beside the compiled code that says what has been compiled, for what."""
    parts = parts_of(scenario or load_scenario("paper"))
    text, _ = source_of(parts, Layout(swarm=True, rules=True))
    machine = (platform.python_version(), numba.__version__, *vector_settings(), text)
    key = zlib.crc32("|".join(machine).encode(), compiled.VERSION)
    return cache.folder() / f"compiled-{key:08x}"
