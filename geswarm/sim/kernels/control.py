"""The first half of a control step: sense, decide, act on objects."""

from __future__ import annotations

import numpy as np
from numba import njit

XX


@njit
def sense(physics: Physics, swarm: Swarm, i: int, step: int) -> int:
    """Percept bits: the zones from the robot's centre, unless missed; the gripper exactly."""
    percepts = HAS_OBJECT if swarm.carried[i] else 0
    if draw(swarm.key[i], step, ZONE_MISS) >= physics.zone_miss:
        if swarm.y[i] < physics.nest_edge:
            percepts |= ON_NEST
        if swarm.y[i] > physics.source_edge:
            percepts |= ON_SOURCE
    swarm.percepts[i] = percepts
    return percepts


@njit
def decide_by_table(
    upto: np.ndarray, outcomes: np.ndarray, swarm: Swarm, i: int, step: int, percepts: int
) -> bool:
    """Draw the step's outcome from the control table; True if a random walk starts afresh.

    Args:
        upto: Cumulative probabilities, shape (situations, outcomes), likeliest outcome first.
        outcomes: The outcomes in that order, same shape.
        swarm: Updated in place.
        i: Robot.
        step: Control step.
        percepts: Percept bits.
    """
    situation = (percepts * BEHAVIOURS + swarm.behaviour[i]) * STATES + swarm.states[i]
    u = draw(swarm.key[i], step, OUTCOME)
    k = 0
    while u >= upto[situation, k]:
        k += 1
    outcome = outcomes[situation, k]
    swarm.behaviour[i] = outcome // (2 * STATES)
    swarm.states[i] = (outcome // 2) % STATES
    return outcome % 2 == 1


@njit
def decide_by_rules(
    rules: Rules, firing: Firing, swarm: Swarm, i: int, step: int, percepts: int
) -> bool:
    """Interpret the rules in order, each action drawn on its own; True if a random walk starts afresh."""
    behaviour = np.int64(swarm.behaviour[i])
    states = np.int64(swarm.states[i])
    restart = False
    for r in range(len(rules.enabled)):
        sensed = (percepts & rules.sensed[r]) == rules.expected[r]
        if not (rules.enabled[r] and sensed and (rules.behaviours[r] >> behaviour) & 1):
            continue
        fired = False
        for a in range(rules.first_action[r], rules.first_action[r + 1]):
            if draw(swarm.key[i], step, ACTION + a) >= rules.p[a]:
                continue
            fired = True
            firing.per_action[a] += 1
            states = (states & ~rules.clears[a]) | rules.sets[a]
            if rules.target[a] >= 0 and rules.target[a] != behaviour:
                behaviour = rules.target[a]
                restart = behaviour == RANDOM_WALK
        if fired:
            firing.last_rule[i] = r
            firing.per_rule[r] += 1
    swarm.behaviour[i] = behaviour
    swarm.states[i] = states
    return restart


@njit
def act_on_objects(physics: Physics, swarm: Swarm, i: int, step: int) -> None:
    """Drop, then pick up; DROP_OBJECT is false again afterwards."""
    if swarm.states[i] & DROP_OBJECT:
        swarm.states[i] &= WANT_OBJECT
        if swarm.carried[i]:
            swarm.carried[i] = False
            swarm.tally[COLLECTED if swarm.y[i] < physics.nest_edge else LOST] += 1
    if swarm.carried[i] or not swarm.states[i] & WANT_OBJECT:
        return
    if swarm.y[i] < physics.source_edge - physics.grip_reach:
        return  # objects lie in the source only
    nearest = -1
    nearest_d2 = physics.grip_reach * physics.grip_reach
    for o in range(len(swarm.object_x)):
        dx = swarm.object_x[o] - swarm.x[i]
        dy = swarm.object_y[o] - swarm.y[i]
        d2 = dx * dx + dy * dy
        if d2 <= nearest_d2:
            nearest, nearest_d2 = o, d2
    if nearest >= 0:
        swarm.carried[i] = True
        swarm.tally[PICKED] += 1
        u = draw(swarm.key[i], step, OBJECT_X)
        place_object(physics, swarm, nearest, u, draw(swarm.key[i], step, OBJECT_Y))
