"""How the kernels are compiled; Any, since numba's own annotations differ between versions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
from numba.core import codegen, types

from geswarm.sim.kernels.cache import KernelCache
from geswarm.sim.kernels.linking import KernelCompiler, PartCompiler

_config: Any = numba.config
_codegen: Any = codegen

if _config.DISABLE_JIT:
    raise ImportError("NUMBA_DISABLE_JIT is set, but the simulator runs only compiled: unset it")


def vector_settings() -> tuple[str, str]:
    """Name and features of the processor that kernels are compiled for."""
    name, features = _config.CPU_NAME, _config.CPU_FEATURES
    return name or "", _codegen.get_host_cpu_features() if features is None else features


def _prefer_wide_vectors() -> None:
    """Vectors of 512 bits where the processor has them: LLVM's own choice is 256.

    That choice is for programs with few vector operations, in a processor that slows down for wide
    ones; the kernels do little else and gain a quarter.
    """
    name, features = vector_settings()
    if not name and _config.CPU_FEATURES is None and "+avx512f" in features:
        _config.CPU_FEATURES = features + ",-prefer-256-bit"


_prefer_wide_vectors()

# No fastmath: rounding must not depend on how the compiler groups operations. No run-time (_nrt):
# numba would count references to every array that is passed on, with atomic operations that cost
# as much as the control step itself; so kernels cannot allocate, they get all their room.

_OPTIONS: Any = {"error_model": "numpy", "_nrt": False}

_PART: Any = {
    "no_cpython_wrapper": True, "no_cfunc_wrapper": True, "pipeline_class": PartCompiler, **_OPTIONS
}  # fmt: skip
_WHOLE: Any = {"nogil": True, "pipeline_class": KernelCompiler, **_OPTIONS}


def _general(dispatcher: Any) -> Any:
    """Of a function that is called with constants too: compiled once, not for each of them.

    A call is of the version for its types and no other. Numba would weigh all versions of the
    process, and warn of records that begin as others do (NumbaExperimentalFeatureWarning).
    """
    template = dispatcher.get_call_template

    def get_call_template(args: Any, kws: Any) -> Any:
        found, signature, args, kws = template(tuple(types.unliteral(each) for each in args), kws)
        found.cases = [each for each in found.cases if each.args == tuple(args)]
        return found, signature, args, kws

    dispatcher.get_call_template = get_call_template
    return dispatcher


def inlined(function: Callable[..., Any] | None) -> Any:
    """For functions that kernels call."""
    return _general(numba.njit(forceinline=True, **_PART)(function))


def called(function: Callable[..., Any]) -> Any:
    """The same for long ones that are called in many places, where speed is not all."""
    return _general(numba.njit(**_PART)(function))


kernel_in_memory: Any = numba.njit(**_WHOLE)
"""For functions that Python calls, where nothing can be kept."""


def kernel(function: Callable[..., Any]) -> Any:
    """For functions that Python calls: kept on disk, run without the interpreter's lock."""
    dispatcher: Any = numba.njit(**_WHOLE)(function)
    dispatcher._cache = KernelCache(function)  # as numba's `cache=True` does with its own
    return dispatcher
