"""Keeping away from walls and from other robots."""

from __future__ import annotations

from geswarm.sim.kernels.single import ONE, ZERO, above_zero, fma, within
from geswarm.sim.terms.component import Real, bounds, steering, vector_sum


@vector_sum("away")
def away_from_robot(d2: Real, per_d: Real, rab_range: Real) -> Real:
    """(1 - d / range) along the line away from a robot nearer than the range."""
    strength = per_d - ONE / rab_range
    return strength if d2 < rab_range * rab_range else ZERO


@steering("avoidance_gain")
def avoid(
    x: Real,
    y: Real,
    away_x: Real,
    away_y: Real,
    half_width: Real,
    half_length: Real,
    radius: Real,
    proximity_range: Real,
) -> tuple[Real, Real]:
    """Away from the other robots, and (1 - d / range) inwards from each wall nearer than that."""
    near = radius + proximity_range
    per_range = ONE / proximity_range
    near_x, near_y = near - half_width, near - half_length
    push_x = above_zero(near_x - x) - above_zero(near_x + x)
    push_y = above_zero(near_y - y) - above_zero(near_y + y)
    return fma(per_range, push_x, away_x), fma(per_range, push_y, away_y)


@bounds
def box(x: Real, y: Real, half_width: Real, half_length: Real, radius: Real) -> tuple[Real, Real]:
    """Inside four walls."""
    return within(x, half_width - radius), within(y, half_length - radius)
