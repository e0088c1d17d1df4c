"""What scenarios are composed of: small functions of numbers, wired by names of parameters.

A component says what it needs by naming it. A name is looked up in this order: what the decorator
promises (arguments, random bits, the pair at hand), a register of the robot, a field of the robot
(`x`, `y`, `cos`, `sin`, what some component writes, sums over the other robots), what the ground
gives (`in_nest`, `floor`, `push_x`, `to_light_x`, `brightness`), `step`, else a number of the
scenario (`rab_range`, `max_speed`). What no one names is not computed.

| decorator | the function returns |
| --- | --- |
| `sensor` | a reading, a whole number from 0 |
| `behaviour` | the target vector (x, y), and its share of the highest speed if `paced` |
| `update` | new values of the fields that it writes |
| `steering` | a vector that is added to the target of every behaviour, times a number by name |
| `vector_sum`, `total`, `count` | the weight, the number, the truth for one pair of robots |
| `effect` | whether it happens to the robot in this step |
| `measure` | a number that is counted for each robot |
| `swarm_measure` | a number of the whole swarm, of sums such as `sum_in_nest` |
| `places_measure` | a number of the whole swarm, of where its robots are (not in the kernel) |
| `condition` | whether it is so, for a behaviour's `again` |

What rules call a sensor's reading is a `percept` of it; behaviours and registers have their words
with them (`geswarm.rules.declarations`).

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

import numpy as np
import numpy.typing as npt

from geswarm.rules.declarations import BehaviourName, InternalStateName, PreconditionName
from geswarm.rules.model import Value
from geswarm.sim.arena.model import Arena
from geswarm.sim.kernels.jit import inlined

Real: TypeAlias = Any
"""A numpy.float32, or a vector of them once compiled."""
Integer: TypeAlias = Any
"""A numpy.int32."""
Bits: TypeAlias = Any
"""32 random bits, a numpy.uint32."""
Function: TypeAlias = Callable[..., Any]
Places: TypeAlias = npt.NDArray[Any]
"""Coordinates of robots (m), shape (robots, simulations); or a number for each simulation."""

OF_A_PAIR = ("dx", "dy", "d2", "per_d")
"""From the other robot to this one (m), squared distance, its inverse root."""
OTHER = "other_"
"""Prefix of what the other robot of a pair has."""
SUM = "sum_"
"""Prefix of a sum over all robots, for what is counted of a swarm."""


@dataclass(frozen=True, eq=False)
class Component:
    """A function and what it is for.

    Attributes:
        function: Plain Python; numbers in, numbers out. None for what the kernel itself makes of
            the names in `given`.
        called: Its name, if there is no function.
        given: What it names, if there is no function.
    """

    function: Function | None = field(repr=False)
    called: str = ""
    given: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The function's name."""
        return self.function.__name__ if self.function else self.called

    @property
    def module(self) -> str | None:
        """Where the function is defined."""
        return self.function.__module__ if self.function else None

    @property
    def place(self) -> str:
        """File and line, for messages."""
        if self.function is None:
            return "made by GESwarm"
        code = self.function.__code__
        return f"{code.co_filename}, line {code.co_firstlineno}"

    @property
    def about(self) -> str:
        """The first line of what the function says of itself."""
        return (inspect.getdoc(self.function) or "").split("\n")[0] if self.function else ""

    @cached_property
    def needs(self) -> tuple[str, ...]:
        """What it names."""
        return tuple(inspect.signature(self.function).parameters) if self.function else self.given

    @cached_property
    def inlined(self) -> Any:
        """The function as kernels call it."""
        return inlined(self.function)


@dataclass(frozen=True, eq=False)
class Sensor(Component):
    """A reading from 0 to `values` - 1; fails as a whole, to 0, with a probability by name.

    Without a function the names in `given` are its bits, the first one counting least; or it is the
    only one of them.
    """

    values: int = 2
    fails: str | None = None


