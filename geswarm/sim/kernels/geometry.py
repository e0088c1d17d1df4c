"""Shapes, walls and lights as a robot's centre meets them; single precision, no branches.

What stands in the way is a *surface*: a function that returns how far it is from the robot's centre
(m) and the unit vector from it to the robot, (gap, normal_x, normal_y).
"""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.single import (
    ONE,
    TWO,
    ZERO,
    F,
    I,
    above_zero,
    fma,
    fraction,
    heading,
    within,
)

_NOT_FELT = F(1e30)
_LEAST = F(1e-6)  # square of the distance (m2) below which a lamp does not get brighter


@inlined
def in_disc(x: Any, y: Any, at_x: Any, at_y: Any, radius: Any) -> Any:
    """Whether a place is in a disc, its edge included."""
    dx, dy = x - at_x, y - at_y
    return I(fma(dx, dx, dy * dy) <= radius * radius)


@inlined
def in_box(x: Any, y: Any, at_x: Any, at_y: Any, half_width: Any, half_length: Any) -> Any:
    """Whether a place is in a box that is not turned, its edge included."""
    return I(I(abs(x - at_x) <= half_width) & I(abs(y - at_y) <= half_length))


@inlined
def in_turned(
    x: Any, y: Any, at_x: Any, at_y: Any, half_width: Any, half_length: Any, cos: Any, sin: Any
) -> Any:
    """Whether a place is in a box that is turned, its edge included."""
    dx, dy = x - at_x, y - at_y
    across, along = fma(dx, cos, dy * sin), fma(dy, cos, -dx * sin)
    return in_box(across, along, ZERO, ZERO, half_width, half_length)


@inlined
def crosses(x: Any, y: Any, from_x: Any, from_y: Any, to_y: Any, slope: Any) -> Any:
    """Whether a line from a place to the east crosses a side of a polygon.

    It does so an odd number of times if the place is inside. `slope` is eastwards per northwards.
    """
    spans = I(I(from_y > y) ^ I(to_y > y))
    return I(spans & I(x < fma(slope, y - from_y, from_x)))


@inlined
def box_push(x: Any, y: Any, near: Any, half_width: Any, half_length: Any) -> tuple[Any, Any]:
    """By how much each wall of a box around the origin is nearer than `near`, inwards."""
    near_x, near_y = near - half_width, near - half_length
    push_x = above_zero(near_x - x) - above_zero(near_x + x)
    push_y = above_zero(near_y - y) - above_zero(near_y + y)
    return push_x, push_y


@inlined
def stay_in_box(x: Any, y: Any, reach_x: Any, reach_y: Any) -> tuple[Any, Any]:
    """The nearest place in a box around the origin."""
    return within(x, reach_x), within(y, reach_y)


@inlined
def stay_in_disc(x: Any, y: Any, reach: Any) -> tuple[Any, Any]:
    """The nearest place in a disc around the origin."""
    d2 = fma(x, x, y * y)
    scale = reach / F(math.sqrt(d2)) if d2 > reach * reach else ONE
    return x * scale, y * scale


@inlined
def box_gap(x: Any, y: Any, half_width: Any, half_length: Any) -> Any:
    """How far the nearest wall of a box around the origin is."""
    gap_x, gap_y = half_width - abs(x), half_length - abs(y)
    return gap_x if gap_x < gap_y else gap_y


@inlined
def round_wall(x: Any, y: Any, radius: Any) -> tuple[Any, Any, Any]:
    """Surface: the wall of a disc around the origin, seen from within."""
    d = F(math.sqrt(fma(x, x, y * y)))
    per_d = ONE / d if d > ZERO else ZERO
    return radius - d, -x * per_d, -y * per_d


