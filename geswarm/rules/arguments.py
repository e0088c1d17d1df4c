"""What may stand in the parentheses of a term: whole numbers, numbers, or one of some names."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

from geswarm.rules.findings import shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import Value, format_value

MOST_OFFERED = 1000
"""Most values of an argument that grammar and editor offer."""


class Argument(ABC):
    """An argument of a term; grammar, editor and checks read what it may be."""

    name: str
    unit: str

    @property
    @abstractmethod
    def offered(self) -> tuple[Value, ...]:
        """The values that grammar and editor offer."""

    @property
    @abstractmethod
    def expected(self) -> str:
        """What it may be, for messages: `a whole number from 1 to 7`."""

    @abstractmethod
    def admits(self, value: object) -> bool:
        """Whether a value may be used."""

    def number(self, value: Value) -> float:
        """A value as components get it."""
        return float(value)

    def problem(self, value: object) -> str | None:
        """What is wrong with a value, or None."""
        if self.admits(value):
            return None
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.name}: expected {self.expected}{unit}, got {shown(value)}"


@dataclass(frozen=True)
class Whole(Argument):
    """A whole number from `low` to `high`."""

    name: str
    low: int
    high: int
    unit: str = ""

    def __post_init__(self) -> None:
        _require_range(self.name, self.low, self.high)
        _require_few(self.name, self.high - self.low + 1)

    @property
    def offered(self) -> tuple[Value, ...]:
        """All of them."""
        return tuple(range(self.low, self.high + 1))

    @property
    def expected(self) -> str:
        """Its range."""
        return f"a whole number from {self.low} to {self.high}"

    def admits(self, value: object) -> bool:
        """Whether it is a whole number in the range."""
        whole = isinstance(value, int) and not isinstance(value, bool)
        return whole and self.low <= value <= self.high  # type: ignore[operator]


@dataclass(frozen=True)
class Number(Argument):
    """A number from `low` to `high`; `step` apart, or each `step` times the one before, if offered.

    Attributes:
        name: As messages and the editor call it.
        low: The least.
        high: The greatest.
        step: Between two that are offered.
        logarithmic: The step is a factor.
        unit: Of the number.
    """

    name: str
    low: float
    high: float
    step: float
    logarithmic: bool = False
    unit: str = ""

    def __post_init__(self) -> None:
        _require_range(self.name, self.low, self.high)
        if self.step <= (1.0 if self.logarithmic else 0.0) or (self.logarithmic and self.low <= 0):
            raise ValueError(f"{self.name}: expected steps upwards, got {self.step}")
        _require_few(self.name, self._steps)

    @property
    def _steps(self) -> int:
        """How many go from `low` to `high`."""
        if self.logarithmic:
            return math.floor(math.log(self.high / self.low) / math.log(self.step) + 1e-9)
        return math.floor((self.high - self.low) / self.step + 1e-9)

    @property
    def offered(self) -> tuple[Value, ...]:
        """From `low` on, as many as fit; to twelve digits, so that they are short to write."""
        steps = range(self._steps + 1)
        if self.logarithmic:
            return tuple(_short(self.low * self.step**k) for k in steps)
        return tuple(_short(self.low + self.step * k) for k in steps)

    @property
    def expected(self) -> str:
        """Its range."""
        return f"a number from {format_value(self.low)} to {format_value(self.high)}"

    def admits(self, value: object) -> bool:
        """Whether it is a number in the range, offered or not."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        return is_finite(value) and self.low <= value <= self.high


@dataclass(frozen=True)
class Choice(Argument):
    """One of some names, such as colours."""

    name: str
    options: tuple[str, ...]
    unit: str = ""

    @property
    def offered(self) -> tuple[Value, ...]:
        """All of them."""
        return self.options

    @property
    def expected(self) -> str:
        """The names."""
        return " or ".join(self.options)

    def number(self, value: Value) -> float:
        """Its position among the names."""
        return self.options.index(str(value))

    def admits(self, value: object) -> bool:
        """Whether it is one of the names."""
        return value in self.options


def _require_range(name: str, low: float, high: float) -> None:
    """Raise ValueError unless there is something between two numbers."""
    for each in (low, high):
        if isinstance(each, bool) or not isinstance(each, int | float) or not is_finite(each):
            raise ValueError(f"{name}: expected numbers, got {each!r}")
    if not low < high:
        raise ValueError(f"{name}: expected the least before the greatest, got {low} and {high}")


def _require_few(name: str, count: float) -> None:
    if count > MOST_OFFERED:
        raise ValueError(f"{name}: expected at most {MOST_OFFERED} values on offer")


def _short(number: float) -> float:
    return float(f"{number:.12g}")
