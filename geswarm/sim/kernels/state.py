"""What the kernels work on: codes and bits, the scenario in numbers, records."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

ON_NEST, ON_SOURCE, HAS_OBJECT = 1, 2, 4
"""Percept bits, as `geswarm.rules.vocabulary.FORAGING` numbers them."""
PHOTOTAXIS, ANTI_PHOTOTAXIS, RANDOM_WALK = 0, 1, 2
"""Behaviour codes."""
WANT_OBJECT, DROP_OBJECT = 1, 2
"""Internal-state bits."""
BEHAVIOURS, STATES = 3, 4
"""Number of behaviours and of combinations of internal states."""

PICKED, COLLECTED, LOST = 0, 1, 2
"""Positions in a tally, int64, shape (3,)."""


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
        ("away_x", np.float64),  # avoidance vector from the other robots, in this step
        ("away_y", np.float64),
        ("column", np.int32),  # cell of a large swarm's grid, in this step
        ("row", np.int32),
        ("last_rule", np.int64),  # the rule that fired last, -1 before any
        ("behaviour", np.uint8),
        ("states", np.uint8),  # internal-state bits
        ("percepts", np.uint8),  # as perceived in the last step
        ("carried", np.bool_),
        ("may_touch", np.bool_),  # another robot, in this step
    ],
    align=True,
)
"""State of a robot."""

SLOT = np.dtype([("robot", np.int64), ("column", np.int32), ("row", np.int32)], align=True)
"""A robot in the order of the cells of a large swarm's grid."""

RULE = np.dtype(
    [
        ("enabled", np.int64),  # 0 also if its preconditions contradict each other
        ("sensed", np.int64),  # mask of the percepts that its preconditions name
        ("expected", np.int64),  # their values
        ("behaviours", np.int64),  # mask of the behaviours in which it may be active
        ("first_action", np.int64),
        ("end_action", np.int64),
        ("fired", np.int64),  # how often some action of it was drawn, counted by the kernel
    ]
)
"""A rule to be interpreted."""

ACTION = np.dtype(
    [
        ("p", np.float64),
        ("target", np.int64),  # behaviour to change to, -1 for an action on internal states
        ("clears", np.int64),  # mask of internal-state bits
        ("sets", np.int64),
        ("fired", np.int64),  # how often it was drawn, counted by the kernel
    ]
)
"""An action of a rule."""

LANES = 64
"""Simulations that can run side by side."""


def _in_lanes(kind: type[np.generic], *names: str) -> list[tuple[str, type[np.generic], int]]:
    return [(name, kind, LANES) for name in names]


ROBOT_LANES = np.dtype(
    [
        *_in_lanes(np.float32, "x", "y", "cos", "sin", "walk_x", "walk_y", "away_x", "away_y"),
        *_in_lanes(np.int32, "walk_until"),  # first control step at which the walk is over
        *_in_lanes(np.int32, "memory"),  # carried << 3 | behaviour << 1 | WANT_OBJECT
        *_in_lanes(np.uint32, "key_low", "key_high"),
        *_in_lanes(np.uint32, "bits", "place", "word"),  # between the loops of a step
        *_in_lanes(np.int32, "restarts", "takes"),
        *_in_lanes(np.float32, "nearest"),
    ],
    align=True,
)
"""The robot of one number in many simulations, one lane each."""

OBJECT_LANES = np.dtype(_in_lanes(np.float32, "x", "y"))
"""The object of one number in many simulations."""

GROUP = np.dtype(
    [
        *_in_lanes(np.uint32, "table", "slot_bits"),  # where the control table starts; its slots
        *_in_lanes(np.int32, "picked", "collected", "lost"),
        *_in_lanes(np.int32, "touch"),  # whether robots may touch in this step
    ]
)
"""What simulations side by side have besides robots and objects."""
