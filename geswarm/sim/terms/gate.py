"""Passages through a gate, in one direction."""

from __future__ import annotations

from geswarm.sim.kernels.single import ZERO, F, I
from geswarm.sim.terms.component import Integer, Real
from geswarm.sim.terms.declare import effect, measure, update


@update(writes={"y_before": F})
def remember_y(y: Real) -> Real:
    """How far north the robot is, for the next step."""
    return y


@effect(then=remember_y)
def step_is_over() -> Integer:
    """In every step."""
    return I(1)


@measure(at=step_is_over, unit="passages")
def passages(in_gate: Integer, y: Real, y_before: Real, step: Integer) -> Integer:
    """Passages over the line y = 0 in the area gate, from north to south less those back."""
    southwards = I(I(y_before > ZERO) & I(y < ZERO))
    northwards = I(I(y_before < ZERO) & I(y > ZERO))
    return I(I(southwards - northwards) * I(in_gate & I(step > I(0))))
