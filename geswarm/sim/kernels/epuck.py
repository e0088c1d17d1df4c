"""The e-puck as ARGoS models it and AutoMoDe's reference model 1.2 sums it up: numbers of a robot.

What is what was measured of the real stack (argos3-epuck 48, demiurge-epuck-dao); lengths in
metres. Eight rays look for obstacles, but their readings count as if they looked elsewhere:
`RAYS` and `READINGS`, degrees counter-clockwise from straight ahead.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import called, inlined
from geswarm.sim.kernels.single import HALF, ONE, TWO, ZERO, F, I, U, above_zero, angle_of, fma

RAYS = tuple(11.25 + 45.0 * ray for ray in range(8))
READINGS = tuple(
    math.degrees(math.remainder(math.pi / part, 2.0 * math.pi))
    for part in (10.5884, 3.5999, 2.0, 1.2, 0.8571, 0.6667, 0.5806, 0.5247)
)
RAY_BEGINS, RAY_LENGTH = F(0.036), F(0.05)
FAR_RAY = F(9.0)
"""Length of a ray that meets nothing."""

BLOCK = 32
"""Bodies that are looked at at once; LLVM makes no vectors of shorter loops."""
AWAY = F(1e6)
"""Where no body is (m)."""

_AXES = tuple(
    (F(math.cos(math.radians(angle))), F(math.sin(math.radians(angle)))) for angle in RAYS[:4]
)
"""Directions of the first four rays; the others are opposite to them."""

_C0, _C1, _C2 = F(1.08212), F(-36.8961), F(298.701)
_SUB_STEP = F(0.01)
_TENTH = F(0.1)
_PER_2_16, _PER_2_10 = F(2.0**-16), F(2.0**-10)
_GAUSSIAN = F(1.0 / math.sqrt(4.0 * (256.0**2 - 1.0) / 12.0))
_LEAST_VECTOR = F(0.1 * 0.1)
_HALF_TURN = F(math.pi)
_BLACK, _WHITE = F(0.03), F(0.85)
_LIT = F(0.2)
_FULL_VOTES = I(10)


@inlined
def gaussian(bits: Any) -> Any:
    """A number of mean 0 and deviation 1, nearly normal: the sum of four bytes."""
    bits = U(bits)
    low = I(U(bits & U(0xFF))) + I(U(U(bits >> U(8)) & U(0xFF)))
    high = I(U(U(bits >> U(16)) & U(0xFF))) + I(U(bits >> U(24)))
    return (F(I(low + high)) - F(510.0)) * _GAUSSIAN


@inlined
def spread(bits: Any, half: int, reach: Any) -> Any:
    """A number between -reach and reach, from the lower (0) or upper (1) half of random bits."""
    sixteen = U(U(bits) >> U(16 * half)) & U(0xFFFF)
    return fma(F(I(sixteen)), TWO * reach * _PER_2_16, -reach)


@inlined
def wheels_for(ahead: Any, left: Any, max_speed: Any) -> tuple[Any, Any]:
    """Speeds of the left and the right wheel for a vector in the robot's frame (AutoMoDe).

    The outer wheel turns at full speed, the inner one at the cosine of the vector's angle; a vector
    shorter than 0.1 is straight on.
    """
    length2 = fma(ahead, ahead, left * left)
    cos = ahead / F(math.sqrt(length2)) if length2 >= _LEAST_VECTOR else ONE
    inner, outer = max_speed * cos, max_speed
    to_left = I(I(left > ZERO) & I(length2 >= _LEAST_VECTOR)) != I(0)
    return inner if to_left else outer, outer if to_left else inner


@inlined
def free_way(was: Any, change: Any, sub_steps: Any) -> Any:
    """Way of a step along one axis, from its speed before, by how much that changes and in what.

    In each hundredth of a second the robot goes on first, then its speed comes nearer to the target
    by an equal part, `sub_steps` of which make up the whole.
    """
    full = F(I(sub_steps))  # parts that are as large as the motors can
    full = full if full < F(9.0) else F(9.0)
    parts = HALF * full * (full + ONE) / sub_steps if sub_steps > ZERO else ZERO
    return _TENTH * was + _SUB_STEP * change * (parts + F(9.0) - full)


@inlined
def curve(distance: Any) -> Any:
    """Reading of a proximity sensor whose ray meets something at a distance."""
    reading = fma(distance, fma(distance, _C2, _C1), _C0)
    reading = reading if distance <= RAY_LENGTH else ZERO
    return between_0_and_1(reading)


@inlined
def between_0_and_1(x: Any) -> Any:
    """The number, or the nearer end of [0, 1]."""
    x = above_zero(x)
    return x if x < ONE else ONE


@inlined
def wall_distance(per_way: Any) -> Any:
    """How far the ray begins from what it meets, from 1 / the way from the robot's centre."""
    distance = ONE / per_way - RAY_BEGINS if per_way > ZERO else FAR_RAY
    return above_zero(distance)


@called
def see(robot: Any, lane: int, dx: Any, dy: Any, radius: Any) -> None:
    """Shorten the rays that meet another body; one that begins within the body does not meet it.

    Args:
        robot: Whose rays.
        lane: Which simulation.
        dx: Of the other one's centre (m), and so dy.
        dy: See dx.
        radius: Of the body.
    """
    cos, sin = robot.cos[lane], robot.sin[lane]
    ahead, left = dx * cos + dy * sin, dy * cos - dx * sin
    for ray in range(4):
        across = left * _AXES[ray][0] - ahead * _AXES[ray][1]
        inside = radius * radius - across * across
        if inside > ZERO:
            along = ahead * _AXES[ray][0] + left * _AXES[ray][1]
            distance = abs(along) - F(math.sqrt(inside)) - RAY_BEGINS
            at = ray if along >= ZERO else ray + 4
            if ZERO <= distance < robot.rays[at, lane]:
                robot.rays[at, lane] = distance


