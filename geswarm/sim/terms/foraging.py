"""What foraging is composed of (paper, section 3.1)."""

from __future__ import annotations

from geswarm.sim.terms import areas, avoidance, light, objects, walk
from geswarm.sim.terms.component import Register
from geswarm.sim.terms.parts import Parts

FORAGING = Parts(
    name="foraging",
    sensors=(areas.areas, objects.has_object, objects.wants_object),
    behaviours=(light.phototaxis, light.anti_phototaxis, walk.random_walk),
    first=walk.random_walk,
    registers=(
        Register("want_object", initially=1, seen_by=objects.wants_object),
        Register("drop_object", momentary=True),
    ),
    sums=(avoidance.away_from_robot,),
    steering=(avoidance.avoid,),
    effects=(objects.drop, objects.pick_up),
    measures=(objects.picked, objects.collected, objects.lost),
    bounds=avoidance.box,
)
"""Robots, objects, a nest and a source."""
