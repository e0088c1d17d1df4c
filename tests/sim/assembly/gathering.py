"""Components that GESwarm does not come with."""

from geswarm.rules.arguments import Number
from geswarm.rules.declarations import InternalStateName
from geswarm.sim.kernels.single import ONE, ZERO, F, I, fma
from geswarm.sim.terms import objects
from geswarm.sim.terms.component import Behaviour, Register
from geswarm.sim.terms.declare import behaviour, count, measure, percept, sensor, vector_sum
from tests.sim.assembly.made import parts_of

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


@behaviour("STOP", paced=True)
def stop(cos, sin):
    return cos, sin, ZERO


@behaviour("ATTRACTION", Number("gain", 1.0, 5.0, 0.5))
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


@behaviour("GO_NOWHERE")
def goes_nowhere(hither):
    return hither, ONE


GATHERING = parts_of(
    "gathering",
    percepts=(percept("NEIGHBOURS", neighbours),),
    behaviours=(stop, attraction),
    first=stop,
    registers=(Register(InternalStateName("NEAR_NOW", "be near")),),
    sums=(is_near, unit_vectors),
    measures=(together, at_the_end),
)
ALONE = parts_of(
    "alone",
    percepts=(),
    behaviours=(stop,),
    first=stop,
    registers=(objects.WANT_OBJECT,),
    sums=(is_near,),
)
WRONG = parts_of(
    "wrong",
    percepts=(),
    behaviours=(goes_nowhere,),
    first=goes_nowhere,
    registers=(objects.WANT_OBJECT,),
)
