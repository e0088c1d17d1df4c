"""Assembled source -> module, kept on disk beside what numba compiles of it.

A module's name holds the checksum of its text, of the files of its components and of all that
kernels call, and so does its first line. So the cache, which knows a function by its file, finds it
again in the next process, and never finds one that was compiled of something else.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import sys
import types
from collections.abc import Iterable
from pathlib import Path

import geswarm.sim.kernels
from geswarm.drafts import draft_of
from geswarm.sim.kernels import cache


def load(name: str, text: str, modules: Iterable[str]) -> types.ModuleType:
    """The module with this text; in memory only where no file can be written.

    Args:
        name: Beginning of its name.
        text: Its source.
        modules: The modules in which its components are written.
    """
    checksum = _checksum(text, modules)
    module_name = f"{name}_{checksum}"
    text = f"# Assembled of sources with the checksum {checksum}.\n{text}"
    path = cache.folder() / f"{module_name}.py"
    if not _is_kept(path, text):
        return _in_memory(module_name, text)
    spec = importlib.util.spec_from_file_location(module_name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[module_name] = module  # numba looks there for what it loads from its cache
    spec.loader.exec_module(module)
    return module


def _checksum(text: str, modules: Iterable[str]) -> str:
    """Of a module's text and of the sources of everything that it calls."""
    files = {Path(str(sys.modules[name].__file__)) for name in modules}
    files |= set(Path(str(geswarm.sim.kernels.__file__)).parent.glob("*.py"))
    checksum = hashlib.sha256(text.encode())
    for file in sorted(files):
        checksum.update(file.read_bytes())
    return checksum.hexdigest()[:16]


def _is_kept(path: Path, text: str) -> bool:
    """Whether a file holds this text; it is written if it does not, or is damaged.

    One that holds it is left alone: the cache takes a file that was written again for another one.
    """
    with contextlib.suppress(OSError, UnicodeDecodeError):
        if path.read_text(encoding="utf-8") == text:
            return True
    try:
        with draft_of(path) as draft:
            draft.write_text(text, encoding="utf-8")
    except OSError:
        return False
    return True


def _in_memory(name: str, text: str) -> types.ModuleType:
    """The module without a file; its kernel is compiled in each process."""
    module = types.ModuleType(name)
    sys.modules[name] = module
    in_memory = text.replace("jit import kernel\n", "jit import kernel_in_memory as kernel\n")
    exec(compile(in_memory, f"<{name}>", "exec"), vars(module))
    return module
