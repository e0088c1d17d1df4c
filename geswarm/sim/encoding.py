"""A scenario as the numbers and arrays that the kernels take."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import footbot
from geswarm.sim.assembly.records import Records
from geswarm.sim.compiled import start_all
from geswarm.sim.kernels.pairs import Grid
from geswarm.sim.kernels.state import ROBOT, SLOT, Physics
from geswarm.sim.scenario import Scenario
from geswarm.sim.scenario_checks import objects_from_walls
from geswarm.sim.terms.component import Component
from geswarm.sim.terms.foraging import FORAGING as PARTS
from geswarm.sim.terms.parts import Parts, PartsError

_ALL_PAIRS_UP_TO = 12
"""Number of robots up to which all pairs are listed, once."""
_ALL_PAIRS_MARGIN = 1e9
_STEPS_OF_A_LIST = 20
"""Margin of the lists of pairs, in steps of a robot at full speed."""


def encode_scenario(scenario: Scenario) -> Physics:
    """The scenario in numbers; origin at the centre of the arena."""
    half_length = scenario.length / 2.0
    return Physics(
        half_width=scenario.width / 2.0,
        half_length=half_length,
        nest_edge=scenario.nest - half_length,
        source_edge=half_length - scenario.source,
        light_y=half_length + scenario.light,
        zone_miss=scenario.zone_miss,
        grip_reach=scenario.grip_reach,
        object_margin=objects_from_walls(scenario.object_margin, scenario.grip_reach),
        walk_min=scenario.random_walk[0],
        walk_max=scenario.random_walk[1],
        max_speed=scenario.max_speed,
        turn_gain=scenario.turn_gain,
        proximity_range=scenario.proximity_range,
        rab_range=scenario.rab_range,
        avoidance_gain=scenario.avoidance_gain,
        radius=footbot.RADIUS,
        wheel_base=footbot.WHEEL_BASE,
        control_step=CONTROL_STEP,
    )


def scenario_numbers(scenario: Scenario) -> dict[str, float]:
    """Everything that components may name; lengths in metres, times in seconds."""
    physics = encode_scenario(scenario)
    sight, skin = _sight(scenario)
    return {
        **physics._asdict(),
        "sight": sight,
        "skin": skin,
        "objects_west": physics.object_margin - physics.half_width,
        "objects_east": physics.half_width - physics.object_margin,
        "objects_south": physics.source_edge,
        "objects_north": physics.half_length - physics.object_margin,
    }


def numbers_by_name(
    scenario: Scenario, names: Iterable[str], parts: Parts = PARTS
) -> npt.NDArray[np.float32]:
    """The numbers of these names, in single precision.

    Raises:
        PartsError: A component names something that there is not.
    """
    known = scenario_numbers(scenario)
    names = list(names)
    for name in names:
        if name not in known:
            who: Component = next(
                each for each in (*parts.components, *parts.needed_sums) if name in each.needs
            )
            raise PartsError(
                f"{who.place}: {who.name} names {name}, which is neither a field of a robot, nor a "
                "register, nor a sum over the other robots, nor a number of the scenario"
            )
    return np.array([known[name] for name in names], dtype=np.float32)


def fails(scenario: Scenario, parts: Parts = PARTS) -> list[float]:
    """With which probability each sensor reads 0 instead of what it should."""
    known = scenario_numbers(scenario)
    return [known[sensor.fails] if sensor.fails else 0.0 for sensor in parts.sensors]


def is_wide(scenario: Scenario) -> bool:
    """Whether single precision needs help: a large arena or slow robots, or turns of any angle."""
    turn = min(scenario.turn_gain * np.pi, 2.0 * scenario.max_speed / footbot.WHEEL_BASE)
    extent = max(scenario.width, scenario.length)
    advance = scenario.max_speed * CONTROL_STEP
    return bool(
        turn * CONTROL_STEP > np.pi / 2.0  # up to which a sine is good
        or advance < extent / 2.0**15  # a thousand times what positions are rounded to
    )


def _sight(scenario: Scenario) -> tuple[float, float]:
    """How far robots must know of each other, and the margin of the lists of pairs (m)."""
    step = scenario.max_speed * CONTROL_STEP
    touch = 2.0 * (footbot.RADIUS + step)
    sight = max(scenario.rab_range, 2.0 * touch)
    if scenario.robots <= _ALL_PAIRS_UP_TO:
        return sight, _ALL_PAIRS_MARGIN
    return sight, min(max(_STEPS_OF_A_LIST * step, 0.1 * sight), sight)


def grid_for(scenario: Scenario) -> Grid:
    """Room for the search for neighbours and objects of a swarm; nothing listed yet."""
    robots = scenario.robots
    sight, skin = _sight(scenario)
    columns, rows = _cells(scenario.width, scenario.length, 1.01 * (sight + skin), 4 * robots)
    source = _cells(scenario.width, scenario.source, scenario.grip_reach, scenario.objects)
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


def _cells(width: float, length: float, least: float, cells: int) -> tuple[int, int]:
    """Columns and rows of a grid of about so many cells, none narrower than `least`."""
    side = max(least, math.sqrt(width * length / cells))
    return max(1, int(width / side)), max(1, int(length / side))


class Start(NamedTuple):
    """Simulations at their start.

    Attributes:
        robots: Of ROBOT, shape (simulations, robots).
        objects: float64, shape (simulations, objects, 2).
    """

    robots: Records
    objects: npt.NDArray[np.float64]


def start_of(scenario: Scenario, simulations: npt.NDArray[np.int64]) -> Start:
    """Simulations (table, seed, individual, replicate) at their start."""
    robots = scenario.robots
    large = robots > _ALL_PAIRS_UP_TO
    columns, rows = _cells(scenario.width, scenario.length, 2.0 * footbot.RADIUS, 4 * robots)
    began = Start(
        robots=np.zeros((len(simulations), robots), dtype=ROBOT),
        objects=np.zeros((len(simulations), scenario.objects, 2)),
    )
    start_all(
        encode_scenario(scenario),
        began.robots,
        np.zeros(robots if large else 0, dtype=SLOT),
        np.zeros((columns, rows + 1) if large else (0, 1), dtype=np.int32),
        began.objects,
        np.ascontiguousarray(simulations, dtype=np.int64),
    )
    return began


def fill_robots(block: Records, began: Records) -> None:
    """Give fields of robots, shape (robots, lanes) or (lanes,), the values of the start."""
    block["key_low"] = began["key"] & np.uint64(0xFFFFFFFF)
    block["key_high"] = began["key"] >> np.uint64(32)
    for name in ("x", "y", "cos", "sin", "walk_x", "walk_y", "behaviour", "carried"):
        block[name] = began[name]
    block["walk_until"] = np.ceil(began["walk_until"])
    block["state"] = began["states"]
