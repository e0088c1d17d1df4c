"""Kernels are optimised once, as a whole: functions that only kernels call are not, on their own.

Numba makes machine code of each function that it compiles, with all that the function calls, for it
may be called from anywhere. Of functions that only kernels call nobody asks for that code, but it
takes half of the compiler's time.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from numba.core import codegen, compiler, types

_Library: Any = codegen.JITCodeLibrary
_Compiler: Any = compiler.Compiler


class _Part(_Library):  # type: ignore[misc]
    """The code of a function that only kernels call: as it was generated, to be linked."""

    def add_llvm_module(self, ll_module: Any) -> None:
        self._final_module.link_in(ll_module)

    def finalize(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, _name: str) -> int:
        """None: it is no machine code."""
        return 0

    @property
    def codegen(self) -> Any:
        return self

    def set_env(self, _name: str, _env: object) -> None:
        """What numba keeps for exceptions; kernels raise none."""

    @property
    def parts(self) -> tuple[Any, ...]:
        """What the function calls."""
        return tuple(self._linking_libraries)


class _Whole(_Library):  # type: ignore[misc]
    """The code of a kernel, with all that it calls."""

    def finalize(self) -> None:
        """Link what calls before what is called: LLVM leaves out what nobody asked for yet."""
        called: dict[Any, None] = {}

        def add(library: Any) -> None:
            if library not in called:
                for part in library.parts if isinstance(library, _Part) else ():
                    add(part)
                called[library] = None

        for each in self._linking_libraries:
            add(each)
        self._linking_libraries: list[Any] = [*reversed(called)]
        super().finalize()


class _Typing:
    """Numba's context of types, which remembers what an operation makes of operands.

    Numba tries all that the operation might mean each time it meets it, several times in a line.
    """

    def __init__(self, context: Any) -> None:
        self._context = context
        self._known: dict[Any, Any] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """The signature of a function for arguments of some types."""
        if isinstance(func, types.Type) and not isinstance(func, types.BaseFunction):
            return self._context.resolve_function_type(func, args, kws)
        call = func, tuple(args), tuple(kws.items())
        if call not in self._known:
            self._known[call] = self._context.resolve_function_type(func, args, kws)
        return self._known[call]


_remembering = cache(_Typing)


class PartCompiler(_Compiler):  # type: ignore[misc]
    """Numba's compiler for functions that only kernels call."""

    library_class: Any = _Part

    def define_pipelines(self) -> Any:
        """Numba's own passes, with another place for the code, and a memory."""
        state = self.state
        state.typingctx = _remembering(state.typingctx)
        state.library = self.library_class(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().define_pipelines()


class KernelCompiler(PartCompiler):
    """Numba's compiler for kernels."""

    library_class = _Whole
