"""The second half of a control step: target, wheels, motion."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.draws import WALK_HEADING, WALK_TIME
from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.placement import restart_walk
from geswarm.sim.kernels.state import ANTI_PHOTOTAXIS, RANDOM_WALK, Physics

STRAIGHT_BEHIND = 1e-9
"""A target that is behind the robot to within this angle (rad) is turned to by the left.

A robot that drives towards the light until its heading is exact, and then is to drive away from it,
would else turn by the left or by the right according to the last bit of a rounding error, which
differs between machines.
"""


@inlined
def _angle(x: float, y: float) -> float:
    """atan2(y, x) to 2e-14, without branches, which is what makes it fast; (0, 0) has angle 0.

    The ratio of the smaller to the larger coordinate is brought down to tan(pi / 8) by the addition
    theorem; the polynomial interpolates the arctangent at Chebyshev nodes.
    """
    low, high = min(abs(x), abs(y)), max(abs(x), abs(y))
    beyond = low > 0.41421356237309503 * high
    z = (low - high if beyond else low) / (low + high if beyond else high)
    q = z * z
    q2 = q * q
    q4 = q2 * q2
    low_terms = (0.9999999999999732 - 0.33333333330803444 * q) + q2 * (
        0.19999999604891977 - 0.14285690423839287 * q
    )
    high_terms = (0.11110385046148014 - 0.09078392072943424 * q) + q2 * (
        0.07563703551915192 - 0.05874505621307831 * q
    )
    series = low_terms + q4 * (high_terms + q4 * 0.030662440370424447)
    angle = z * series + (math.pi / 4.0 if beyond else 0.0)
    angle = math.pi / 2.0 - angle if abs(y) > abs(x) else angle
    angle = math.pi - angle if x < 0.0 else angle
    return math.copysign(angle, y) if high > 0.0 else 0.0


@inlined
def _cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine; series for the small turns of one control step."""
    if abs(angle) > 0.2:
        return math.cos(angle), math.sin(angle)
    q = angle * angle
    q2 = q * q
    cos = (1 - q / 2) + q2 * ((1 / 24 - q * (1 / 720)) + q2 * (1 / 40320 - q * (1 / 3628800)))
    sin = (1 - q * (1 / 6)) + q2 * ((1 / 120 - q * (1 / 5040)) + q2 * (1 / 362880))
    return cos, angle * sin


@inlined
def _target(physics: Physics, robot: Any, step: int) -> tuple[float, float]:
    """Target vector of the behaviour plus the avoidance vector."""
    x, y = robot.x, robot.y
    if robot.behaviour == RANDOM_WALK:
        if step >= robot.walk_until:
            restart_walk(physics, robot, step, WALK_HEADING, WALK_TIME)
        tx, ty = robot.walk_x, robot.walk_y
    else:
        dy = physics.light_y - y
        scale = 1.0 / math.sqrt(x * x + dy * dy)
        if robot.behaviour == ANTI_PHOTOTAXIS:
            scale = -scale
        tx, ty = -x * scale, dy * scale
    near = physics.radius + physics.proximity_range  # a wall is sensed nearer than this
    per_range = 1.0 / physics.proximity_range
    west = max(0.0, near - (physics.half_width + x))
    east = max(0.0, near - (physics.half_width - x))
    south = max(0.0, near - (physics.half_length + y))
    north = max(0.0, near - (physics.half_length - y))
    tx += physics.avoidance_gain * (robot.away_x + per_range * (west - east))
    ty += physics.avoidance_gain * (robot.away_y + per_range * (south - north))
    return tx, ty


@inlined
def move(physics: Physics, robot: Any, step: int) -> None:
    """Wheel speeds from the target vector (Turgut et al. 2008); rotate, then advance."""
    tx, ty = _target(physics, robot, step)
    cos, sin = robot.cos, robot.sin
    ahead = tx * cos + ty * sin
    left = ty * cos - tx * sin
    length = math.sqrt(ahead * ahead + left * left)
    alpha = _angle(ahead, left)
    if alpha < STRAIGHT_BEHIND - math.pi:
        alpha += 2.0 * math.pi
    forward = physics.max_speed * (max(0.0, ahead / length) if length > 0.0 else 1.0)
    turn = physics.turn_gain * alpha
    fastest = forward + abs(turn) * physics.wheel_base / 2.0
    if fastest > physics.max_speed:
        forward *= physics.max_speed / fastest
        turn *= physics.max_speed / fastest
    c, s = _cos_sin(turn * physics.control_step)
    robot.cos, robot.sin = cos * c - sin * s, sin * c + cos * s
    robot.x += forward * physics.control_step * robot.cos
    robot.y += forward * physics.control_step * robot.sin
