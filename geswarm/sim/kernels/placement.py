"""Where robots and objects start, where new objects appear, where a random walk heads."""

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
from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.neighbours import enter, is_clear
from geswarm.sim.kernels.state import RANDOM_WALK, WANT_OBJECT, Physics

PLACEMENT_ATTEMPTS = 200
"""At how many random places a robot may overlap another one before all are placed by cells."""


@inlined
def start(
    physics: Physics,
    robots: Any,
    slots: Any,
    starts: Any,
    objects: Any,
    seed: int,
    individual: int,
    replicate: int,
) -> None:
    """Robots at random poses in the nest, walking at random; objects at random in the source."""
    for i in range(len(robots)):
        robots[i].key = make_key(seed, individual, replicate, i)
    if not _scatter(physics, robots, slots, starts):
        _fill_cells(physics, robots)
    for i in range(len(robots)):
        _begin(physics, robots[i])
    arena_key = make_key(seed, individual, replicate, len(robots))
    for o in range(len(objects)):
        u = draw(arena_key, o, START_OBJECT_X)
        place_object(physics, objects, o, u, draw(arena_key, o, START_OBJECT_Y))


@inlined
def _start_band(physics: Physics) -> tuple[float, float]:
    """Southernmost and northernmost y at which robots start: in the nest, clear of the walls."""
    south = physics.radius - physics.half_length
    return south, min(physics.nest_edge, physics.half_length - physics.radius)


@inlined
def _scatter(physics: Physics, robots: Any, slots: Any, starts: Any) -> bool:
    """Place all robots at random, clear of each other; False if one finds no place."""
    starts[:] = -1
    reach_x = physics.half_width - physics.radius
    south, north = _start_band(physics)
    for i in range(len(robots)):
        robot = robots[i]
        clear = False
        for attempt in range(PLACEMENT_ATTEMPTS):
            robot.x = reach_x * (2.0 * draw(robot.key, attempt, START_X) - 1.0)
            robot.y = south + (north - south) * draw(robot.key, attempt, START_Y)
            clear = is_clear(physics, robots, slots, starts, i)
            if clear:
                break
        if not clear:
            return False
        enter(physics, robots, slots, starts, i)
    return True


@inlined
def _fill_cells(physics: Physics, robots: Any) -> None:
    """Place each robot at random in a cell of its own, at least as wide and deep as a robot.

    There are cells enough: a scenario has no more robots than `robots_in_nest` says.
    """
    diameter = 2.0 * physics.radius
    reach_x = physics.half_width - physics.radius
    south, north = _start_band(physics)
    widest = 1 + int((2.0 * physics.half_width - diameter) / diameter)
    rows = (len(robots) + widest - 1) // widest
    columns = (len(robots) + rows - 1) // rows
    width = 2.0 * physics.half_width / columns
    depth = (north - south + diameter) / rows
    for i in range(len(robots)):
        robot = robots[i]
        u = draw(robot.key, PLACEMENT_ATTEMPTS, START_X) - 0.5
        v = draw(robot.key, PLACEMENT_ATTEMPTS, START_Y) - 0.5
        x = width * (i % columns + 0.5) - physics.half_width + (width - diameter) * u
        y = depth * (i // columns + 0.5) + south - physics.radius + (depth - diameter) * v
        robot.x = min(max(x, -reach_x), reach_x)  # but for rounding they are there already
        robot.y = min(max(y, south), north)


@inlined
def _begin(physics: Physics, robot: Any) -> None:
    """Give a robot that has its place all else that it starts with."""
    theta = 2.0 * math.pi * draw(robot.key, 0, START_HEADING)
    robot.cos = math.cos(theta)
    robot.sin = math.sin(theta)
    robot.behaviour = RANDOM_WALK
    robot.states = WANT_OBJECT
    robot.percepts = 0
    robot.carried = False
    robot.last_rule = -1
    restart_walk(physics, robot, 0, START_WALK, START_WALK_TIME)


@inlined
def place_object(physics: Physics, objects: Any, o: int, u: float, v: float) -> None:
    """Put object o into the source, away from the walls; u and v uniform in [0, 1)."""
    north = physics.half_length - physics.object_margin
    objects[o, 0] = (physics.half_width - physics.object_margin) * (2.0 * u - 1.0)
    objects[o, 1] = physics.source_edge + (north - physics.source_edge) * v


@inlined
def restart_walk(physics: Physics, robot: Any, step: int, heading: int, time: int) -> None:
    """Fresh random-walk heading, to be kept for a fresh time.

    Args:
        physics: Scenario in numbers.
        robot: Updated in place.
        step: Control step.
        heading: Purpose of the draw of the heading.
        time: Purpose of the draw of the time.
    """
    angle = 2.0 * math.pi * draw(robot.key, step, heading)
    robot.walk_x = math.cos(angle)
    robot.walk_y = math.sin(angle)
    longer = (physics.walk_max - physics.walk_min) * draw(robot.key, step, time)
    robot.walk_until = step + (physics.walk_min + longer) / physics.control_step
