"""Own terms: a Python file beside a scenario whose sensors, behaviours and measures it offers."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
import traceback
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from types import ModuleType

from geswarm.sim.library.terms import Terms


class OwnTermsError(ValueError):
    """A file with own terms cannot be used; says file, line and why."""


@dataclass(frozen=True)
class OwnTerms:
    """The terms of one file.

    Attributes:
        terms: What it declares.
        version: Checksum of the file.
        module: Name under which it is imported.
    """

    terms: Terms = field(default_factory=Terms)
    version: str = ""
    module: str = ""


def load_own_terms(path: Path | None) -> OwnTerms:
    """The terms of a file; loaded anew once it has changed.

    Raises:
        OwnTermsError: It cannot be read, or raises an exception.
    """
    if path is None:
        return OwnTerms()
    try:
        version = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
    except OSError as error:
        raise OwnTermsError(f"cannot read {path}: {error.strerror}") from error
    return _load(path, version)


@lru_cache(maxsize=64)
def _load(path: Path, version: str) -> OwnTerms:
    module = _module(path, version)
    return OwnTerms(Terms.of([module]), version, module.__name__)


def _module(path: Path, version: str) -> ModuleType:
    name = f"geswarm_own_terms_{version}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise OwnTermsError(f"expected a Python file (.py), got {path}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # assembled kernels import it by this name
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        lines = [
            at.lineno
            for at in traceback.extract_tb(error.__traceback__)
            if at.filename == str(path)
        ]
        line = getattr(error, "lineno", None) or (lines[-1] if lines else 1)
        raise OwnTermsError(f"{path}, line {line}: {type(error).__name__}: {error}") from error
    return module
