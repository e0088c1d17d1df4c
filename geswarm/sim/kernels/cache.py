"""Where compiled kernels are kept, so that they are compiled once and not by each process.

One file per kernel, processor and version, whose name says which. Unlike numba's own cache, trouble
is no error: what cannot be read, or is damaged, is compiled anew; what cannot be written is not
kept, and `trouble` says why.
"""

from __future__ import annotations

import functools
import pickle  # nosec B403
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import numba
from numba.core import caching, compiler, serialize
from numba.misc.appdirs import AppDirs

from geswarm.drafts import draft_of

_config: Any = numba.config
_caching: Any = caching
_compiler: Any = compiler
_CHECKSUM = 4  # bytes before the code

_not_kept: list[str] = []


@functools.cache
def folder() -> Path:
    """The folder of compiled code: the first of three in which files can be made.

    They are NUMBA_CACHE_DIR, beside the kernels, and the user's cache. If nothing can be written
    anywhere it is the first one all the same, which may hold what somebody else compiled.
    """
    return next(filter(_can_be_written, _folders()), next(_folders()))


def trouble() -> str | None:
    """Why compiled code is not kept, None if it is (as far as is known before it is written)."""
    if _not_kept:
        return _not_kept[-1]
    if _can_be_written(folder()):
        return None
    return f"there is no folder that can be written, neither {' nor '.join(map(str, _folders()))}"


def _folders() -> Iterator[Path]:
    """Where compiled code may be, best first; what the user said comes first."""
    of_these_sources = _caching._CacheLocator.get_suitable_cache_subpath(__file__)
    if _config.CACHE_DIR:
        yield Path(_config.CACHE_DIR) / of_these_sources
    yield Path(__file__).parent / "__pycache__"
    of_the_user = Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)
    if of_the_user.is_absolute():  # else there is no home
        yield of_the_user / of_these_sources


def _can_be_written(place: Path) -> bool:
    try:
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place):
            return True
    except OSError:
        return False


class KernelCache(_caching._Cache):  # type: ignore[misc]
    """The compiled code of one function, for numba's dispatcher."""

    def __init__(self, function: Callable[..., Any]) -> None:
        """Of a function whose source is in a file, with constants in its closure."""
        source = zlib.crc32(Path(function.__code__.co_filename).read_bytes())
        constants = [cell.cell_contents for cell in function.__closure__ or ()]
        self._name = function.__name__
        self._source = (function.__qualname__, source, constants)

    @property
    def cache_path(self) -> str:
        """The folder."""
        return str(folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was compiled before for this signature, or None: nothing, or it is damaged."""
        target_context.refresh()
        try:
            kept = self._file(sig, target_context.codegen()).read_bytes()
            checksum, code = kept[:_CHECKSUM], kept[_CHECKSUM:]
            if checksum != _checksum(code):
                return None
            parts = pickle.loads(code)  # nosec B301, of a folder of whoever installed or uses this
            return _compiler.CompileResult._rebuild(target_context, *parts)
        except Exception:  # a file of something else may raise anything
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled; if that is impossible, `trouble` says why."""
        if data.library.has_dynamic_globals:  # addresses, which no other process has
            raise ValueError(f"{self._name}: pointers and large global arrays cannot be kept")
        code = serialize.dumps(data._reduce())
        path = self._file(sig, data.codegen)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with draft_of(path) as draft:
                draft.write_bytes(_checksum(code) + code)
        except OSError as error:
            _not_kept.append(f"{path.parent}: {error.strerror}")

    def enable(self) -> None:
        """It always is."""

    disable = enable

    def flush(self) -> None:
        """Forget what was compiled."""
        for file in folder().glob(f"{self._name}-*.code"):
            file.unlink(missing_ok=True)

    def _file(self, sig: Any, codegen: Any) -> Path:
        """For what machine and signature, and from which source."""
        machine = (sys.version, numba.__version__, codegen.magic_tuple())
        what = sha256(repr((machine, str(sig), self._source)).encode()).hexdigest()
        return folder() / f"{self._name}-{what[:16]}.code"


def _checksum(code: bytes) -> bytes:
    return zlib.crc32(code).to_bytes(_CHECKSUM, "big")
