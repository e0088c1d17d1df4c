"""What simulations start from: the scenario in numbers, robots; how many make a block."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

RANDOM_WALK = 2
"""Code of the behaviour at the start."""
WANT_OBJECT = 1
"""Bits of the internal states at the start."""


class Physics(NamedTuple):
    """Scenario and robot in numbers; origin at the centre, x east, y north; metres and seconds."""

    half_width: float
    half_length: float
    nest_edge: float  # the nest is south of this y
    source_edge: float  # the source is north of this y
    light_y: float
    zone_miss: float
    grip_reach: float
    object_margin: float
    walk_min: float
    walk_max: float
    max_speed: float
    turn_gain: float
    proximity_range: float
    rab_range: float
    avoidance_gain: float
    radius: float
    wheel_base: float
    control_step: float


ROBOT = np.dtype(
    [
        ("key", np.uint64),  # of the random numbers
        ("x", np.float64),
        ("y", np.float64),
        ("cos", np.float64),  # of the orientation
        ("sin", np.float64),
        ("walk_x", np.float64),  # unit vector of the random walk
        ("walk_y", np.float64),
        ("walk_until", np.float64),  # control steps since the start at which it is over
        ("last_rule", np.int64),  # the rule that fired last, -1 before any
        ("behaviour", np.uint8),
        ("states", np.uint8),  # internal-state bits
        ("percepts", np.uint8),  # as perceived in the last step
        ("carried", np.bool_),
    ],
    align=True,
)
"""State of a robot at the start."""

SLOT = np.dtype([("robot", np.int64), ("column", np.int32), ("row", np.int32)], align=True)
"""A robot in the order of the cells of a large swarm's grid."""

LANES = 64
"""Simulations side by side, or robots of one swarm, in one block."""
