"""Components that GESwarm does not come with."""

from geswarm.sim.kernels.single import ONE, ZERO, F, I, fma
from geswarm.sim.terms import avoidance, objects
from geswarm.sim.terms.component import (
    Behaviour,
    Register,
    behaviour,
    count,
    measure,
    sensor,
    vector_sum,
)
from geswarm.sim.terms.parts import Parts

STAY = 1


@count("near")
def is_near(d2, rab_range):
    return d2 < rab_range * rab_range


@vector_sum("apart")
def unit_vectors(d2, per_d, rab_range, other_near_now):
    return per_d if d2 < rab_range * rab_range else ZERO * F(other_near_now)


@sensor(values=8)
def neighbours(near):
    return near if near < I(7) else I(7)


@behaviour(paced=True)
def stop(cos, sin):
    return cos, sin, ZERO


@behaviour(arguments=("gain",))
def attraction(gain, apart_x, apart_y, cos, sin):
    return fma(-gain, apart_x, cos), fma(-gain, apart_y, sin)


@measure()
def together(near):
    return I(near > I(0))


@measure(at="end")
def at_the_end(near):
    return I(near > I(0))


def phototaxis(x, y):
    return x, y


phototaxis = Behaviour(phototaxis)


@behaviour()
def goes_nowhere(hither):
    return hither, ONE


GATHERING = Parts(
    "gathering",
    sensors=(neighbours,),
    behaviours=(stop, attraction),
    first=stop,
    bounds=avoidance.box,
    registers=(Register("near_now"),),
    sums=(is_near, unit_vectors),
    measures=(together, at_the_end),
)
ALONE = Parts(
    "alone",
    sensors=(objects.wants_object,),
    behaviours=(stop,),
    first=stop,
    bounds=avoidance.box,
    registers=(Register("want_object"),),
    sums=(is_near,),
)
WRONG = Parts(
    "wrong",
    sensors=(objects.wants_object,),
    behaviours=(goes_nowhere,),
    first=goes_nowhere,
    bounds=avoidance.box,
    registers=(Register("want_object"),),
)
