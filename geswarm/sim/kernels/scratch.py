"""Records that a kernel has for itself, on its stack."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

_LINE = 64
"""Bytes: the longest vector, and a line of the cache."""


def _on_the_stack(_context: Any, dtype: Any) -> Any:
    """Signature and code of `on_the_stack`."""

    def generate(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        with builder.goto_entry_block():
            room = builder.alloca(context.get_data_type(dtype.dtype))
        room.align = _LINE
        return room

    return dtype.dtype(types.DType(dtype.dtype)), generate


on_the_stack: Any = intrinsic(_on_the_stack)
"""on_the_stack(dtype) is a record of a dtype, its numbers whatever they happen to be.

LLVM sees that nothing else can be in its place. So loops that write to it need no checks that no
array overlaps it, which become too many in a long loop; and since it asks for whole lines of the
cache, numbers for which there are not enough vector registers are kept in whole lines, too.
"""
