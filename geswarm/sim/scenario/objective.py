"""Objectives: what evolution maximises or minimises, an expression over measures."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, overload

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]

_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: lambda one, other: np.divide(one, np.where(other == 0, np.nan, other)),
}
_FUNCTIONS: dict[str, Callable[..., Any]] = {"min": np.minimum, "max": np.maximum, "abs": np.abs}
OF_THE_RUN = ("robots", "steps", "objects", "duration")
"""What an objective may name besides measures."""
_MOST_CHARACTERS = 400


class ObjectiveError(ValueError):
    """An objective cannot be used; says what was given and what was expected."""


@dataclass(frozen=True)
class Objective:
    """What a run is worth.

    Attributes:
        expression: Over measures, `robots`, `steps`, `objects` and `duration`: numbers, names,
            `+ - * /`, parentheses, `min`, `max`, `abs`.
        maximise: Whether more is better.
        unit: What it counts, for charts and tables.

    Raises:
        ObjectiveError: The expression is not of that form.
    """

    expression: str
    maximise: bool = True
    unit: str = ""

    def __post_init__(self) -> None:
        _check(self._tree, self.expression)

    @property
    def label(self) -> str:
        """What it is called on axes and in tables: `collected (objects)`."""
        return f"{self.expression} ({self.unit})" if self.unit else self.expression

    @property
    def gain_label(self) -> str:
        """The same for what more of is better: `-distance (m)` if that is to be minimised."""
        if self.maximise:
            return self.label
        return f"-{replace(self, expression=_in_parentheses(self.expression)).label}"

    def document(self) -> dict[str, str | bool]:
        """As JSON values."""
        return {"expression": self.expression, "unit": self.unit, "maximise": self.maximise}

    @cached_property
    def _tree(self) -> ast.expr:
        if len(self.expression) > _MOST_CHARACTERS:
            raise ObjectiveError(
                f"expected at most {_MOST_CHARACTERS} characters, got {len(self.expression)}"
            )
        try:
            return ast.parse(self.expression.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise ObjectiveError(_expected(self.expression)) from error

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What it names, each once."""
        named = [node.id for node in ast.walk(self._tree) if isinstance(node, ast.Name)]
        return tuple(name for name in dict.fromkeys(named) if name not in _FUNCTIONS)

    def of(self, values: Mapping[str, Any]) -> Values:
        """Its value for each run.

        Args:
            values: Measures, shape (runs,), and numbers, by name.

        Returns:
            float64, shape (runs,). What is divided by 0 counts as 0.
        """
        with np.errstate(all="ignore"):
            found = np.asarray(_value(self._tree, values), dtype=np.float64)
        return np.nan_to_num(found, nan=0.0, posinf=0.0, neginf=0.0)

    @overload
    def gain(self, values: float) -> float: ...
    @overload
    def gain(self, values: Values) -> Values: ...
    def gain(self, values: Values | float) -> Values | float:
        """The values such that more is better, and back."""
        return values if self.maximise else -values


def _in_parentheses(expression: str) -> str:
    return expression if expression.isidentifier() else f"({expression})"


def _expected(expression: str) -> str:
    return (
        "expected an expression over measures such as `on_black / robots`, "
        f"got {expression.strip()[:60]!r}"
    )


def _check(node: ast.AST, expression: str) -> None:
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        _check(node.left, expression)
        _check(node.right, expression)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        _check(node.operand, expression)
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        least, most = (1, 1) if node.func.id == "abs" else (2, 16)
        if node.func.id not in _FUNCTIONS or not least <= len(node.args) <= most:
            raise ObjectiveError(_expected(expression))
        for argument in node.args:
            _check(argument, expression)
    elif isinstance(node, ast.Constant):
        value = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ObjectiveError(_expected(expression))
        if abs(value) > 1e15 or not math.isfinite(value):
            raise ObjectiveError(f"expected numbers of at most 15 digits, got {expression[:60]!r}")
    elif not isinstance(node, ast.Name):
        raise ObjectiveError(_expected(expression))


def _value(node: ast.expr, values: Mapping[str, Any]) -> Any:
    if isinstance(node, ast.BinOp):
        one, other = _value(node.left, values), _value(node.right, values)
        return _OPERATORS[type(node.op)](one, np.asarray(other, dtype=np.float64))
    if isinstance(node, ast.UnaryOp):
        value = np.asarray(_value(node.operand, values), dtype=np.float64)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.Call):
        assert isinstance(node.func, ast.Name)
        found, *others = (_value(each, values) for each in node.args)
        function = _FUNCTIONS[node.func.id]
        if not others:
            return function(found)
        for other in others:
            found = function(found, other)
        return found
    if isinstance(node, ast.Name):
        return values[node.id]
    assert isinstance(node, ast.Constant)
    return float(node.value)  # type: ignore[arg-type]
