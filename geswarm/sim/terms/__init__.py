"""The components that scenarios are composed of, one subject a file; and how to write more.

A Python file beside a scenario imports from here what it needs (README, "Own missions and terms"):

    from geswarm.sim.terms import I, Integer, Real, Whole, count, percept, sensor

    @count("beside")
    def is_beside(d2: Real, rab_range: Real) -> Integer:
        return I(d2 < rab_range * rab_range)
"""

from geswarm.rules.arguments import Choice, Number, Whole
from geswarm.sim.kernels.single import (
    HALF,
    ONE,
    TWO,
    ZERO,
    F,
    I,
    above_zero,
    fma,
    fraction,
    heading,
    inverse_root,
    within,
)
from geswarm.sim.terms.component import Bits, Integer, Places, Real
from geswarm.sim.terms.declare import (
    behaviour,
    condition,
    count,
    measure,
    percept,
    places_measure,
    register,
    sensor,
    swarm_measure,
    total,
    update,
    vector_sum,
)

__all__ = [
    "HALF",
    "ONE",
    "TWO",
    "ZERO",
    "Bits",
    "Choice",
    "F",
    "I",
    "Integer",
    "Number",
    "Places",
    "Real",
    "Whole",
    "above_zero",
    "behaviour",
    "condition",
    "count",
    "fma",
    "fraction",
    "heading",
    "inverse_root",
    "measure",
    "percept",
    "places_measure",
    "register",
    "sensor",
    "swarm_measure",
    "total",
    "update",
    "vector_sum",
    "within",
]
