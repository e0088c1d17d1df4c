"""Walking at random, with a heading that is kept for a while; standing still."""

from __future__ import annotations

from geswarm.rules.arguments import Number
from geswarm.rules.vocabulary import FORAGING
from geswarm.sim.bodies import FOOT_BOT
from geswarm.sim.kernels.single import ZERO, F, I, fma, fraction, heading
from geswarm.sim.terms.component import Bits, Integer, Real
from geswarm.sim.terms.declare import behaviour, condition, update

BODY = FOOT_BOT
"""The robots that these terms are for."""


@update(writes={"walk_x": F, "walk_y": F, "walk_until": I}, draws=("walk_heading", "walk_time"))
def new_heading(
    walk_heading: Bits,
    walk_time: Bits,
    step: Integer,
    walk_min: Real,
    walk_max: Real,
    control_step: Real,
) -> tuple[Real, Real, Integer]:
    """Uniformly random unit vector, and the control step at which its random time ends."""
    x, y = heading(walk_heading)
    longer = (walk_max - walk_min) / control_step
    kept = fma(longer, fraction(walk_time), walk_min / control_step)
    return x, y, I(I(step + I(1)) + I(kept))


@condition
def is_over(walk_until: Integer, step: Integer) -> Integer:
    """Whether the heading's time has ended."""
    return I(step >= walk_until)


@behaviour(FORAGING.behaviour_names["RANDOM_WALK"], start=new_heading, again=is_over)
def random_walk(walk_x: Real, walk_y: Real) -> tuple[Real, Real]:
    """A random heading, kept for a random time (paper, section 3.1.1)."""
    return walk_x, walk_y


@update(
    writes={"wander_x": F, "wander_y": F, "wander_until": I},
    draws=("wander_heading", "wander_time"),
)
def new_wander_heading(
    wander_heading: Bits,
    wander_time: Bits,
    step: Integer,
    shortest: Real,
    longest: Real,
    control_step: Real,
) -> tuple[Real, Real, Integer]:
    """Uniformly random unit vector, and the control step at which its random time ends."""
    x, y = heading(wander_heading)
    longer = longest - shortest if longest > shortest else ZERO
    kept = fma(longer, fraction(wander_time), shortest) / control_step
    return x, y, I(I(step + I(1)) + I(kept))


@condition
def wander_is_over(wander_until: Integer, step: Integer) -> Integer:
    """Whether the heading's time has ended."""
    return I(step >= wander_until)


@behaviour(
    "RANDOM_WALK",
    Number("shortest", 0.0, 20.0, 1.0, unit="s"),
    Number("longest", 5.0, 60.0, 5.0, unit="s"),
    doing="walking at random, {shortest} to {longest} s a heading",
    starting="start walking at random, {shortest} to {longest} s a heading",
    start=new_wander_heading,
    again=wander_is_over,
)
def random_walk_for(wander_x: Real, wander_y: Real) -> tuple[Real, Real]:
    """The same, with the shortest and the longest time that a heading is kept (s)."""
    return wander_x, wander_y


@behaviour("STOP", doing="standing still", starting="stop", paced=True)
def stop(cos: Real, sin: Real) -> tuple[Real, Real, Real]:
    """Standing still."""
    return cos, sin, ZERO
