"""Simulations at their start: where robots and objects are, and what robots start with."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP
from geswarm.sim.arena.start_places import places_of, require_room
from geswarm.sim.assembly.records import Records
from geswarm.sim.compiled import begin
from geswarm.sim.controllers.encoding import cells_of
from geswarm.sim.kernels.state import IN_BOX, IN_TRIANGLES, IN_TURNED, ROBOT, Beginning, Places
from geswarm.sim.scenario.checks import objects_from_walls
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.terms.parts import Parts

_MORE = 1.0 + 1e-9
"""Cells are wider than two robots that touch by more than what numbers are rounded to."""

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
    radius = scenario.robot.radius
    margin = objects_from_walls(scenario.object_margin, scenario.grip_reach, radius)
    places = places_of(arena, radius, margin if scenario.objects else None)
    beginning = Beginning(parts.first_instance, parts.first_state, walk_min, walk_max, CONTROL_STEP)

    def spots() -> Array:
        return require_room(arena, radius, robots)

    return begun(places, beginning, simulations, (robots, scenario.objects), spots)


def begun(
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
    (robots, objects), count = numbers, len(simulations)
    box = (places.start_x, places.start_half, places.start_south, places.start_depth)
    least = 2.0 * places.radius * _MORE
    columns, rows = cells_of(2.0 * places.start_half, places.start_depth, least, 4 * robots)
    keys, placed = np.empty(count * robots, np.uint64), np.empty(count, np.bool_)
    drawn, lying = np.empty((9, count, robots)), np.empty((4, count, objects))
    begin(
        np.ascontiguousarray(simulations, dtype=np.int64),
        np.array(box),
        places.radius,
        places.shapes,
        np.empty((columns + 2, rows + 2), np.int32),
        np.empty(robots, np.int32),
        *(keys, placed, drawn.reshape(9, -1), lying.reshape(4, -1)),
    )
    if not placed.all():
        left = drawn[7:, ~placed]
        at = _in_cells(places, *left) if places.columns else _at_spots(spots(), left[0])
        drawn[:2, ~placed] = at
    began = np.zeros((count, robots), dtype=ROBOT)
    began["key"] = keys.reshape(count, robots)
    for name, values in zip(("x", "y", "cos", "sin", "walk_x", "walk_y"), drawn, strict=False):
        began[name] = values
    longer = (beginning.walk_max - beginning.walk_min) * drawn[6]
    began["walk_until"] = (beginning.walk_min + longer) / beginning.control_step
    began["behaviour"], began["states"] = beginning.behaviour, beginning.state
    return Start(began, _of_objects(places, *lying))


def _in_cells(places: Places, u: Array, v: Array) -> tuple[Array, Array]:
    """Each robot at random in a cell of its own, at least as wide and deep as a robot.

    There are cells enough: a scenario has no more robots than there is room for.
    """
    diameter, robots = 2.0 * places.radius, u.shape[1]
    south, north = places.start_south, places.start_south + places.start_depth
    west, east = places.start_x - places.start_half, places.start_x + places.start_half
    rows = -(-robots // places.columns)
    columns = -(-robots // rows)
    width = (2.0 * places.start_half + diameter) / columns
    depth = (places.start_depth + diameter) / rows
    row, column = np.divmod(np.arange(robots), columns)
    x = width * (column + 0.5) + west - places.radius + (width - diameter) * (u - 0.5)
    y = depth * (row + 0.5) + south - places.radius + (depth - diameter) * (v - 0.5)
    # But for rounding they are there already.
    return np.clip(x, west, east), np.clip(y, south, north)


def _at_spots(spots: Array, u: Array) -> Array:
    """Each robot at a spot of its own, drawn from those that are left."""
    robots = u.shape[1]
    left = len(spots) - np.arange(robots)
    chosen = (left * u).astype(np.int64)
    chosen = np.minimum(np.arange(robots) + chosen, len(spots) - 1)
    taken = np.empty(chosen.shape, dtype=np.int64)
    for simulation, choices in zip(taken, chosen.tolist(), strict=True):
        order = list(range(len(spots)))
        for i, k in enumerate(choices):
            order[i], order[k] = order[k], order[i]
        simulation[:] = order[:robots]
    return np.moveaxis(spots[taken], -1, 0)


def _of_objects(places: Places, u: Array, v: Array, turned_x: Array, turned_y: Array) -> Array:
    """Where objects lie; u and v uniform in [0, 1), shape (simulations, objects)."""
    place, lying = places.objects, np.empty((*u.shape, 2))
    if places.object_form == IN_BOX:  # x, half width, south, depth
        lying[..., 0] = place[0] + place[1] * (2.0 * u - 1.0)
        lying[..., 1] = place[2] + place[3] * v
    elif places.object_form == IN_TURNED:  # x, y, half width, half length, cos, sin
        cos, sin = place[4], place[5]
        across, along = place[2] * (2.0 * u - 1.0), place[3] * (2.0 * v - 1.0)
        lying[..., 0] = place[0] + across * cos - along * sin
        lying[..., 1] = place[1] + along * cos + across * sin
    elif places.object_form == IN_TRIANGLES:  # shares of the area, a corner, two sides from it
        rows = place[np.searchsorted(place[:, 0], u, side="right") - 1]
        a = np.minimum((u - rows[..., 0]) / rows[..., 1], 1.0)
        beyond = a + v > 1.0  # in the other half of a parallelogram
        a, b = np.where(beyond, 1.0 - a, a), np.where(beyond, 1.0 - v, v)
        lying[:] = rows[..., 2:4] + a[..., None] * rows[..., 4:6] + b[..., None] * rows[..., 6:]
    else:  # x, y, radius
        d = place[2] * np.sqrt(u)
        lying[..., 0], lying[..., 1] = place[0] + d * turned_x, place[1] + d * turned_y
    return lying
