"""Where robots and objects start, where new objects appear, where a random walk heads."""

from __future__ import annotations

import math

from numba import njit

XX

PLACEMENT_ATTEMPTS = 200
"""How often a robot that would overlap another one is placed anew."""


@njit
def start(physics: Physics, swarm: Swarm, seed: int, individual: int, replicate: int) -> None:
    """Robots at random poses in the nest, walking at random; objects at random in the source."""
    for i in range(len(swarm.x) + 1):
        make_key(swarm.key[i], seed, individual, replicate, i)
    for i in range(len(swarm.x)):
        _start_robot(physics, swarm, i)
    for o in range(len(swarm.object_x)):
        u = draw(swarm.key[-1], o, START_OBJECT_X)
        place_object(physics, swarm, o, u, draw(swarm.key[-1], o, START_OBJECT_Y))
    swarm.tally[:] = 0


@njit
def _start_robot(physics: Physics, swarm: Swarm, i: int) -> None:
    """Place robot i clear of the walls and, where that is found, of robots 0..i-1."""
    key = swarm.key[i]
    reach_x = physics.half_width - physics.radius
    south = physics.radius - physics.half_length
    north = min(physics.nest_edge, physics.half_length - physics.radius)
    for attempt in range(PLACEMENT_ATTEMPTS):
        swarm.x[i] = reach_x * (2.0 * draw(key, attempt, START_X) - 1.0)
        swarm.y[i] = south + (north - south) * draw(key, attempt, START_Y)
        clear = True
        for j in range(i):
            gap = math.hypot(swarm.x[i] - swarm.x[j], swarm.y[i] - swarm.y[j])
            clear = clear and gap >= 2.0 * physics.radius
        if clear:
            break
    theta = 2.0 * math.pi * draw(key, 0, START_HEADING)
    swarm.cos[i] = math.cos(theta)
    swarm.sin[i] = math.sin(theta)
    swarm.behaviour[i] = RANDOM_WALK
    swarm.states[i] = WANT_OBJECT
    swarm.percepts[i] = 0
    swarm.carried[i] = False
    u = draw(key, 0, START_WALK)
    walk(physics, swarm, i, 0, u, draw(key, 0, START_WALK_TIME))


@njit
def place_object(physics: Physics, swarm: Swarm, o: int, u: float, v: float) -> None:
    """Put object o into the source, away from the walls; u and v uniform in [0, 1)."""
    reach_x = physics.half_width - physics.object_margin
    north = physics.half_length - physics.object_margin
    swarm.object_x[o] = reach_x * (2.0 * u - 1.0)
    swarm.object_y[o] = physics.source_edge + (north - physics.source_edge) * v


@njit
def walk(physics: Physics, swarm: Swarm, i: int, step: int, u: float, v: float) -> None:
    """Fresh random-walk heading and time to keep it; u and v uniform in [0, 1)."""
    swarm.walk_x[i] = math.cos(2.0 * math.pi * u)
    swarm.walk_y[i] = math.sin(2.0 * math.pi * u)
    seconds = physics.walk_min + (physics.walk_max - physics.walk_min) * v
    swarm.walk_until[i] = step + seconds / physics.control_step


@njit
def restart_walk(physics: Physics, swarm: Swarm, i: int, step: int) -> None:
    u = draw(swarm.key[i], step, WALK_HEADING)
    walk(physics, swarm, i, step, u, draw(swarm.key[i], step, WALK_TIME))
