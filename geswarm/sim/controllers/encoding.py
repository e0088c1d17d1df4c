"""A scenario as the numbers and arrays that the kernels take."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP
from geswarm.sim.arena.numbers import ground_numbers, object_numbers, triangle_numbers
from geswarm.sim.assembly.records import Records
from geswarm.sim.kernels.pairs import Grid
from geswarm.sim.scenario.checks import objects_from_walls
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms.component import Component
from geswarm.sim.terms.parts import Parts, PartsError

_ALL_PAIRS_UP_TO = 12
"""Number of robots up to which all pairs are listed, once."""
_ALL_PAIRS_MARGIN = 1e9
_STEPS_OF_A_LIST = 20
"""Margin of the lists of pairs, in steps of a robot at full speed."""


def scenario_numbers(scenario: Scenario) -> dict[str, float]:
    """Everything that components may name; lengths in metres, times in seconds."""
    sight, skin = _sight(scenario)
    body = scenario.robot
    own = {name: float(getattr(scenario, name)) for name in _OWN}
    return {
        **dict(body.numbers),
        **dict(scenario.numbers),
        **own,
        "walk_min": scenario.random_walk[0],
        "walk_max": scenario.random_walk[1],
        "avoidance_range": _avoidance_range(scenario),
        "half_width": scenario.arena.half_width,
        "half_length": scenario.arena.half_length,
        "radius": body.radius,
        "wheel_base": body.wheel_base,
        "control_step": CONTROL_STEP,
        **ground_numbers(scenario.arena, body.radius),
        **object_numbers(scenario.arena, _margin(scenario)),
        "sight": sight,
        "skin": skin,
    }


_OWN = (
    *("robots", "duration", "zone_miss", "grip_reach", "object_range", "max_speed", "turn_gain"),
    *("proximity_range", "rab_range", "avoidance_gain"),
)


def _margin(scenario: Scenario) -> float:
    """Least distance of objects from walls and obstacles (m)."""
    radius = scenario.robot.radius
    return objects_from_walls(scenario.object_margin, scenario.grip_reach, radius)


def _avoidance_range(scenario: Scenario) -> float:
    given = scenario.avoidance_range
    return scenario.rab_range if given is None else given


def numbers_by_name(
    scenario: Scenario, names: Iterable[str], parts: Parts
) -> npt.NDArray[np.float32]:
    """The numbers of these names, in single precision; then `triangle_numbers` if there are.

    Raises:
        PartsError: A component names something that there is not.
    """
    known = scenario_numbers(scenario)
    names = list(names)
    for name in names:
        if name not in known:
            everyone = (*parts.components, *parts.needed_sums)
            who: Component = next(each for each in everyone if name in each.needs)
            raise PartsError(
                f"{who.place}: {who.name} names {name}, which is neither a field of a robot, nor a "
                "register, nor a sum over the other robots, nor a number of the scenario"
            )
    triangles = triangle_numbers(scenario.arena, _margin(scenario))
    return np.array([*(known[name] for name in names), *triangles], dtype=np.float32)


def fails(scenario: Scenario, parts: Parts) -> list[float]:
    """With which probability each sensor reads 0 instead of what it should."""
    known = scenario_numbers(scenario)
    return [known[sensor.fails] if sensor.fails else 0.0 for sensor in parts.sensors]


def is_wide(scenario: Scenario) -> bool:
    """Whether single precision needs help: a large arena or slow robots, or turns of any angle."""
    turn = min(scenario.turn_gain * np.pi, 2.0 * scenario.max_speed / scenario.robot.wheel_base)
    extent = max(scenario.width, scenario.length)
    advance = scenario.max_speed * CONTROL_STEP
    return bool(
        turn * CONTROL_STEP > np.pi / 2.0  # up to which a sine is good
        or advance < extent / 2.0**15  # a thousand times what positions are rounded to
    )


def _sight(scenario: Scenario) -> tuple[float, float]:
    """How far robots must know of each other, and the margin of the lists of pairs (m)."""
    step = scenario.max_speed * CONTROL_STEP
    radius = scenario.robot.radius
    touch = 2.0 * (radius + step)
    body = 2.0 * radius + scenario.proximity_range
    sight = max(scenario.rab_range, _avoidance_range(scenario), body, 2.0 * touch)
    if scenario.robots <= _ALL_PAIRS_UP_TO:
        return sight, _ALL_PAIRS_MARGIN
    return sight, min(max(_STEPS_OF_A_LIST * step, 0.1 * sight), sight)


def grid_for(scenario: Scenario) -> Grid:
    """Room for the search for neighbours and objects of a swarm; nothing listed yet."""
    robots = scenario.robots
    sight, skin = _sight(scenario)
    columns, rows = cells_of(scenario.width, scenario.length, 1.01 * (sight + skin), 4 * robots)
    source = (1, 1)
    if scenario.objects:
        lie = object_numbers(scenario.arena, 0.0)
        width, depth = (
            lie[f"objects_{high}"] - lie[f"objects_{low}"]
            for high, low in (("east", "west"), ("north", "south"))
        )
        source = cells_of(width, depth, scenario.grip_reach, scenario.objects)
    pairs, listed = np.empty((4 * robots, 2), dtype=np.int32), -1
    if robots <= _ALL_PAIRS_UP_TO:
        pairs = np.stack(np.triu_indices(robots, 1), axis=1).astype(np.int32)
        listed = len(pairs)
    return Grid(
        pairs=pairs,
        listed=np.array([listed], dtype=np.int64),
        starts=np.zeros((columns, rows + 1), dtype=np.int32),
        order=np.zeros(robots, dtype=np.int32),
        sorted_x=np.zeros(robots, dtype=np.float32),
        sorted_y=np.zeros(robots, dtype=np.float32),
        heads=np.zeros(source, dtype=np.int32),
        following=np.zeros(scenario.objects, dtype=np.int32),
    )


def cells_of(width: float, length: float, least: float, cells: int) -> tuple[int, int]:
    """Columns and rows of a grid of about so many cells, none narrower than `least`."""
    side = max(least, math.sqrt(width * length / cells))
    return max(1, int(width / side)), max(1, int(length / side))


def fill_robots(block: Records, began: Records) -> None:
    """Give fields of robots, shape (robots, lanes) or (lanes,), the values of the start."""
    block["key_low"] = began["key"] & np.uint64(0xFFFFFFFF)
    block["key_high"] = began["key"] >> np.uint64(32)
    fields = block.dtype.names or ()
    for name in ("x", "y", "cos", "sin", "walk_x", "walk_y", "behaviour", "carried"):
        if name in fields:
            block[name] = began[name]
    if "walk_until" in fields:
        block["walk_until"] = np.ceil(began["walk_until"])
    block["state"] = began["states"]
