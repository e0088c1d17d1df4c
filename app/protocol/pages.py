"""Which messages each page knows."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from . import base, edits, evolution, evolution_requests, experiments, rule_requests, rules
from .base import FrameTime, Request, Structure, Watch, kinds_in
from .reading import Reader

MODULES: dict[str, tuple[ModuleType, ...]] = {
    "common": (base,),
    "rules": (rules, rule_requests, edits),
    "evolution": (evolution, evolution_requests),
    "experiments": (experiments,),
}
"""By page, which is a folder of `static`."""


def kinds_of(page: str, below: type[Structure]) -> dict[str, type[Any]]:
    """All messages of a page below a class, by what they are called."""
    return {kind: one for module in MODULES[page] for kind, one in kinds_in(module, below).items()}


def reader_of(page: str, *, watched: bool) -> Reader[Request]:
    """Reads what a page may say.

    Args:
        page: One of `MODULES`.
        watched: It says when it is in view.
    """
    shared: tuple[type[Request], ...] = (FrameTime, Watch) if watched else (FrameTime,)
    of_all = {str(one.__struct_config__.tag): one for one in shared}
    return Reader({**kinds_of(page, Request), **of_all})
