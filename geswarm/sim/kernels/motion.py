"""The second half of a control step: avoid, move, collide."""

from __future__ import annotations

import math

from numba import njit

XX


@njit
def avoid_robots(physics: Physics, swarm: Swarm) -> bool:
    """Avoidance vector from the other robots, for all; True if some pair may touch in this step."""
    n = len(swarm.x)
    swarm.away_x[:] = 0.0
    swarm.away_y[:] = 0.0
    touch = 2.0 * (physics.radius + physics.max_speed * physics.control_step) + 1e-9
    may_touch = False
    for i in range(n):
        for j in range(i + 1, n):
            dx = swarm.x[i] - swarm.x[j]
            dy = swarm.y[i] - swarm.y[j]
            d2 = dx * dx + dy * dy
            may_touch = may_touch or d2 < touch * touch
            if d2 < physics.rab_range * physics.rab_range:
                d, dx, dy = _apart(dx, dy)
                strength = 1.0 - d / physics.rab_range
                swarm.away_x[i] += strength * dx
                swarm.away_y[i] += strength * dy
                swarm.away_x[j] -= strength * dx
                swarm.away_y[j] -= strength * dy
    return may_touch


@njit
def _apart(dx: float, dy: float) -> tuple[float, float, float]:
    """Distance and unit vector of (dx, dy); east for robots at the very same place."""
    d = math.sqrt(dx * dx + dy * dy)
    if d == 0.0:
        return 0.0, 1.0, 0.0
    return d, dx / d, dy / d


@njit
def _wall(gap: float, proximity_range: float) -> float:
    """Strength of the avoidance of a wall that is `gap` away from the body's edge."""
    return 1.0 - gap / proximity_range if gap < proximity_range else 0.0


@njit
def _angle(x: float, y: float) -> float:
    """atan2(y, x); a series for small angles, because robots mostly drive almost straight on."""
    if x <= 0.0 or abs(y) > 0.1 * x:
        return math.atan2(y, x)
    r = y / x
    q = r * r
    tail = 1.0 / 7.0 - q * (1.0 / 9.0 - q * (1.0 / 11.0 - q * (1.0 / 13.0)))
    return r * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * tail)))


@njit
def _cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine; series for the small turns of one control step."""
    if abs(angle) > 0.2:
        return math.cos(angle), math.sin(angle)
    q = angle * angle
    cos = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))))
    sin = 1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0)))
    return cos, angle * sin


@njit
def _target(physics: Physics, swarm: Swarm, i: int, step: int) -> tuple[float, float]:
    """Target vector of the behaviour plus the avoidance vector."""
    x, y = swarm.x[i], swarm.y[i]
    if swarm.behaviour[i] == RANDOM_WALK:
        if step >= swarm.walk_until[i]:
            restart_walk(physics, swarm, i, step)
        tx, ty = swarm.walk_x[i], swarm.walk_y[i]
    else:
        dy = physics.light_y - y
        scale = 1.0 / math.sqrt(x * x + dy * dy)
        if swarm.behaviour[i] == ANTI_PHOTOTAXIS:
            scale = -scale
        tx, ty = -x * scale, dy * scale
    west = _wall(physics.half_width + x - physics.radius, physics.proximity_range)
    east = _wall(physics.half_width - x - physics.radius, physics.proximity_range)
    south = _wall(physics.half_length + y - physics.radius, physics.proximity_range)
    north = _wall(physics.half_length - y - physics.radius, physics.proximity_range)
    tx += physics.avoidance_gain * (swarm.away_x[i] + west - east)
    ty += physics.avoidance_gain * (swarm.away_y[i] + south - north)
    return tx, ty


@njit
def move(physics: Physics, swarm: Swarm, i: int, step: int) -> None:
    """Wheel speeds from the target vector (Turgut et al. 2008); rotate, then advance."""
    tx, ty = _target(physics, swarm, i, step)
    cos, sin = swarm.cos[i], swarm.sin[i]
    ahead = tx * cos + ty * sin
    left = ty * cos - tx * sin
    length = math.sqrt(ahead * ahead + left * left)
    alpha = _angle(ahead, left)
    forward = physics.max_speed * (max(0.0, ahead / length) if length > 0.0 else 1.0)
    turn = physics.turn_gain * alpha
    fastest = forward + abs(turn) * physics.wheel_base / 2.0
    if fastest > physics.max_speed:
        forward *= physics.max_speed / fastest
        turn *= physics.max_speed / fastest
    c, s = _cos_sin(turn * physics.control_step)
    swarm.cos[i], swarm.sin[i] = cos * c - sin * s, sin * c + cos * s
    swarm.x[i] += forward * physics.control_step * swarm.cos[i]
    swarm.y[i] += forward * physics.control_step * swarm.sin[i]


@njit
def collide(physics: Physics, swarm: Swarm, may_touch: bool) -> None:
    """Push overlapping pairs apart, pair after pair, then clamp everything inside the walls."""
    n = len(swarm.x)
    if may_touch:
        for i in range(n):
            for j in range(i + 1, n):
                dx = swarm.x[i] - swarm.x[j]
                dy = swarm.y[i] - swarm.y[j]
                if dx * dx + dy * dy < 4.0 * physics.radius * physics.radius:
                    d, dx, dy = _apart(dx, dy)
                    push = physics.radius - d / 2.0
                    swarm.x[i] += push * dx
                    swarm.y[i] += push * dy
                    swarm.x[j] -= push * dx
                    swarm.y[j] -= push * dy
    reach_x = physics.half_width - physics.radius
    reach_y = physics.half_length - physics.radius
    for i in range(n):
        swarm.x[i] = min(max(swarm.x[i], -reach_x), reach_x)
        swarm.y[i] = min(max(swarm.y[i], -reach_y), reach_y)
