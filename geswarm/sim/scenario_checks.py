"""What the parameters of a scenario may be, each by itself and together."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from geswarm.rules.findings import Finding
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import footbot


class ScenarioError(ValueError):
    """A scenario cannot be used; `findings` lists every reason."""

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(str(finding) for finding in self.findings))


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
            return f"expected a {'whole ' if whole else ''}number, got {_shown(value)}"
        if whole and not isinstance(value, int | np.integer):
            return f"expected a whole number, got {_shown(value)}"
        if value <= self.high and (value > self.low if self.above else value >= self.low):
            return None
        low = f"more than {self.low:g}" if self.above else f"at least {self.low:g}"
        return f"expected {low} and at most {self.high:g}{self.unit}, got {_shown(value)}"


_LEAST = 1e-6
"""What the kernels divide by must not be so small that single precision has no inverse of it."""

PARAMETERS: Mapping[str, Parameter] = {
    "robots": Parameter(int, 1, 200_000),
    "objects": Parameter(int, 1, 200_000),
    "duration": Parameter(float, CONTROL_STEP, 1e7, " s"),
    "width": Parameter(float, 2 * footbot.RADIUS, 1e4, " m", above=True),
    "length": Parameter(float, 2 * footbot.RADIUS, 1e4, " m", above=True),
    "nest": Parameter(float, 0, 1e4, " m", above=True),
    "source": Parameter(float, _LEAST, 1e4, " m"),
    "light": Parameter(float, 0, 1e6, " m"),
    "zone_miss": Parameter(float, 0, 1),
    "grip_reach": Parameter(float, _LEAST, 1e4, " m"),
    "object_margin": Parameter(float, 0, 1e4, " m"),
    "random_walk": Parameter(float, 0, 1e6, " s", above=True),
    "max_speed": Parameter(float, 0, 10, " m/s", above=True),
    "turn_gain": Parameter(float, 0, 1e3, " 1/s"),
    "proximity_range": Parameter(float, _LEAST, 1e4, " m"),
    "rab_range": Parameter(float, _LEAST, 1e4, " m"),
    "avoidance_gain": Parameter(float, 0, 1e3),
}
"""What each parameter may be; `random_walk` is a pair of these."""


def written(key: str) -> str:
    """A parameter as a scenario file writes it."""
    return f"arena: {key}" if key in ("width", "length") else key


def problems(values: Mapping[str, object]) -> Iterator[tuple[tuple[str, ...], str]]:
    """Everything wrong with a set of parameters, as (parameters concerned, message).

    Whether the numbers fit together is checked once all are there and each is right by itself.
    """
    wrong = False
    for key, value in values.items():
        parameter = PARAMETERS[key]
        if key == "random_walk":
            message = _pair_problem(parameter, value)
        else:
            message = parameter.problem(value)
        if message:
            wrong = True
            yield (key,), message
    if not wrong and len(values) == len(PARAMETERS):
        yield from _misfits(values)


def _pair_problem(parameter: Parameter, value: object) -> str | None:
    if not isinstance(value, list | tuple) or len(value) != 2:
        return f"expected two numbers [min, max], got {_shown(value)}"
    for part in value:
        if message := parameter.problem(part):
            return message
    if value[0] > value[1]:
        return f"expected [min, max], got min {_shown(value[0])} > max {_shown(value[1])}"
    return None


def _misfits(values: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], str]]:
    """What does not fit together, each number being right by itself."""
    width, length = values["width"], values["length"]
    nest, source = values["nest"], values["source"]
    margin = objects_from_walls(values["object_margin"], values["grip_reach"])
    for zone, depth in (("nest", nest), ("source", source)):
        if depth > length:
            yield (zone, "length"), f"{depth} m deep, but the arena is {length} m long"
    if nest <= length and source <= length and nest + source > length * (1 + 1e-12):
        message = f"nest and source overlap: {nest} m + {source} m > arena length {length} m"
        yield ("source", "nest", "length"), message
    if margin >= source or 2 * margin >= width:
        needed = margin > values["object_margin"]
        reason = ", without which none reaches a corner," if needed else ""
        message = f"a margin of {margin:g} m{reason} leaves no room for objects in the source"
        yield ("object_margin", "source", "width", "grip_reach"), message
    room = robots_in_nest(width, length, nest)
    if nest <= length and values["robots"] > room:
        message = f"{values['robots']} do not fit in the nest, which has room for {room}"
        yield ("robots", "nest", "width", "length"), message


def objects_from_walls(margin: float, grip_reach: float) -> float:
    """Least distance of objects from the walls: the margin, or where robots reach into corners."""
    return max(margin, footbot.RADIUS - grip_reach / math.sqrt(2.0))


def robots_in_nest(width: float, length: float, nest: float) -> int:
    """How many robots fit side by side with their centres in the nest; so many can start there."""
    diameter = 2.0 * footbot.RADIUS
    depth = min(nest, length - footbot.RADIUS) - footbot.RADIUS
    if depth < 0.0:
        return 0
    columns = 1 + math.floor((width - diameter) / diameter)
    return columns * (1 + math.floor(depth / diameter))


def _shown(value: Any) -> str:
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
