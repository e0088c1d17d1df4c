"""What a number of a scenario may be, and how a wrong one is told."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Parameter:
    """What a parameter may be: low <= value <= high, or low < value if `above`."""

    kind: type[int] | type[float]
    low: float
    high: float
    unit: str = ""
    above: bool = False

    def problem(self, value: object) -> str | None:
        """What is wrong with a value, or None."""
        whole = self.kind is int
        if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
            return f"expected a {'whole ' if whole else ''}number, got {shown(value)}"
        if whole and not isinstance(value, int | np.integer):
            return f"expected a whole number, got {shown(value)}"
        if value <= self.high and (value > self.low if self.above else value >= self.low):
            return None
        low = f"more than {self.low:g}" if self.above else f"at least {self.low:g}"
        return f"expected {low} and at most {self.high:g}{self.unit}, got {shown(value)}"


def shown(value: Any) -> str:
    """A value as the reader knows it, with help where YAML took a number for text."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 10**15:
        return "a number of more than 15 digits"
    if isinstance(value, int | float | np.integer | np.floating):
        return str(value)
    if not isinstance(value, str):
        return f"a {type(value).__name__}"
    short = value if len(value) <= 40 else f"{value[:37]}..."
    try:
        return f"the text {short!r} (as a number: {float(value)})"
    except ValueError:
        return f"the text {short!r}"


def listed(names: Iterable[str]) -> str:
    """Names as messages list them, some of them if there are many."""
    return textwrap.shorten(", ".join(names), 160, placeholder=" ...")
