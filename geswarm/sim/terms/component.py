"""What scenarios are composed of: small functions of numbers, wired by names of parameters.

A component says what it needs by naming it. A name is looked up in this order: what the decorator
promises (random bits, the pair at hand), a register of the robot, a field of the robot (`x`, `y`,
`cos`, `sin`, what some component writes, sums over the other robots), `step`, else a number of the
scenario (`light_y`, `max_speed`). What no one names is not computed.

| decorator | the function returns |
| --- | --- |
| `sensor` | a reading, a whole number from 0 |
| `behaviour` | the target vector (x, y), and its share of the highest speed if `paced` |
| `update` | new values of the fields that it writes |
| `steering` | a vector that is added to the target of every behaviour, times a number by name |
| `vector_sum`, `total`, `count` | the weight, the number, the truth for one pair of robots |
| `effect` | whether it happens to the robot in this step |
| `measure` | a number that is counted |
| `condition` | whether it is so, for a behaviour's `again` |
| `bounds` | the place (x, y), or the nearest one inside the walls |

The functions work on single-precision numbers, one lane of a vector each: no branches but
`a if condition else b`, no calls but those of `geswarm.sim.kernels.single`, whole numbers cast by
`I` after each operation.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

from geswarm.sim.kernels.jit import inlined

Real: TypeAlias = Any
"""A numpy.float32, or a vector of them once compiled."""
Whole: TypeAlias = Any
"""A numpy.int32."""
Bits: TypeAlias = Any
"""32 random bits, a numpy.uint32."""
Function: TypeAlias = Callable[..., Any]

OF_A_PAIR = ("dx", "dy", "d2", "per_d")
"""From the other robot to this one (m), squared distance, its inverse root."""
OTHER = "other_"
"""Prefix of what the other robot of a pair has."""


@dataclass(frozen=True, eq=False)
class Component:
    """A function and what it is for.

    Attributes:
        function: Plain Python; numbers in, numbers out.
    """

    function: Function = field(repr=False)

    @property
    def name(self) -> str:
        """The function's name."""
        return self.function.__name__

    @property
    def module(self) -> str:
        """Where the function is defined."""
        return self.function.__module__

    @property
    def place(self) -> str:
        """File and line, for messages."""
        code = self.function.__code__
        return f"{code.co_filename}, line {code.co_firstlineno}"

    @cached_property
    def needs(self) -> tuple[str, ...]:
        """What it names."""
        return tuple(inspect.signature(self.function).parameters)

    @cached_property
    def inlined(self) -> Any:
        """The function as kernels call it."""
        return inlined(self.function)


@dataclass(frozen=True, eq=False)
class Sensor(Component):
    """A reading from 0 to `values` - 1; fails as a whole, to 0, with a probability by name."""

    values: int = 2
    fails: str | None = None


@dataclass(frozen=True, eq=False)
class Update(Component):
    """Writes fields of the robot, with random bits under the names in `draws`."""

    writes: Mapping[str, type] = field(default_factory=dict)
    draws: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Behaviour(Component):
    """A target vector.

    Attributes:
        start: What changing to it does, and `again` being true.
        again: Whether it starts afresh by itself; None for never.
        arguments: Numbers that a rule gives it.
        paced: Returns its share of the highest speed, too.
    """

    start: Update | None = None
    again: Component | None = None
    arguments: tuple[str, ...] = ()
    paced: bool = False


@dataclass(frozen=True, eq=False)
class Steering(Component):
    """A vector for every behaviour, times `gain`, a number by name."""

    gain: str = ""


@dataclass(frozen=True, eq=False)
class Sum(Component):
    """Something summed up over the other robots.

    Attributes:
        output: Name of the sum; a vector is two fields, `_x` and `_y`.
        form: "vector", "total" or "count".
    """

    output: str = ""
    form: str = "total"

    @property
    def outputs(self) -> tuple[str, ...]:
        """The fields it writes."""
        ends = ("_x", "_y") if self.form == "vector" else ("",)
        return tuple(self.output + end for end in ends)


@dataclass(frozen=True, eq=False)
class Effect(Component):
    """What happens to a robot, and an object if `nearest` names the reach in which it must be.

    The nearest object's new place is what `then` writes to `object_x` and `object_y`.
    """

    then: Update | None = None
    nearest: str | None = None


@dataclass(frozen=True, eq=False)
class Measure(Component):
    """A number counted per robot and summed up.

    Attributes:
        at: The effect at which it is counted; "step" for after each step, "end" for at the end.
        kind: Of the number.
    """

    at: Effect | str = "step"
    kind: type = int


@dataclass(frozen=True, eq=False)
class Register:
    """An internal state of a robot that actions change.

    Attributes:
        name: As components name it.
        initially: Its value at the start, and of a momentary one at the start of every step.
        momentary: Whether it falls back after every step.
        seen_by: The sensor that reads it; what rules make of it is known when they are compiled.
        values: How many; 2 for true and false.
    """

    name: str
    initially: int = 0
    momentary: bool = False
    seen_by: Sensor | None = None
    values: int = 2

    @property
    def bits(self) -> int:
        """How many bits of the robot's state it takes."""
        return (self.values - 1).bit_length()


def sensor(values: int = 2, fails: str | None = None) -> Callable[[Function], Sensor]:
    """The function returns a reading, see `Sensor`."""
    return lambda function: Sensor(function, values, fails)


def update(writes: Mapping[str, type], draws: tuple[str, ...] = ()) -> Callable[[Function], Update]:
    """The function returns new values of the fields in `writes`, in that order."""
    return lambda function: Update(function, dict(writes), draws)


def behaviour(
    start: Update | None = None,
    again: Component | None = None,
    arguments: tuple[str, ...] = (),
    paced: bool = False,
) -> Callable[[Function], Behaviour]:
    """The function returns a target vector, see `Behaviour`."""
    return lambda function: Behaviour(function, start, again, arguments, paced)


def condition(function: Function) -> Component:
    """The function returns 1 if it is so, else 0."""
    return Component(function)


def steering(gain: str) -> Callable[[Function], Steering]:
    """The function returns a vector for every behaviour, see `Steering`."""
    return lambda function: Steering(function, gain)


def vector_sum(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: the function's weight times (dx, dy)."""
    return lambda function: Sum(function, output, "vector")


def total(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: the sum of the function's number."""
    return lambda function: Sum(function, output, "total")


def count(output: str) -> Callable[[Function], Sum]:
    """Over the other robots: for how many the function is true."""
    return lambda function: Sum(function, output, "count")


def effect(then: Update, nearest: str | None = None) -> Callable[[Function], Effect]:
    """The function returns 1 if the effect happens, else 0; see `Effect`."""
    return lambda function: Effect(function, then, nearest)


def measure(at: Effect | str = "step", kind: type = int) -> Callable[[Function], Measure]:
    """The function returns a number, see `Measure`."""
    return lambda function: Measure(function, at, kind)


def bounds(function: Function) -> Component:
    """The function returns the place (x, y), or the nearest one inside the walls."""
    return Component(function)
