"""Named parts of the floor, as robots sense them."""

from __future__ import annotations

from geswarm.sim.kernels.single import I
from geswarm.sim.terms.component import Real, Whole, sensor


@sensor(values=4, fails="zone_miss")
def areas(y: Real, nest_edge: Real, source_edge: Real) -> Whole:
    """Which areas the robot's centre is in, as bits: 1 for the nest, 2 for the source."""
    in_nest = I(1) if y < nest_edge else I(0)
    return I(2) if y > source_edge else in_nest
