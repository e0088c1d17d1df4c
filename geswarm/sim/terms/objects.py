"""Objects that are picked up and dropped."""

from __future__ import annotations

from geswarm.sim.kernels.single import ONE, TWO, F, I, fma, fraction
from geswarm.sim.terms.component import Bits, Real, Whole, effect, measure, sensor, update


@sensor()
def has_object(carried: Whole) -> Whole:
    """Whether the robot holds an object."""
    return carried


@sensor()
def wants_object(want_object: Whole) -> Whole:
    """The register that decides whether objects are picked up."""
    return want_object


@update(writes={"carried": I})
def let_go() -> Whole:
    """The object is gone."""
    return I(0)


@effect(then=let_go)
def drop(carried: Whole, drop_object: Whole) -> Whole:
    """A carried object is dropped."""
    return I(carried & drop_object)


@update(writes={"carried": I, "object_x": F, "object_y": F}, draws=("object_x", "object_y"))
def take(
    object_x: Bits,
    object_y: Bits,
    half_width: Real,
    half_length: Real,
    object_margin: Real,
    source_edge: Real,
) -> tuple[Whole, Real, Real]:
    """The object is held; a new one appears at a uniformly random place in the source."""
    north = half_length - object_margin
    east = half_width - object_margin
    x = east * (TWO * fraction(object_x) - ONE)
    return I(1), x, fma(north - source_edge, fraction(object_y), source_edge)


@effect(then=take, nearest="grip_reach")
def pick_up(carried: Whole, want_object: Whole) -> Whole:
    """The nearest object within reach is taken."""
    return I(want_object & I(I(1) - carried))


@measure(at=pick_up)
def picked() -> Whole:
    """Objects picked up."""
    return I(1)


@measure(at=drop)
def collected(y: Real, nest_edge: Real) -> Whole:
    """Objects dropped inside the nest."""
    return I(y < nest_edge)


@measure(at=drop)
def lost(y: Real, nest_edge: Real) -> Whole:
    """Objects dropped outside the nest."""
    return I(I(1) - I(y < nest_edge))
