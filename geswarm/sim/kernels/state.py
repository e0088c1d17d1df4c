"""What the kernels work on: codes and bits, the scenario in numbers, the state of a swarm."""

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
"""Positions in `Swarm.tally`."""


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


class Swarm(NamedTuple):
    """State of one simulation; arrays of shape (robots,) unless said otherwise."""

    key: np.ndarray  # uint32, shape (robots + 1, 2); the last one is the arena's
    x: np.ndarray
    y: np.ndarray
    cos: np.ndarray  # of the orientation
    sin: np.ndarray
    behaviour: np.ndarray  # uint8
    states: np.ndarray  # uint8, internal-state bits
    percepts: np.ndarray  # uint8, as perceived in the last step
    carried: np.ndarray  # bool
    walk_x: np.ndarray  # unit vector of the random walk
    walk_y: np.ndarray
    walk_until: np.ndarray  # time in control steps at which it is over
    away_x: np.ndarray  # avoidance vector from the other robots, in this step
    away_y: np.ndarray
    object_x: np.ndarray  # shape (objects,)
    object_y: np.ndarray
    tally: np.ndarray  # int64, shape (3,): picked, collected, lost


class Rules(NamedTuple):
    """Rules for interpretation: arrays of shape (rules,), and of shape (actions,) from `p` on."""

    enabled: np.ndarray  # bool; False also for a rule whose preconditions contradict each other
    sensed: np.ndarray  # mask of the percepts that the preconditions name
    expected: np.ndarray  # their values
    behaviours: np.ndarray  # mask of behaviour codes
    first_action: np.ndarray  # shape (rules + 1,): where each rule's actions begin
    p: np.ndarray
    target: np.ndarray  # behaviour to change to, -1 for an action on internal states
    clears: np.ndarray  # mask of internal-state bits
    sets: np.ndarray


class Firing(NamedTuple):
    """Which rules fired: some action of theirs was drawn. int64, updated in place."""

    last_rule: np.ndarray  # shape (robots,), -1 before any
    per_rule: np.ndarray  # shape (rules,), counts
    per_action: np.ndarray  # shape (actions,), counts
