"""Where robots and objects start, and what robots start with."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.draws import (
    START_HEADING,
    START_OBJECT_X,
    START_OBJECT_Y,
    START_WALK,
    START_WALK_TIME,
    START_X,
    START_Y,
    draw,
    make_key,
)
from geswarm.sim.kernels.free import is_free
from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.neighbours import enter, is_clear
from geswarm.sim.kernels.state import IN_BOX, IN_TURNED, Beginning, Places

PLACEMENT_ATTEMPTS = 200
"""At how many random places a robot may overlap another one before all are placed by cells."""


@inlined
def start(
    places: Places,
    beginning: Beginning,
    robots: Any,
    slots: Any,
    starts: Any,
    order: Any,
    objects: Any,
    seed: int,
    individual: int,
    replicate: int,
) -> bool:
    """Robots at random poses where they start, objects at random in the source.

    False if robots found no place at random, and there are not enough spots.
    """
    for i in range(len(robots)):
        robots[i].key = make_key(seed, individual, replicate, i)
    placed: bool = _scatter(places, robots, slots, starts)
    if not placed and places.columns:
        _fill_cells(places, robots)
        placed = True
    if not placed:
        placed = _fill_spots(places, robots, order)
    for i in range(len(robots)):
        _begin(beginning, robots[i])
    arena_key = make_key(seed, individual, replicate, len(robots))
    for o in range(len(objects)):
        u = draw(arena_key, o, START_OBJECT_X)
        _place_object(places, objects, o, u, draw(arena_key, o, START_OBJECT_Y))
    return placed


@inlined
def _scatter(places: Places, robots: Any, slots: Any, starts: Any) -> bool:
    """Place all robots at random, clear of each other; False if one finds no place."""
    starts[:] = -1
    for i in range(len(robots)):
        robot = robots[i]
        clear = False
        for attempt in range(PLACEMENT_ATTEMPTS):
            across = places.start_half * (2.0 * draw(robot.key, attempt, START_X) - 1.0)
            robot.x = places.start_x + across
            robot.y = places.start_south + places.start_depth * draw(robot.key, attempt, START_Y)
            clear = is_free(places, robot.x, robot.y)
            clear = clear and is_clear(places, robots, slots, starts, i)
            if clear:
                break
        if not clear:
            return False
        enter(places, robots, slots, starts, i)
    return True


@inlined
def _fill_cells(places: Places, robots: Any) -> None:
    """Place each robot at random in a cell of its own, at least as wide and deep as a robot.

    There are cells enough: a scenario has no more robots than there is room for.
    """
    diameter = 2.0 * places.radius
    south, north = places.start_south, places.start_south + places.start_depth
    west, east = places.start_x - places.start_half, places.start_x + places.start_half
    rows = (len(robots) + places.columns - 1) // places.columns
    columns = (len(robots) + rows - 1) // rows
    width = (2.0 * places.start_half + diameter) / columns
    depth = (places.start_depth + diameter) / rows
    for i in range(len(robots)):
        robot = robots[i]
        u = draw(robot.key, PLACEMENT_ATTEMPTS, START_X) - 0.5
        v = draw(robot.key, PLACEMENT_ATTEMPTS, START_Y) - 0.5
        x = width * (i % columns + 0.5) + west - places.radius + (width - diameter) * u
        y = depth * (i // columns + 0.5) + south - places.radius + (depth - diameter) * v
        robot.x = min(max(x, west), east)  # but for rounding they are there already
        robot.y = min(max(y, south), north)


@inlined
def _fill_spots(places: Places, robots: Any, order: Any) -> bool:
    """Place each robot at a spot of its own, drawn from those that are left."""
    spots = len(places.spots)
    if len(robots) > spots:
        return False
    for k in range(spots):
        order[k] = k
    for i in range(len(robots)):
        u = draw(robots[i].key, PLACEMENT_ATTEMPTS, START_X)
        k = min(i + int((spots - i) * u), spots - 1)
        order[i], order[k] = order[k], order[i]
        robots[i].x = places.spots[order[i], 0]
        robots[i].y = places.spots[order[i], 1]
    return True


@inlined
def _begin(beginning: Beginning, robot: Any) -> None:
    """Give a robot that has its place all else that it starts with."""
    theta = 2.0 * math.pi * draw(robot.key, 0, START_HEADING)
    robot.cos = math.cos(theta)
    robot.sin = math.sin(theta)
    robot.behaviour = beginning.behaviour
    robot.states = beginning.state
    robot.percepts = 0
    robot.carried = False
    robot.last_rule = -1
    angle = 2.0 * math.pi * draw(robot.key, 0, START_WALK)
    robot.walk_x = math.cos(angle)
    robot.walk_y = math.sin(angle)
    longer = (beginning.walk_max - beginning.walk_min) * draw(robot.key, 0, START_WALK_TIME)
    robot.walk_until = (beginning.walk_min + longer) / beginning.control_step


@inlined
def _place_object(places: Places, objects: Any, o: int, u: float, v: float) -> None:
    """Put object o into the source; u and v uniform in [0, 1)."""
    place = places.objects
    if places.object_form == IN_BOX:  # place: x, half width, south, depth
        objects[o, 0] = place[0] + place[1] * (2.0 * u - 1.0)
        objects[o, 1] = place[2] + place[3] * v
    elif places.object_form == IN_TURNED:  # x, y, half width, half length, cos, sin
        cos, sin = place[4], place[5]
        across, along = place[2] * (2.0 * u - 1.0), place[3] * (2.0 * v - 1.0)
        objects[o, 0] = place[0] + across * cos - along * sin
        objects[o, 1] = place[1] + along * cos + across * sin
    else:  # x, y, radius
        d, angle = place[2] * math.sqrt(u), 2.0 * math.pi * v
        objects[o, 0] = place[0] + d * math.cos(angle)
        objects[o, 1] = place[1] + d * math.sin(angle)
