"""Other robots: how many are near, going to them and away from them; what is in the way."""

from __future__ import annotations

from geswarm.rules.arguments import Number, Whole
from geswarm.sim.bodies import FOOT_BOT
from geswarm.sim.kernels.single import ONE, TWO, ZERO, F, I
from geswarm.sim.terms.component import Integer, Real
from geswarm.sim.terms.crowd import crowd_percepts
from geswarm.sim.terms.declare import behaviour, count, percept, sensor, vector_sum

BODY = FOOT_BOT
"""The robots that these terms are for."""

_CM = F(100.0)


@count("near")
def is_neighbour(d2: Real, rab_range: Real) -> Integer:
    """Whether another robot is within range."""
    return I(d2 < rab_range * rab_range)


@sensor(values=8)
def neighbours(near: Integer) -> Integer:
    """Robots within `rab_range`, at most 7."""
    return near if near < I(7) else I(7)


NEIGHBOURS = percept("NEIGHBOURS", neighbours, holds="with {comparison} {value} robots near")
IS_CLOSE_TO = percept(
    "IS_CLOSE_TO",
    neighbours,
    Whole("k", 1, 7, "robots"),
    truth=lambda near, k: near >= k,
    holds="close to at least {k} robots",
    fails="close to fewer than {k} robots",
)


@sensor(values=21)
def heard(near: Integer) -> Integer:
    """Robots within `rab_range`, at most 20."""
    return near if near < I(20) else I(20)


CROWDED, ALONE = crowd_percepts(heard, "with {} robots near")


@count("in_the_way")
def is_in_the_way(d2: Real, radius: Real, proximity_range: Real) -> Integer:
    """Whether another robot's body is within the range of the proximity sensors."""
    reach = TWO * radius + proximity_range
    return I(d2 < reach * reach)


@sensor()
def obstacle(in_the_way: Integer, push_x: Real, push_y: Real) -> Integer:
    """Whether a wall, an obstacle or a robot is within `proximity_range` of the body."""
    wall = I(I(push_x != ZERO) | I(push_y != ZERO))
    return I(wall | I(in_the_way > I(0)))


SEES_OBSTACLE = percept(
    "SEES_OBSTACLE", obstacle, holds="seeing an obstacle", fails="seeing no obstacle"
)


@vector_sum("from_others")
def pull(d2: Real, per_d: Real, rab_range: Real) -> Real:
    """Unit vector from another robot within range, over 1 + the distance in cm (AutoMoDe)."""
    strength = per_d / (ONE + _CM * d2 * per_d)
    return strength if d2 < rab_range * rab_range else ZERO


@behaviour(
    "ATTRACTION",
    Number("gain", 1.0, 5.0, 0.5),
    doing="going to other robots (gain {gain})",
    starting="go to other robots (gain {gain})",
)
def attraction(gain: Real, from_others_x: Real, from_others_y: Real) -> tuple[Real, Real]:
    """To the robots within range: for each, gain / (1 + distance in cm); straight on if alone."""
    return -gain * from_others_x, -gain * from_others_y


@behaviour(
    "REPULSION",
    Number("gain", 1.0, 5.0, 0.5),
    doing="going away from other robots (gain {gain})",
    starting="go away from other robots (gain {gain})",
)
def repulsion(gain: Real, from_others_x: Real, from_others_y: Real) -> tuple[Real, Real]:
    """Away from the robots within range: for each, gain / (1 + distance in cm)."""
    return gain * from_others_x, gain * from_others_y
