"""Keeping away from walls, obstacles and other robots."""

from __future__ import annotations

from geswarm.sim.bodies import FOOT_BOT
from geswarm.sim.kernels.single import ONE, ZERO, fma
from geswarm.sim.terms.component import Real
from geswarm.sim.terms.declare import steering, vector_sum

BODY = FOOT_BOT
"""The robots that these terms are for."""


@vector_sum("away")
def away_from_robot(d2: Real, per_d: Real, avoidance_range: Real) -> Real:
    """(1 - d / range) along the line away from a robot nearer than the range."""
    strength = per_d - ONE / avoidance_range
    return strength if d2 < avoidance_range * avoidance_range else ZERO


@steering("avoidance_gain")
def avoid(
    push_x: Real, push_y: Real, away_x: Real, away_y: Real, proximity_range: Real
) -> tuple[Real, Real]:
    """Away from the other robots, and (1 - d / range) from each wall nearer than that."""
    per_range = ONE / proximity_range
    return fma(per_range, push_x, away_x), fma(per_range, push_y, away_y)
