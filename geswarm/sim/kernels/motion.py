"""How robots move: wheels, rotation, advance, and bodies that push each other apart."""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.single import (
    HALF,
    ONE,
    TWO,
    ZERO,
    F,
    above_zero,
    angle_of,
    cos_sin,
    fma,
    half_turns,
)


@inlined
def wheels(
    to_x: Any,
    to_y: Any,
    cos: Any,
    sin: Any,
    max_speed: Any,
    turn_gain: Any,
    wheel_base: Any,
    control_step: Any,
) -> tuple[Any, Any]:
    """Angle (rad) and way (m) of one step, from the target vector (Turgut et al. 2008).

    A target of length zero is straight ahead.
    """
    ahead = fma(to_x, cos, to_y * sin)
    left = fma(to_y, cos, -to_x * sin)
    length = F(math.sqrt(fma(ahead, ahead, left * left)))
    forward = ahead / length if length > ZERO else ONE
    sideways = left / length if length > ZERO else ZERO
    speed = max_speed * above_zero(forward)
    turn = turn_gain * angle_of(forward, sideways)
    slowed = max_speed / fma(abs(turn), HALF * wheel_base, speed)
    seconds = control_step * (slowed if slowed < ONE else ONE)
    return turn * seconds, speed * seconds


@inlined
def turn(cos: Any, sin: Any, angle: Any) -> Any:
    """Direction after a turn of at most a quarter, and what makes its length 1 again."""
    return _turned(cos, sin, *cos_sin(angle))


@inlined
def turn_far(cos: Any, sin: Any, angle: Any) -> Any:
    """Direction after a turn of any angle, and what makes its length 1 again."""
    c, s = cos_sin(HALF * half_turns(angle))
    return _turned(cos, sin, fma(-TWO * s, s, ONE), TWO * s * c)


@inlined
def _turned(cos: Any, sin: Any, c: Any, s: Any) -> tuple[Any, Any, Any]:
    cos, sin = fma(cos, c, -sin * s), fma(sin, c, cos * s)
    return cos, sin, fma(-HALF, fma(cos, cos, sin * sin), F(1.5))  # rounding must not add up


@inlined
def advance_exactly(high: Any, low: Any, way: Any, along: Any) -> tuple[Any, Any]:
    """A coordinate with its low part after a way; nothing is lost, however far from the origin."""
    step = fma(way, along, low)
    place = high + step
    behind = place - high
    return place, (high - (place - behind)) + (step - behind)


@inlined
def pushed_apart(dx: Any, dy: Any, d2: Any, radius: Any) -> tuple[Any, Any]:
    """By how much a pair moves: half of its overlap; eastwards if it is at the very same place."""
    d = F(math.sqrt(d2))
    push = radius - HALF * d if d2 < TWO * TWO * radius * radius else ZERO
    along_x = dx / d if d > ZERO else ONE
    along_y = dy / d if d > ZERO else ZERO
    return push * along_x, push * along_y


@inlined
def push_apart(one: Any, i: int, other: Any, j: int, radius: Any) -> None:
    """Move both robots of a pair out of each other, the second one the other way."""
    dx = one.x[i] - other.x[j]
    dy = one.y[i] - other.y[j]
    d2 = fma(dx, dx, dy * dy)
    if d2 >= TWO * TWO * radius * radius:
        return
    push_x, push_y = pushed_apart(dx, dy, d2, radius)
    one.x[i] += push_x
    one.y[i] += push_y
    other.x[j] -= push_x
    other.y[j] -= push_y
