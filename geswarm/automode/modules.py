"""AutoMoDe's modules: what a robot can do and what it can look at (Vanilla, Chocolate, Maple).

Numbers and parameters are those of the command line of ARGoS3-AutoMoDe (branches `master` and, for
the modules that trees alone have, `BehaviorTree`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from geswarm.rules.model import Term

FLOORS = ("black", "grey", "white")
"""What a robot takes the floor for."""


class Numeral(float):
    """A number that is written again as it was read: `.5`, `2.0`.

    Attributes:
        text: As it was written.
    """

    text: str

    def __new__(cls, text: str) -> Numeral:
        """The number that a text is; raises ValueError if it is none."""
        number = super().__new__(cls, text)
        number.text = text
        return number

    def __getnewargs__(self) -> tuple[str]:  # type: ignore[override]
        return (self.text,)


def written(number: float) -> str:
    """A number as it was read, or else the shortest text that reads back as exactly this value."""
    return number.text if isinstance(number, Numeral) else repr(number).removesuffix(".0")


@dataclass(frozen=True)
class Parameter:
    """A number that a module has.

    Attributes:
        name: Of its option: `rwm`.
        low: The least.
        high: The greatest.
        whole: Whether it must be a whole number.
        means: What it is, for messages.
    """

    name: str
    low: float
    high: float
    whole: bool = False
    means: str = ""

    @property
    def expected(self) -> str:
        """What it may be, for messages: `a whole number from 1 to 100`."""
        kind = "a whole number" if self.whole else "a number"
        return f"{kind} from {self.low:g} to {self.high:g}"

    def admits(self, number: float) -> bool:
        """Whether a number may be used; one that is none may not."""
        return self.low <= number <= self.high and (not self.whole or number == int(number))


@dataclass(frozen=True)
class Module:
    """A behaviour or a condition as AutoMoDe has it.

    Attributes:
        number: On the command line.
        name: What people call it.
        parameters: Of its own: of behaviours without success probability.
        term: What rules call it; empty if they have none.
    """

    number: int
    name: str
    parameters: tuple[Parameter, ...] = ()
    term: str = ""


PROBABILITY = Parameter("p", 0.0, 1.0, means="probability")
SUCCESS = Parameter("p", 0.0, 1.0, means="success probability")
_XI = Parameter("p", 1.0, 10.0, means="neighbours, xi")
_ETA = Parameter("w", 0.0, 20.0, means="steepness, eta")


def _numbered(*modules: Module) -> Mapping[int, Module]:
    return {module.number: module for module in modules}


BEHAVIOURS = _numbered(
    Module(
        0,
        "exploration",
        (Parameter("rwm", 1, 100, whole=True, means="longest turn, steps"),),
        "EXPLORATION",
    ),
    Module(1, "stop", (), "STOP"),
    Module(2, "phototaxis", (), "PHOTOTAXIS"),
    Module(3, "anti-phototaxis", (), "ANTI-PHOTOTAXIS"),
    Module(4, "attraction", (Parameter("att", 1, 5, means="gain"),), "ATTRACTION"),
    Module(5, "repulsion", (Parameter("rep", 1, 5, means="gain"),), "REPULSION"),
)
"""Of machines."""
TREE_BEHAVIOURS = {
    **BEHAVIOURS,
    **_numbered(
        Module(6, "straight"),
        Module(7, "rotation"),
        Module(8, "curve", (Parameter("r", 1, 20, means="radius, cm"),)),
    ),
}
"""Of trees: straight and curve fail where an obstacle is in front."""
FAILING = frozenset({6, 8})
"""Behaviours that fail where an obstacle is in front."""

CONDITIONS = _numbered(
    Module(0, "black floor", (PROBABILITY,)),
    Module(1, "grey floor", (PROBABILITY,)),
    Module(2, "white floor", (PROBABILITY,)),
    Module(3, "neighbour count", (_XI, _ETA), "CROWDED"),
    Module(4, "inverted neighbour count", (_XI, _ETA), "ALONE"),
    Module(5, "fixed probability", (PROBABILITY,)),
)
"""Of machines."""
TREE_CONDITIONS = {
    **CONDITIONS,
    **_numbered(
        Module(6, "light seen", (PROBABILITY,)),
        Module(7, "obstacle in front", (PROBABILITY,)),
        Module(
            8,
            "close to neighbours",
            (PROBABILITY, Parameter("d", 0.0, 100.0, means="largest attraction vector")),
        ),
    ),
}
"""Of trees."""
NEIGHBOUR_COUNTS = frozenset({3, 4})
"""Conditions whose p is a number of neighbours."""
FIXED = 5


@dataclass(frozen=True)
class Behaviour:
    """What a robot executes.

    Attributes:
        number: Of the module.
        parameter: The module's number, if it has one: rwm (steps), att, rep, r (cm).
    """

    number: int
    parameter: float | None = None

    def __post_init__(self) -> None:
        module = TREE_BEHAVIOURS[self.number]
        given = () if self.parameter is None else (self.parameter,)
        _require(module, given)

    @property
    def module(self) -> Module:
        """What it is one of."""
        return TREE_BEHAVIOURS[self.number]

    @property
    def term(self) -> Term:
        """What rules call it; those that only trees have, have no name there."""
        if self.parameter is None:
            return Term(self.module.term)
        whole = self.module.parameters[0].whole
        argument = int(self.parameter) if whole else float(self.parameter)
        return Term(self.module.term, (argument,))

    def __str__(self) -> str:
        if self.parameter is None:
            return self.module.name
        return f"{self.module.name} ({self.module.parameters[0].name} {written(self.parameter)})"


@dataclass(frozen=True)
class Condition:
    """What a robot looks at.

    Attributes:
        number: Of the module.
        p: Its probability where it holds; of neighbour counts: xi, a number of robots.
        w: Of neighbour counts: eta; of `close to neighbours`: the largest vector.
    """

    number: int
    p: float
    w: float | None = None

    def __post_init__(self) -> None:
        given = (self.p,) if self.w is None else (self.p, self.w)
        _require(TREE_CONDITIONS[self.number], given)

    @property
    def module(self) -> Module:
        """What it is one of."""
        return TREE_CONDITIONS[self.number]

    def chance(self, floor: str, neighbours: int) -> float:
        """The probability that it is true in a step.

        Args:
            floor: One of FLOORS.
            neighbours: Robots that were heard in this step.

        Raises:
            ValueError: It looks at something else (6 to 8).
        """
        if self.number < len(FLOORS):
            return self.p if floor == FLOORS[self.number] else 0.0
        if self.number in NEIGHBOUR_COUNTS and self.w is not None:
            crowded = crowded_chance(self.p, self.w, neighbours)
            return crowded if self.number == 3 else 1.0 - crowded
        if self.number == FIXED:
            return self.p
        raise ValueError(f"{self.module.name} looks at neither floor nor neighbours")

    def __str__(self) -> str:
        names = [each.name for each in self.module.parameters]
        if self.number in NEIGHBOUR_COUNTS:
            names = ["xi", "eta"]
        numbers = (self.p,) if self.w is None else (self.p, self.w)
        told = ", ".join(
            f"{name} {written(number)}" for name, number in zip(names, numbers, strict=True)
        )
        return f"{self.module.name} ({told})"


def crowded_chance(xi: float, eta: float, neighbours: int) -> float:
    """1 / (1 + exp(eta (xi - n))), where AutoMoDe keeps of xi the whole number alone.

    Args:
        xi: Robots, from 1.
        eta: Steepness, from 0.
        neighbours: n, robots heard in this step.
    """
    exponent = eta * (int(xi) - neighbours)
    if exponent > 700.0:  # exp would overflow, and the chance is 0 to 300 digits
        return 0.0
    return 1.0 / (1.0 + math.exp(exponent))


def _require(module: Module, given: tuple[float, ...]) -> None:
    """Raise ValueError unless these are numbers that a module can have."""
    names = [each.name for each in module.parameters]
    if len(given) != len(names):
        expected = " and ".join(names) or "no parameter"
        raise ValueError(f"{module.name}: expected {expected}, got {len(given)} numbers")
    for parameter, number in zip(module.parameters, given, strict=True):
        if not parameter.admits(number):
            raise ValueError(
                f"{module.name}: {parameter.name}: expected {parameter.expected}, got {number}"
            )
