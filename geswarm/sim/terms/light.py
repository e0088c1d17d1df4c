"""Going to the light and away from it."""

from __future__ import annotations

import math

from geswarm.sim.kernels.single import ONE, F, fma
from geswarm.sim.terms.component import Real, behaviour


@behaviour()
def phototaxis(x: Real, y: Real, light_y: Real) -> tuple[Real, Real]:
    """Towards the light, which is on the line x = 0."""
    north = light_y - y
    per_distance = ONE / F(math.sqrt(fma(x, x, north * north)))
    return -x * per_distance, north * per_distance


@behaviour()
def anti_phototaxis(x: Real, y: Real, light_y: Real) -> tuple[Real, Real]:
    """Away from the light."""
    north = light_y - y
    per_distance = ONE / F(math.sqrt(fma(x, x, north * north)))
    return x * per_distance, -north * per_distance