@inlined
def wall_line(
    x: Any, y: Any, wall_x: Any, wall_y: Any, along_x: Any, along_y: Any
) -> tuple[Any, Any, Any]:
    """Surface: a wall that goes on beyond its ends, from (wall_x, wall_y) with inside to the left.

    Negative gaps are behind it.
    """
    dx, dy = x - wall_x, y - wall_y
    return fma(dy, along_x, -dx * along_y), -along_y, along_x


@inlined
def wall_ahead(
    x: Any, y: Any, wall_x: Any, wall_y: Any, along_x: Any, along_y: Any, length: Any
) -> tuple[Any, Any, Any]:
    """Surface: a wall as felt by who stands before it; its first end belongs to it, not its last.

    So of two walls that meet, no point is felt twice.
    """
    dx, dy = x - wall_x, y - wall_y
    along, gap = fma(dx, along_x, dy * along_y), fma(dy, along_x, -dx * along_y)
    ahead = I(I(along >= ZERO) & I(I(along < length) & I(gap >= ZERO)))
    return gap if ahead != I(0) else _NOT_FELT, -along_y, along_x


@inlined
def corner_ahead(
    x: Any,
    y: Any,
    wall_x: Any,
    wall_y: Any,
    along_x: Any,
    along_y: Any,
    before_x: Any,
    before_y: Any,
) -> tuple[Any, Any, Any]:
    """Surface: the corner at which a wall begins, as felt by who stands before neither wall.

    Both walls point away from who stands there: he is before the first end of the one and beyond
    the last of the one before, which runs along (before_x, before_y).
    """
    dx, dy = x - wall_x, y - wall_y
    before, beyond = fma(dx, along_x, dy * along_y), fma(dx, before_x, dy * before_y)
    ahead = I(I(before < ZERO) & I(beyond >= ZERO))
    d, normal_x, normal_y = _of(dx, dy)
    return d if ahead != I(0) else _NOT_FELT, normal_x, normal_y


@inlined
def wall(
    x: Any, y: Any, wall_x: Any, wall_y: Any, along_x: Any, along_y: Any, length: Any
) -> tuple[Any, Any, Any]:
    """Surface: a wall between its ends, from whichever side."""
    dx, dy = x - wall_x, y - wall_y
    along = above_zero(fma(dx, along_x, dy * along_y))
    along = along if along < length else length
    gap, normal_x, normal_y = _of(fma(-along, along_x, dx), fma(-along, along_y, dy))
    return gap, normal_x, normal_y


@inlined
def disc(x: Any, y: Any, at_x: Any, at_y: Any, radius: Any) -> tuple[Any, Any, Any]:
    """Surface: a disc, from outside."""
    d, normal_x, normal_y = _of(x - at_x, y - at_y)
    return d - radius, normal_x, normal_y


@inlined
def box(
    x: Any, y: Any, at_x: Any, at_y: Any, half_width: Any, half_length: Any
) -> tuple[Any, Any, Any]:
    """Surface: a box that is not turned, from outside; a gap of 0 is inside."""
    dx, dy = x - at_x, y - at_y
    gap, normal_x, normal_y = _of(dx - within(dx, half_width), dy - within(dy, half_length))
    return gap, normal_x, normal_y


@inlined
def turned(
    x: Any, y: Any, at_x: Any, at_y: Any, half_width: Any, half_length: Any, cos: Any, sin: Any
) -> tuple[Any, Any, Any]:
    """Surface: a box that is turned, from outside; a gap of 0 is inside."""
    dx, dy = x - at_x, y - at_y
    across, along = fma(dx, cos, dy * sin), fma(dy, cos, -dx * sin)
    gap, a, b = _of(across - within(across, half_width), along - within(along, half_length))
    return gap, fma(a, cos, -b * sin), fma(b, cos, a * sin)


@inlined
def _of(dx: Any, dy: Any) -> tuple[Any, Any, Any]:
    """Length and direction of a vector; no direction if it has no length."""
    d = F(math.sqrt(fma(dx, dx, dy * dy)))
    per_d = ONE / d if d > ZERO else ZERO
    return d, dx * per_d, dy * per_d


