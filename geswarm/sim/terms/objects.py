"""Objects that are picked up and dropped."""

from __future__ import annotations

from geswarm.rules.vocabulary import FORAGING
from geswarm.sim.kernels.single import F, I
from geswarm.sim.terms.component import Integer, Percept, Real, Register
from geswarm.sim.terms.declare import effect, measure, percept, sensor, update


@sensor()
def has_object(carried: Integer) -> Integer:
    """Whether the robot holds an object."""
    return carried


@sensor()
def wants_object(want_object: Integer) -> Integer:
    """The register that decides whether objects are picked up."""
    return want_object


@sensor()
def object_in_sight(object_near: Integer) -> Integer:
    """Whether an object lies within `object_range`."""
    return object_near


SEES_OBJECT = percept(
    "SEES_OBJECT", object_in_sight, holds="seeing an object", fails="seeing no object"
)
HAS_OBJECT = Percept(FORAGING.percepts["HAS_OBJECT"], has_object, bool)
WANT_OBJECT = Register(FORAGING.state_names["WANT_OBJECT"], seen_by=wants_object)
DROP_OBJECT = Register(FORAGING.state_names["DROP_OBJECT"])


@update(writes={"carried": I})
def let_go() -> Integer:
    """The object is gone."""
    return I(0)


@effect(then=let_go)
def drop(carried: Integer, drop_object: Integer) -> Integer:
    """A carried object is dropped."""
    return I(carried & drop_object)


@update(writes={"carried": I, "object_x": F, "object_y": F}, draws=("object_x", "object_y"))
def take(fresh_x: Real, fresh_y: Real) -> tuple[Integer, Real, Real]:
    """The object is held; a new one appears at a uniformly random place in the source."""
    return I(1), fresh_x, fresh_y


@effect(then=take, nearest="grip_reach")
def pick_up(carried: Integer, want_object: Integer) -> Integer:
    """The nearest object within reach is taken."""
    return I(want_object & I(I(1) - carried))


@measure(at=pick_up, unit="objects")
def picked() -> Integer:
    """Objects picked up."""
    return I(1)


@measure(at=drop, unit="objects")
def collected(in_nest: Integer) -> Integer:
    """Objects dropped inside the nest."""
    return in_nest


@measure(at=drop, unit="objects")
def lost(in_nest: Integer) -> Integer:
    """Objects dropped outside the nest."""
    return I(I(1) - in_nest)
