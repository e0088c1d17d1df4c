"""Going to the light and away from it; how bright it is."""

from __future__ import annotations

from geswarm.rules.vocabulary import FORAGING
from geswarm.sim.bodies import FOOT_BOT
from geswarm.sim.kernels.single import I
from geswarm.sim.terms.component import Integer, Real
from geswarm.sim.terms.declare import behaviour, percept, sensor

BODY = FOOT_BOT
"""The robots that these terms are for."""


@behaviour(FORAGING.behaviour_names["PHOTOTAXIS"])
def phototaxis(to_light_x: Real, to_light_y: Real) -> tuple[Real, Real]:
    """Towards the light."""
    return to_light_x, to_light_y


@behaviour(FORAGING.behaviour_names["ANTI-PHOTOTAXIS"])
def anti_phototaxis(to_light_x: Real, to_light_y: Real) -> tuple[Real, Real]:
    """Away from the light."""
    return -to_light_x, -to_light_y


@sensor(values=8)
def light_level(brightness: Real) -> Integer:
    """Sum of intensity / (1 + (distance in m)^2) over the lamps, rounded down, at most 7."""
    level = I(brightness)
    return level if level < I(7) else I(7)


LIGHT = percept("LIGHT", light_level, holds="with a light level of {comparison} {value}")
