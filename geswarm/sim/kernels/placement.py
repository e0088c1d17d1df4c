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
"""How often a robot that would overlap another one is placed anew."""


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
    starts[:] = -1
    for i in range(len(robots)):
        robots[i].key = make_key(seed, individual, replicate, i)
        _start_robot(physics, robots, slots, starts, i)
    arena_key = make_key(seed, individual, replicate, len(robots))
    for o in range(len(objects)):
        u = draw(arena_key, o, START_OBJECT_X)
        place_object(physics, objects, o, u, draw(arena_key, o, START_OBJECT_Y))


@inlined
def _start_robot(physics: Physics, robots: Any, slots: Any, starts: Any, i: int) -> None:
    """Place robot i clear of the walls and, where that is found, of robots 0..i-1."""
    robot = robots[i]
    reach_x = physics.half_width - physics.radius
    south = physics.radius - physics.half_length
    north = min(physics.nest_edge, physics.half_length - physics.radius)
    for attempt in range(PLACEMENT_ATTEMPTS):
        robot.x = reach_x * (2.0 * draw(robot.key, attempt, START_X) - 1.0)
        robot.y = south + (north - south) * draw(robot.key, attempt, START_Y)
        if is_clear(physics, robots, slots, starts, i):
            break
    enter(physics, robots, slots, starts, i)
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