@inlined
def brightness_at(d2: Any, intensity: Any) -> Any:
    """Reading of a sensor that looks straight at a lamp, d2 being the squared distance to it."""
    x = F(math.sqrt(d2)) / intensity
    return _exponential(-TWO * x) if x <= F(2.5) else ZERO


@inlined
def _exponential(x: Any) -> Any:
    """The exponential function to 1e-5 of its value, for x in [-6, 0]: (e ** (x / 16)) ** 16."""
    y = F(0.0625) * x
    e = fma(y, fma(y, fma(y, fma(y, F(1.0 / 24.0), F(1.0 / 6.0)), HALF), ONE), ONE)
    e = e * e
    e = e * e
    e = e * e
    return e * e


@inlined
def sensed_light(bearing: Any, looks: Any, brightness: Any) -> Any:
    """Reading of the light sensor that looks in a direction; both angles in [-pi, pi]."""
    apart = abs(bearing - looks)
    apart = apart if apart < _HALF_TURN else TWO * _HALF_TURN - apart
    share = fma(apart, F(-2.0 / math.pi), ONE)
    return brightness * above_zero(share)


@inlined
def bearing_of(ahead: Any, left: Any) -> Any:
    """Angle of a vector of any length."""
    length = F(math.sqrt(fma(ahead, ahead, left * left)))
    per_length = ONE / length if length > ZERO else ZERO
    return angle_of(ahead * per_length if length > ZERO else ONE, left * per_length)


@inlined
def unit_if(holds: Any, x: Any, y: Any) -> tuple[Any, Any]:
    """The vector with length 1 if something holds and it has a direction; else none."""
    length2 = fma(x, x, y * y)
    per_length = ONE / F(math.sqrt(length2)) if length2 > ZERO else ZERO
    per_length = per_length if holds else ZERO
    return x * per_length, y * per_length


@inlined
def capped(x: Any, y: Any) -> tuple[Any, Any]:
    """The vector, of length 1 if it is longer."""
    length2 = fma(x, x, y * y)
    share = ONE / F(math.sqrt(length2)) if length2 > ONE else ONE
    return x * share, y * share


@inlined
def is_lit(reading: Any) -> Any:
    """Whether a light sensor's reading counts."""
    return reading > _LIT


@inlined
def ground_votes(level: Any, bits: Any, number: int, noise: Any) -> tuple[Any, Any]:
    """Whether a ground sensor votes for black and for white, by the floor's level of grey."""
    ten = U(U(bits) >> U(10 * number)) & U(0x3FF)
    reading = level + fma(F(I(ten)) + HALF, TWO * noise * _PER_2_10, -noise)
    return I(reading < _BLACK), I(reading > _WHITE)


@inlined
def remember_votes(history: Any, votes: Any) -> Any:
    """The votes of five steps, two bits each."""
    return I(I(I(history << I(2)) | votes) & I(0x3FF))


@inlined
def most_votes(history: Any) -> Any:
    """Whether more than 10 of the 15 votes of five steps are so."""
    total = I(0)
    for at in range(0, 10, 2):
        total = I(total + I(I(history >> I(at)) & I(3)))
    return I(total > _FULL_VOTES)


@inlined
def are_between(
    xs: Any, ys: Any, count: int, x: Any, y: Any, to_x: Any, to_y: Any, to_d2: Any, reach2: Any
) -> Any:
    """Whether some body is on the line from (x, y) to (x + to_x, y + to_y).

    Args:
        xs: Of all centres, in whole blocks of `BLOCK`.
        ys: Of all centres.
        count: How many there are; what is at the ends of the line is not on it.
        x: Beginning of the line, and so y.
        y: See x.
        to_x: From there to the end, and so to_y.
        to_y: See to_x.
        to_d2: Squared length of the line.
        reach2: `to_d2` times the squared radius of a body.
    """
    found = I(0)
    for begin in range(0, count, BLOCK):
        for at in range(BLOCK):
            k = np.uint64(begin + at)
            beside_x, beside_y = xs[k] - x, ys[k] - y
            along = fma(beside_x, to_x, beside_y * to_y)
            across = fma(beside_x, to_y, -beside_y * to_x)
            within = I(I(along > ZERO) & I(along < to_d2))
            found = I(found | I(within & I(across * across < reach2)))
    return found != I(0)


@inlined
def shades(dx: Any, dy: Any, d2: Any, lamp_x: Any, lamp_y: Any, reach: Any, radius: Any) -> Any:
    """Whether a body takes the light: near enough on the line to the lamp, whose ray rises.

    Args:
        dx: Of its centre from the robot, and so dy, d2.
        dy: See dx.
        d2: See dx.
        lamp_x: Unit vector towards the lamp, and so lamp_y.
        lamp_y: See lamp_x.
        reach: How far from the robot the ray is lower than a body (m).
        radius: Of the body.
    """
    along = fma(dx, lamp_x, dy * lamp_y)
    inside = fma(radius, radius, fma(along, along, -d2))  # squared half of the chord
    beyond = along - reach
    near = I(I(beyond <= ZERO) | I(beyond * beyond <= inside))
    outside = I(along * along > inside)  # else the ray begins within it
    return I(I(I(inside > ZERO) & I(along > ZERO)) & I(near & outside))
