"""Own terms are tried before they run: what is wrong with one is told by file, line and name.

A component must be a few vector instructions: a branch in it costs the whole loop its speed, and a
reading out of its range would be looked up where there is no table.
"""

from __future__ import annotations

import ast
import inspect
import math
import random
import textwrap
import traceback
import types
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher

from geswarm.sim.arena.model import Arena
from geswarm.sim.kernels import single
from geswarm.sim.kernels.single import F, I, U
from geswarm.sim.terms.component import (
    Behaviour,
    Component,
    PlacesMeasure,
    Sensor,
    Sum,
    Update,
)
from geswarm.sim.terms.parts import Parts, PartsError

_TRIES = 40
_ROBOTS, _SIMULATIONS = 3, 2
_BRANCHES: dict[type[ast.AST], str] = {
    ast.If: "`if`: write `a if condition else b`",
    ast.For: "`for`",
    ast.While: "`while`",
    ast.Try: "`try`",
    ast.With: "`with`",
    ast.BoolOp: "`and` and `or`: write `I(I(a) & I(b))`",
    ast.Not: "`not`: write `I(I(1) - a)`",
    ast.ListComp: "a list",
    ast.List: "a list",
    ast.Dict: "a dictionary",
    ast.Raise: "`raise`",
    ast.Assert: "`assert`",
}
_CALLABLE = {"F": F, "I": I, "U": U}


def require_sound(component: Component, parts: Parts) -> None:
    """Try a component of one's own.

    Raises:
        PartsError: It branches, raises an exception, or returns what its kind must not.
    """
    _require_straight(component)
    function, numbers = plain(component.function), random.Random(1)
    samples = _Samples(parts, numbers)
    for _ in range(_TRIES):
        given = {name: samples.of(name, component) for name in component.needs}
        try:
            with np.errstate(all="ignore"):
                found = function(**given)
        except Exception as error:
            line = _line_of(error, component)
            raise PartsError(
                f"{line}: {component.name} raised {type(error).__name__}: {error}"
            ) from error
        if problem := _problem(component, found):
            what = ", ".join(f"{name}={value:.4g}" for name, value in given.items())
            raise PartsError(f"{component.place}: {component.name}({what}): {problem}")


def require_measures(measure: PlacesMeasure, arena: Arena) -> None:
    """Try a measure of where robots are.

    Raises:
        PartsError: It raises an exception, or does not return a number for each simulation.
    """
    places = np.random.default_rng(1).uniform(-1.0, 1.0, (2, _ROBOTS, _SIMULATIONS))
    x, y = places * np.array([arena.half_width, arena.half_length])[:, np.newaxis, np.newaxis]
    try:
        found = np.asarray(measure.of(x, y, arena))
    except Exception as error:
        line = _line_of(error, measure)
        raise PartsError(
            f"{line}: {measure.name} raised {type(error).__name__}: {error}"
        ) from error
    if found.shape != (_SIMULATIONS,) or not np.isfinite(found.astype(np.float64)).all():
        expected = f"{_SIMULATIONS} numbers for {_SIMULATIONS} simulations of {_ROBOTS} robots"
        raise PartsError(f"{measure.place}: {measure.name}: expected {expected}, got {found!r}")


def plain(function: Callable[..., Any] | None) -> Callable[..., Any]:
    """A component's function as Python runs it, with what it calls."""
    assert isinstance(function, types.FunctionType)
    named = function.__code__.co_names
    known = {
        name: _plain(value) if name in named else value
        for name, value in function.__globals__.items()
    }
    return types.FunctionType(
        function.__code__, known, function.__name__, function.__defaults__, function.__closure__
    )


def _plain(value: Any) -> Any:
    if value is single.fma:
        return lambda a, b, c: F(float(a) * float(b) + float(c))
    if isinstance(value, Dispatcher):
        return plain(value.py_func)
    return value


def _require_straight(component: Component) -> None:
    assert component.function is not None
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(component.function)))
    except (OSError, SyntaxError):  # typed at a prompt: there is nothing to look at
        return
    code = component.function.__code__
    body = [line for part in tree.body for line in getattr(part, "body", [part])]
    for node in (node for line in body for node in ast.walk(line)):  # not what decorates it
        what = _BRANCHES.get(type(node))
        if what is not None:
            line = code.co_firstlineno + getattr(node, "lineno", 1) - 1
            raise PartsError(
                f"{code.co_filename}, line {line}: {component.name}: {what} would cost the vector "
                "instructions that make it fast"
            )


def _line_of(error: Exception, component: Component) -> str:
    assert component.function is not None
    file = component.function.__code__.co_filename
    lines = [at.lineno for at in traceback.extract_tb(error.__traceback__) if at.filename == file]
    return f"{file}, line {lines[-1]}" if lines else component.place


class _Samples:
    """Values that names may have."""

    def __init__(self, parts: Parts, numbers: random.Random) -> None:
        self._numbers = numbers
        self._registers = {register.name: register.values for register in parts.registers}
        self._counts = {o for one in parts.sums if one.form == "count" for o in one.outputs}
        self._areas = {f"in_{area}" for area in parts.ground.areas}
        self._fields = parts.own_fields

    def of(self, name: str, component: Component) -> Any:
        """A value for a name."""
        drawn = name in component.draws if isinstance(component, Update) else False
        name = name.removeprefix("other_").removeprefix("sum_")
        if drawn:
            return U(self._numbers.getrandbits(32))
        if name in self._registers:
            return I(self._numbers.randrange(self._registers[name]))
        if name in self._counts:
            return I(self._numbers.randrange(20))
        if name in self._areas or name in ("carried", "object_near", "floor"):
            return I(self._numbers.randrange(2))
        if name == "step" or self._fields.get(name) is I:
            return I(self._numbers.randrange(10_000))
        if name in ("d2", "per_d"):
            return F(self._numbers.uniform(0.03, 4.0))
        return F(self._numbers.uniform(-2.0, 2.0))


def _problem(component: Component, found: Any) -> str | None:
    """What is wrong with what a component returned."""
    if isinstance(component, Sensor):
        if not _is_whole(found) or not 0 <= int(found) < component.values:
            return f"expected a whole number from 0 to {component.values - 1}, got {found}"
        return None
    if isinstance(component, Behaviour):
        return _expected_numbers(found, 3 if component.paced else 2)
    if isinstance(component, Update):
        many = len(component.writes)
        return None if many == 1 and _is_number(found) else _expected_numbers(found, many)
    if isinstance(component, Sum) and component.form == "count":
        return None if _is_number(found) else f"expected true or false, got {found!r}"
    return None if _is_number(found) else f"expected a number, got {found!r}"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.number | np.bool_)


def _is_whole(value: Any) -> bool:
    return _is_number(value) and math.isfinite(float(value)) and float(value).is_integer()


def _expected_numbers(found: Any, many: int) -> str | None:
    if isinstance(found, tuple) and len(found) == many and all(map(_is_number, found)):
        return None
    return f"expected {many} numbers, got {found!r}"


def own_components(parts: Parts, module: str) -> Iterator[Component]:
    """The components of a scenario that stand in a module."""
    yield from (each for each in (*parts.components, *parts.sums) if each.module == module)
