"""What the parameters of a scenario may be, each by itself and together."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from geswarm.rules.findings import Finding
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import footbot
from geswarm.sim.arena import checks as arena_checks
from geswarm.sim.arena.checks import Problem
from geswarm.sim.arena.model import Arena, Band, Box
from geswarm.sim.bodies import BODIES
from geswarm.sim.parameter import Parameter, listed, shown
from geswarm.sim.scenario.objective import OF_THE_RUN
from geswarm.sim.scenario.words import word_problems


class ScenarioError(ValueError):
    """A scenario cannot be used; `findings` lists every reason."""

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(str(finding) for finding in self.findings))


_LEAST = 1e-6
"""What the kernels divide by must not be so small that single precision has no inverse of it."""

PARAMETERS: Mapping[str, Parameter] = {
    "robots": Parameter(int, 1, 200_000),
    "objects": Parameter(int, 0, 200_000),
    "duration": Parameter(float, CONTROL_STEP, 1e7, " s"),
    "width": Parameter(float, 2 * footbot.RADIUS, 1e4, " m", above=True),
    "length": Parameter(float, 2 * footbot.RADIUS, 1e4, " m", above=True),
    "nest": Parameter(float, 0, 1e4, " m", above=True),
    "source": Parameter(float, _LEAST, 1e4, " m"),
    "light": Parameter(float, 0, 1e6, " m"),
    "zone_miss": Parameter(float, 0, 1),
    "grip_reach": Parameter(float, _LEAST, 1e4, " m"),
    "object_range": Parameter(float, _LEAST, 1e4, " m"),
    "object_margin": Parameter(float, 0, 1e4, " m"),
    "random_walk": Parameter(float, 0, 1e6, " s", above=True),
    "max_speed": Parameter(float, 0, 10, " m/s", above=True),
    "turn_gain": Parameter(float, 0, 1e3, " 1/s"),
    "proximity_range": Parameter(float, _LEAST, 1e4, " m"),
    "rab_range": Parameter(float, _LEAST, 1e4, " m"),
    "avoidance_gain": Parameter(float, 0, 1e3),
}
"""What each number may be; `random_walk` is a pair of these."""

OF_THE_ARENA = ("width", "length", "nest", "source", "light")
"""Numbers that belong to the arena, where it has such a thing."""
_IN_THE_ARENA = ("width", "length", "outline", "obstacles", "patches", "lights", "start", "floor")


def written(key: str) -> str:
    """A parameter as a scenario file writes it."""
    return f"arena: {key}" if key.split()[0] in _IN_THE_ARENA else key


def number_problems(values: Mapping[str, object]) -> Iterator[Problem]:
    """Every number that is wrong by itself, of some of `PARAMETERS`."""
    for key, parameter in PARAMETERS.items():
        if key in values:
            check = _pair_problem if key == "random_walk" else Parameter.problem
            if message := check(parameter, values[key]):
                yield (key,), message


def problems(values: Mapping[str, Any]) -> Iterator[Problem]:
    """Everything wrong with the fields of a scenario, as (parameters concerned, message).

    Whether they fit together is checked once each is right by itself.
    """
    arena = values["arena"]
    of_arena = _numbers_of(arena) if isinstance(arena, Arena) else {}
    found = list(number_problems({**values, **of_arena}))
    found += word_problems(values)
    if not any(key in OF_THE_ARENA for keys, _ in found for key in keys):
        found += arena_checks.problems(arena)
    yield from found or _misfits(values, of_arena)


def _numbers_of(arena: Arena) -> dict[str, Any]:
    """The numbers that an arena has, of `OF_THE_ARENA`; it need not be right."""
    found: dict[str, Any] = {}
    if isinstance(arena.outline, Box):
        found |= {"width": arena.outline.width, "length": arena.outline.length}
    found |= {zone: band.depth for zone in ("nest", "source") if (band := arena.zone(zone))}
    return found | ({"light": arena.far_light.y} if arena.far_light else {})


def _pair_problem(parameter: Parameter, value: object) -> str | None:
    if not isinstance(value, list | tuple) or len(value) != 2:
        return f"expected two numbers [min, max], got {shown(value)}"
    for part in value:
        if message := parameter.problem(part):
            return message
    if value[0] > value[1]:
        return f"expected [min, max], got min {shown(value[0])} > max {shown(value[1])}"
    return None


def _misfits(values: Mapping[str, Any], of_arena: Mapping[str, Any]) -> Iterator[Problem]:
    """What does not fit together, each part being right by itself."""
    arena: Arena = values["arena"]
    if "length" in of_arena:
        yield from _zone_misfits(of_arena)
    yield from _object_misfits(values, of_arena)
    yield from _start_misfits(values, of_arena)
    radius = BODIES[values["body"]].radius
    if not arena.banded and values["max_speed"] * CONTROL_STEP >= radius:
        most = radius / CONTROL_STEP
        message = f"expected less than {most:g} m/s, or robots get through walls and obstacles"
        yield ("max_speed", "outline", "obstacles"), f"{message}, got {shown(values['max_speed'])}"
    yield from _body_misfits(values)
    yield from _term_misfits(values)


_MOST_INERT, _WIDEST_OF_INERT = 64, 100.0


def _body_misfits(values: Mapping[str, Any]) -> Iterator[Problem]:
    """What bodies with inertia cannot do yet."""
    if not BODIES[values["body"]].is_inert:
        return
    if values["objects"]:
        yield ("objects", "body"), f"{values['body']}s carry none, expected 0"
    if values["robots"] > _MOST_INERT:
        message = f"expected at most {_MOST_INERT} {values['body']}s, got {values['robots']}"
        yield ("robots", "body"), message
    if max(values["arena"].half_width, values["arena"].half_length) > _WIDEST_OF_INERT / 2.0:
        yield ("outline", "body"), f"expected an arena of at most {_WIDEST_OF_INERT:g} m"


def _term_misfits(values: Mapping[str, Any]) -> Iterator[Problem]:
    """Whether there are all the things that are named; the library of terms is asked here."""
    initial, behaviours = values["initial_behaviour"], values["behaviours"]
    if initial and initial not in behaviours:
        message = f"expected one of {listed(behaviours)}, got {initial!r}"
        yield ("initial_behaviour", "behaviours"), message
    known = (*values["measures"], *OF_THE_RUN)
    for name in values["objective"].names:
        if name not in known:
            message = f"there is no measure {name!r}; known are {listed(known)}"
            yield ("objective", "measures"), message
    named = values["objective"].names
    if set(named) <= set(OF_THE_RUN):
        counted = listed(values["measures"])
        message = f"expected at least one measure in it; counted are {counted}"
        yield ("objective", "measures"), message


def _zone_misfits(of_arena: Mapping[str, Any]) -> Iterator[Problem]:
    """Whether nest and source, where they are bands, have room in a rectangle."""
    length = of_arena["length"]
    nest, source = of_arena.get("nest", 0.0), of_arena.get("source", 0.0)
    for zone, depth in (("nest", nest), ("source", source)):
        if depth > length:
            yield (zone, "length"), f"{depth} m deep, but the arena is {length} m long"
    if nest <= length and source <= length and nest + source > length * (1 + 1e-12):
        message = f"nest and source overlap: {nest} m + {source} m > arena length {length} m"
        yield ("source", "nest", "length"), message


def _object_misfits(values: Mapping[str, Any], of_arena: Mapping[str, Any]) -> Iterator[Problem]:
    """Whether objects have a place to lie that robots can reach."""
    arena: Arena = values["arena"]
    if not values["objects"]:
        if arena.banded and "source" in of_arena:
            message = Parameter(int, 1, PARAMETERS["objects"].high).problem(0)
            yield ("objects", "source"), f"{message}, since there is a source"
        return
    if "source" not in arena.areas:
        message = "objects lie in the area called source, and there is none"
        yield ("objects", "patches"), message
        return
    margin = objects_from_walls(
        values["object_margin"], values["grip_reach"], BODIES[values["body"]].radius
    )
    if arena.banded and "source" in of_arena:
        full = margin >= of_arena["source"] or 2 * margin >= of_arena["width"]
    else:
        full = not arena_checks.has_room_for_objects(arena, margin)
    if full:
        needed = margin > values["object_margin"]
        reason = ", without which none reaches a corner," if needed else ""
        message = f"a margin of {margin:g} m{reason} leaves no room for objects in the source"
        keys = ("object_margin", "source", "width", "grip_reach", "patches", "outline", "obstacles")
        yield keys, message


def _start_misfits(values: Mapping[str, Any], of_arena: Mapping[str, Any]) -> Iterator[Problem]:
    """Whether robots have room where they start."""
    arena, robots = values["arena"], values["robots"]
    if arena.banded and isinstance(arena.start, Band) and arena.start == arena.zone("nest"):
        width, length, nest = (of_arena[key] for key in ("width", "length", "nest"))
        room = robots_in_nest(width, length, nest, BODIES[values["body"]].radius)
        if nest <= length and robots > room:
            message = f"{robots} do not fit in the nest, which has room for {room}"
            yield ("robots", "nest", "width", "length"), message
        return
    room = arena_checks.room_at_start(arena, BODIES[values["body"]].radius)
    if robots > room:
        message = f"{robots} do not fit where they start, which has room for about {room}"
        yield ("robots", "start", "outline", "width", "length", "obstacles"), message


def objects_from_walls(margin: float, grip_reach: float, radius: float) -> float:
    """Least distance of objects from the walls: the margin, or where robots reach into corners."""
    return max(margin, radius - grip_reach / math.sqrt(2.0))


def robots_in_nest(width: float, length: float, nest: float, radius: float = footbot.RADIUS) -> int:
    """How many robots fit side by side with their centres in the nest; so many can start there."""
    diameter = 2.0 * radius
    depth = min(nest, length - radius) - radius
    if depth < 0.0:
        return 0
    columns = 1 + math.floor((width - diameter) / diameter)
    return columns * (1 + math.floor(depth / diameter))
