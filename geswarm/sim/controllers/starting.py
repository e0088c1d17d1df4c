"""Simulations at their start: where robots and objects are, and what robots start with."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP
from geswarm.sim import footbot
from geswarm.sim.arena.start_places import places_of, require_room
from geswarm.sim.assembly.records import Records
from geswarm.sim.compiled import point, scatter
from geswarm.sim.controllers.encoding import cells_of
from geswarm.sim.kernels.draws import (
    START_HEADING,
    START_OBJECT_X,
    START_OBJECT_Y,
    START_WALK,
    START_WALK_TIME,
    START_X,
    START_Y,
    Keys,
    draw,
    make_keys,
)
from geswarm.sim.kernels.start import PLACEMENT_ATTEMPTS
from geswarm.sim.kernels.state import IN_BOX, IN_TURNED, NO_PLACE, ROBOT, Beginning, Places
from geswarm.sim.scenario.checks import objects_from_walls
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms.parts import Parts

Array: TypeAlias = npt.NDArray[np.float64]


class Start(NamedTuple):
    """Simulations at their start.

    Attributes:
        robots: Of ROBOT, shape (simulations, robots).
        objects: float64, shape (simulations, objects, 2).
    """

    robots: Records
    objects: Array


def start_of(scenario: Scenario, simulations: npt.NDArray[np.int64], parts: Parts) -> Start:
    """Simulations at their start.

    Args:
        scenario: Of all of them.
        simulations: (table, seed, individual, replicate) each.
        parts: What the scenario is composed of.

    Raises:
        GroundError: The robots do not fit where they start.
    """
    arena, robots, (walk_min, walk_max) = scenario.arena, scenario.robots, scenario.random_walk
    margin = objects_from_walls(scenario.object_margin, scenario.grip_reach)
    places = places_of(arena, footbot.RADIUS, margin if scenario.objects else None)
    beginning = Beginning(parts.first_instance, parts.first_state, walk_min, walk_max, CONTROL_STEP)

    def spots() -> Array:
        return require_room(arena, footbot.RADIUS, robots)

    return begin(places, beginning, simulations, (robots, scenario.objects), spots)


def begin(
    places: Places,
    beginning: Beginning,
    simulations: npt.NDArray[np.int64],
    numbers: tuple[int, int],
    spots: Callable[[], Array],
) -> Start:
    """Robots at random poses where they start, objects at random in the source.

    Args:
        places: Where that is.
        beginning: What robots start with.
        simulations: (table, seed, individual, replicate) each.
        numbers: How many robots and objects there are in each simulation.
        spots: Called if robots find no place at random: at least as many places as there are
            robots, clear of each other (m), shape (spots, 2).
    """
    robots, objects = numbers
    keys = make_keys(simulations, robots + 1)
    arena_keys, keys = keys[:, robots:], np.ascontiguousarray(keys[:, :robots])
    at, placed = _scattered(places, keys)
    if not placed.all():
        left = keys[~placed]
        at[~placed] = _in_cells(places, left) if places.columns else _at_spots(spots(), left)
    began = np.zeros(keys.shape, dtype=ROBOT)
    began["key"], began["x"], began["y"] = keys, at[..., 0], at[..., 1]
    began["behaviour"], began["states"] = beginning.behaviour, beginning.state
    began["cos"], began["sin"] = _directions(2.0 * math.pi * draw(keys, 0, START_HEADING))
    began["walk_x"], began["walk_y"] = _directions(2.0 * math.pi * draw(keys, 0, START_WALK))
    longer = (beginning.walk_max - beginning.walk_min) * draw(keys, 0, START_WALK_TIME)
    began["walk_until"] = (beginning.walk_min + longer) / beginning.control_step
    numbered = np.arange(objects)
    u, v = (draw(arena_keys, numbered, purpose) for purpose in (START_OBJECT_X, START_OBJECT_Y))
    return Start(began, np.stack(_of_objects(places, u, v), axis=-1))


def _scattered(places: Places, keys: Keys) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Places at random, shape (simulations, robots, 2), and in which simulations all have one."""
    robots = keys.shape[1]
    width, length, diameter = 2.0 * places.half_width, 2.0 * places.half_length, 2.0 * places.radius
    columns, rows = cells_of(width, length, diameter, 4 * robots)
    box = (places.start_x, places.start_half, places.start_south, places.start_depth)
    at, placed = np.zeros((*keys.shape, 2)), np.zeros(len(keys), dtype=np.bool_)
    scatter(
        keys,
        np.array([*box, places.half_width, places.half_length]),
        places.radius,
        places.shapes,
        np.zeros((columns + 2, rows + 2), dtype=np.int32),
        np.zeros(robots, dtype=np.int32),
        at,
        placed,
    )
    return at, placed