@inlined
def to_light(x: Any, y: Any, light_x: Any, light_y: Any) -> tuple[Any, Any]:
    """Unit vector towards a light; none right below it."""
    dx, dy = light_x - x, light_y - y
    d2 = fma(dx, dx, dy * dy)
    per_distance = ONE / F(math.sqrt(d2)) if d2 > ZERO else ZERO
    return dx * per_distance, dy * per_distance


@inlined
def to_one_of(
    x: Any, y: Any, light_x: Any, light_y: Any, height: Any, intensity: Any
) -> tuple[Any, Any]:
    """Towards one of several lights, as long as it is bright here."""
    east, north = to_light(x, y, light_x, light_y)
    d2 = _square_of_way(x, y, light_x, light_y, height)
    weight = intensity / (d2 if d2 > _LEAST else _LEAST)
    return weight * east, weight * north


@inlined
def unit(x: Any, y: Any) -> tuple[Any, Any]:
    """The vector with length 1; none if it has no length."""
    _, unit_x, unit_y = _of(x, y)
    return unit_x, unit_y


@inlined
def brightness(x: Any, y: Any, light_x: Any, light_y: Any, height: Any, intensity: Any) -> Any:
    """How bright a light is here: its intensity right at it, half of it at 1 m."""
    return intensity / (ONE + _square_of_way(x, y, light_x, light_y, height))


@inlined
def _square_of_way(x: Any, y: Any, light_x: Any, light_y: Any, height: Any) -> Any:
    dx, dy = light_x - x, light_y - y
    return fma(dx, dx, fma(height, height, dy * dy))


@inlined
def place_in_box(u: Any, v: Any, at_x: Any, half_width: Any, south: Any, depth: Any) -> Any:
    """Uniformly random place in a box, from two times 32 random bits."""
    x = half_width * (TWO * fraction(u) - ONE) + at_x
    return x, fma(depth, fraction(v), south)


@inlined
def place_in_turned(
    u: Any, v: Any, at_x: Any, at_y: Any, half_width: Any, half_length: Any, cos: Any, sin: Any
) -> Any:
    """Uniformly random place in a turned box."""
    a, b = half_width * (TWO * fraction(u) - ONE), half_length * (TWO * fraction(v) - ONE)
    return fma(a, cos, fma(-b, sin, at_x)), fma(b, cos, fma(a, sin, at_y))


@inlined
def place_in_disc(u: Any, v: Any, at_x: Any, at_y: Any, radius: Any) -> Any:
    """Uniformly random place in a disc."""
    cos, sin = heading(v)
    d = radius * F(math.sqrt(fraction(u)))
    return fma(d, cos, at_x), fma(d, sin, at_y)


@inlined
def place_in_triangles(u: Any, v: Any, numbers: Any) -> Any:
    """Uniformly random place in triangles.

    Args:
        u: 32 random bits, which choose a triangle and how far the place is along one side of it.
        v: 32 random bits.
        numbers: float32, the last ones of which are eight for each triangle, then how many there
            are. The eight are the area of all triangles before it and its own, as shares of the
            whole; a corner; the ways from there to the second and to the third one (x, y each, m).
    """
    u, b = fraction(u), fraction(v)
    first = len(numbers) - 1 - 8 * int(numbers[-1])
    at = len(numbers) - 9
    while at > first and numbers[at] > u:
        at -= 8
    a = (u - numbers[at]) / numbers[at + 1]
    a = a if a < ONE else ONE  # shares are rounded
    beyond = a + b > ONE  # in the other half of a parallelogram
    a, b = ONE - a if beyond else a, ONE - b if beyond else b
    x = fma(b, numbers[at + 6], fma(a, numbers[at + 4], numbers[at + 2]))
    return x, fma(b, numbers[at + 7], fma(a, numbers[at + 5], numbers[at + 3]))
