"""How the kernels are compiled; Any, since numba's own annotations differ between versions.

No fastmath: a run is the same to the last bit, whatever the batch, thread or order.
"""

from __future__ import annotations

from typing import Any

from numba import njit

inlined: Any = njit(error_model="numpy", forceinline=True)
"""For functions that kernels call."""

kernel: Any = njit(error_model="numpy", cache=True, nogil=True)
"""For functions that Python calls: cached on disk, run without the interpreter's lock."""