def _in_cells(places: Places, keys: Keys) -> Array:
    """Each robot at random in a cell of its own, at least as wide and deep as a robot.

    There are cells enough: a scenario has no more robots than there is room for.
    """
    diameter, robots = 2.0 * places.radius, keys.shape[1]
    south, north = places.start_south, places.start_south + places.start_depth
    west, east = places.start_x - places.start_half, places.start_x + places.start_half
    rows = -(-robots // places.columns)
    columns = -(-robots // rows)
    width = (2.0 * places.start_half + diameter) / columns
    depth = (places.start_depth + diameter) / rows
    row, column = np.divmod(np.arange(robots), columns)
    u = draw(keys, PLACEMENT_ATTEMPTS, START_X) - 0.5
    v = draw(keys, PLACEMENT_ATTEMPTS, START_Y) - 0.5
    x = width * (column + 0.5) + west - places.radius + (width - diameter) * u
    y = depth * (row + 0.5) + south - places.radius + (depth - diameter) * v
    # But for rounding they are there already.
    return np.stack((np.clip(x, west, east), np.clip(y, south, north)), axis=-1)


def _at_spots(spots: Array, keys: Keys) -> Array:
    """Each robot at a spot of its own, drawn from those that are left."""
    robots = keys.shape[1]
    left = len(spots) - np.arange(robots)
    chosen = (left * draw(keys, PLACEMENT_ATTEMPTS, START_X)).astype(np.int64)
    chosen = np.minimum(np.arange(robots) + chosen, len(spots) - 1)
    taken = np.empty(keys.shape, dtype=np.int64)
    for simulation, choices in zip(taken, chosen.tolist(), strict=True):
        order = list(range(len(spots)))
        for i, k in enumerate(choices):
            order[i], order[k] = order[k], order[i]
        simulation[:] = order[:robots]
    return spots[taken]


def _directions(angles: Array) -> tuple[Array, Array]:
    """Cosines and sines; numpy's own are rounded one way on some processors, another on others."""
    cosines, sines = np.empty_like(angles), np.empty_like(angles)
    point(angles.ravel(), cosines.ravel(), sines.ravel())
    return cosines, sines


def _of_objects(places: Places, u: Array, v: Array) -> tuple[Array, Array]:
    """Where objects lie, x and y; u and v uniform in [0, 1), shape (simulations, objects)."""
    place = places.objects
    if places.object_form == IN_BOX:  # x, half width, south, depth
        return place[0] + place[1] * (2.0 * u - 1.0), place[2] + place[3] * v
    if places.object_form == IN_TURNED:  # x, y, half width, half length, cos, sin
        cos, sin = place[4], place[5]
        across, along = place[2] * (2.0 * u - 1.0), place[3] * (2.0 * v - 1.0)
        return place[0] + across * cos - along * sin, place[1] + along * cos + across * sin
    d, (cosines, sines) = place[2] * np.sqrt(u), _directions(2.0 * math.pi * v)  # x, y, radius
    return place[0] + d * cosines, place[1] + d * sines
