"""Compiling the simulator ahead of its first use, and saying so."""

from __future__ import annotations

import contextlib
import os
import pickle  # nosec B403
import platform
import subprocess  # nosec B404
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np

from geswarm.rules import RuleSet
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import compiled
from geswarm.sim.arena.start_places import places_of
from geswarm.sim.assembly.kernel import source_of
from geswarm.sim.assembly.source import Layout
from geswarm.sim.batch import Group, evaluate, runs_side_by_side
from geswarm.sim.controllers.encoding import fails, is_wide
from geswarm.sim.controllers.tables import compile_controllers, no_controllers
from geswarm.sim.cores import available_cores
from geswarm.sim.kernels import cache
from geswarm.sim.kernels.jit import vector_settings
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario, load_scenario
from geswarm.sim.world import World

COMPILING = "Compiling the simulator for this machine, once: about {seconds} s …"
COMPILING_EACH_TIME = "Compiling the simulator for this machine, each time: about {seconds} s …"
SECONDS, SECONDS_INTERACTIVE = 7, 12
"""With two cores; on one it takes almost twice as long."""
SECONDS_INERT, SECONDS_INERT_INTERACTIVE = 30, 60
"""The same for bodies that move and sense as the e-puck does."""
NOT_KEPT = (
    "The compiled simulator cannot be kept ({trouble}), so it compiles each time; "
    "NUMBA_CACHE_DIR can name another folder for it"
)


def is_compiled(scenario: Scenario | None = None, *, interactive: bool = False) -> bool:
    """Whether `warm_up` has compiled this version on this machine before, and the cache is there.

    A scenario of the same terms and the same form of arena is as good; None is `paper`.

    Without a folder that can be written, everything is compiled in each process: False.
    """
    mark = _mark(scenario or load_scenario("paper"), interactive)
    return os.path.exists(mark)  # noqa: PTH110, unlike Path's it is no error in a locked folder


def warm_up(
    announce: Callable[[str], None] | None = None,
    scenario: Scenario | None = None,
    *,
    interactive: bool = False,
) -> None:
    """Compile what evaluation needs, or load it if that has been done (a fraction of a second).

    Args:
        announce: Called with a message if compiling is going to take time, and with another one
            if it will again the next time; None writes them to stderr.
        scenario: For which; None for `paper`.
        interactive: Compile what a `World` needs, too.
    """
    announce = announce or _to_stderr
    scenario = scenario or load_scenario("paper")
    compiled_before = is_compiled(scenario, interactive=interactive)
    if not compiled_before:
        message = COMPILING if cache.trouble() is None else COMPILING_EACH_TIME
        seconds = (SECONDS, SECONDS_INTERACTIVE)
        if scenario.robot.is_inert:
            seconds = (SECONDS_INERT, SECONDS_INERT_INTERACTIVE)
        announce(message.format(seconds=seconds[interactive]))
    small = scenario.with_changes(duration=CONTROL_STEP)
    helper = None if compiled_before else _compile_beside(small, interactive)
    if interactive:
        World(small, RuleSet()).step()
    elif helper is not None and runs_side_by_side(small):
        Group(no_controllers(parts_of(small)), small, np.zeros((1, 4), np.int64)).run(0, 0)
    if helper is not None:
        helper.wait()
    evaluate([RuleSet()], small, [(0, 0, 0, 0)], workers=1)
    if not compiled_before:
        _remember(announce, scenario, interactive)


def compile_share(given: bytes) -> None:
    """Compile half of what there is to compile: what makes control tables, and maybe all but that.

    Args:
        given: Pickled: the scenario, and whether simulations side by side are part of this half.
    """
    scenario, with_simulations = pickle.loads(given)  # nosec B301, of `_compile_beside`
    if with_simulations:
        evaluate([RuleSet()], scenario, [(0, 0, 0, 0)], workers=1)
    else:
        parts = parts_of(scenario)
        compile_controllers([RuleSet()], fails(scenario, parts), parts)


def _compile_beside(scenario: Scenario, with_simulations: bool) -> subprocess.Popen[bytes] | None:
    """Another process that does that, if there is a core for it and a place to keep the code."""
    if cache.trouble() is not None or available_cores() < 2 or not sys.executable:
        return None
    command = f"import sys; from {__name__} import compile_share as c; c(sys.stdin.buffer.read())"
    nowhere = subprocess.DEVNULL
    with contextlib.suppress(OSError):
        helper = subprocess.Popen(
            [sys.executable, "-c", command], stdin=subprocess.PIPE, stdout=nowhere, stderr=nowhere
        )
        assert helper.stdin is not None
        with contextlib.suppress(OSError), helper.stdin:
            helper.stdin.write(pickle.dumps((scenario, with_simulations)))
        return helper
    return None


def _remember(announce: Callable[[str], None], scenario: Scenario, interactive: bool) -> None:
    """Leave marks that everything has been compiled and kept, or say why it is not."""
    trouble = cache.trouble()
    if trouble is None:
        with contextlib.suppress(OSError):
            for which in {False, interactive}:
                _mark(scenario, which).touch()
    else:
        announce(NOT_KEPT.format(trouble=trouble))


def _to_stderr(message: str) -> None:
    print(message, file=sys.stderr, flush=True)


def _mark(scenario: Scenario, interactive: bool) -> Path:
    """A file beside the compiled code that says what has been compiled, for what."""
    layout = Layout(
        swarm=not scenario.robot.is_inert and (interactive or not runs_side_by_side(scenario)),
        rules=interactive,
        wide=is_wide(scenario),
    )
    text, _ = source_of(parts_of(scenario), layout)
    limits = (
        places_of(scenario.arena, scenario.robot.radius).shapes is not None
    )  # of where robots start
    machine = (platform.python_version(), numba.__version__, *vector_settings(), str(limits), text)
    key = zlib.crc32("|".join(machine).encode(), compiled.VERSION)
    return cache.folder() / f"compiled-{key:08x}"