@dataclass(frozen=True, eq=False)
class Percept:
    """What rules call a sensor's reading.

    Attributes:
        word: As rules write it.
        sensor: What it looks at.
        value: Of the word's reading, for each of the sensor's.
    """

    word: PreconditionName
    sensor: Sensor
    value: Callable[[int], Value] = int


@dataclass(frozen=True, eq=False)
class Update(Component):
    """Writes fields of the robot, with random bits under the names in `draws`."""

    writes: Mapping[str, type] = field(default_factory=dict)
    draws: tuple[str, ...] = ()


NAMELESS = BehaviourName("", "", "")


@dataclass(frozen=True, eq=False)
class Behaviour(Component):
    """A target vector.

    Attributes:
        word: As rules write it; its arguments are numbers that the function may name.
        start: What changing to it does, and `again` being true.
        again: Whether it starts afresh by itself; None for never.
        paced: Returns its share of the highest speed, too.
        goes_on: What it notes down in each step, after it has said where to go.
    """

    word: BehaviourName = field(default=NAMELESS)
    start: Update | None = None
    again: Component | None = None
    paced: bool = False
    goes_on: Update | None = None

    @property
    def arguments(self) -> tuple[str, ...]:
        """Names of the numbers that a rule gives it."""
        return tuple(each.name for each in self.word.arguments)


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

    Attributes:
        then: What it changes.
        nearest: The reach, by name.
        after: The effect without which this one never happens, looked at before it.
    """

    then: Update | None = None
    nearest: str | None = None
    after: Effect | None = None


@dataclass(frozen=True, eq=False)
class Measure(Component):
    """A number counted per robot and summed up.

    Attributes:
        at: The effect at which it is counted; "step" for after each step, "end" for at the end.
        kind: Of the number.
    """

    at: Effect | str = "step"
    kind: type = int
    unit: str = ""


@dataclass(frozen=True, eq=False)
class SwarmMeasure(Component):
    """A number of the whole swarm; without a function the greatest of the names in `given`.

    Attributes:
        at: "step" for the sum over all steps, "end" for once at the end.
        kind: Of the number.
    """

    at: str = "step"
    kind: type = int
    unit: str = ""


@dataclass(frozen=True, eq=False)
class CellMeasure(SwarmMeasure):
    """The steps since some robot was in each of `cells` cells, summed up over cells and steps.

    The function returns the number of the cell that a robot is in, from 0.
    """

    cells: int = 1


@dataclass(frozen=True, eq=False)
class PlacesMeasure(Component):
    """A number of the whole swarm, of where its robots are at the end.

    The function gets (x, y, arena) and runs in Python, once for many simulations: x and y are of
    shape (robots, simulations), in metres, what it returns of shape (simulations,).

    Attributes:
        unit: Of the number.
        areas: That it is about.
    """

    unit: str = ""
    areas: tuple[str, ...] = ()

    def of(self, x: Places, y: Places, arena: Arena) -> Places:
        """The number for each simulation."""
        assert self.function is not None
        found: Places = self.function(x.astype(np.float64), y.astype(np.float64), arena)
        return found


@dataclass(frozen=True, eq=False)
class Register:
    """An internal state of a robot that actions change.

    Attributes:
        word: As rules write it; one of whole numbers is a counter, from 0 to at most 7.
        seen_by: The sensor that reads it; what rules make of it is known when they are compiled.
    """

    word: InternalStateName
    seen_by: Sensor | None = None

    @property
    def name(self) -> str:
        """As components name it."""
        return self.word.name.lower().replace("-", "_")

    @property
    def initially(self) -> int:
        """Position of its value at the start, and of a momentary one at the start of every step."""
        return self.word.values.index(self.word.initially)

    @property
    def momentary(self) -> bool:
        """Whether it falls back after every step."""
        return self.word.momentary

    @property
    def values(self) -> int:
        """How many; 2 for true and false."""
        return len(self.word.values)

    @property
    def bits(self) -> int:
        """How many bits of the robot's state it takes."""
        return COUNTER_BITS if self.word.counts else (self.values - 1).bit_length()


COUNTER_BITS = 3
