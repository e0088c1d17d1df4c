"""Walking at random: a heading that is kept for a while."""

from __future__ import annotations

from geswarm.sim.kernels.single import F, I, fma, fraction, heading
from geswarm.sim.terms.component import Bits, Real, Whole, behaviour, condition, update


@update(writes={"walk_x": F, "walk_y": F, "walk_until": I}, draws=("walk_heading", "walk_time"))
def new_heading(
    walk_heading: Bits,
    walk_time: Bits,
    step: Whole,
    walk_min: Real,
    walk_max: Real,
    control_step: Real,
) -> tuple[Real, Real, Whole]:
    """Uniformly random unit vector, and the control step at which its random time ends."""
    x, y = heading(walk_heading)
    longer = (walk_max - walk_min) / control_step
    kept = fma(longer, fraction(walk_time), walk_min / control_step)
    return x, y, I(I(step + I(1)) + I(kept))


@condition
def is_over(walk_until: Whole, step: Whole) -> Whole:
    """Whether the heading's time has ended."""
    return I(step >= walk_until)


@behaviour(start=new_heading, again=is_over)
def random_walk(walk_x: Real, walk_y: Real) -> tuple[Real, Real]:
    """The present heading."""
    return walk_x, walk_y
