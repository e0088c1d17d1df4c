"""The first half of a control step: sense, decide, act on objects."""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.draws import FIRST_ACTION, OBJECT_X, OBJECT_Y, OUTCOME, ZONE_MISS, draw
from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.placement import place_object
from geswarm.sim.kernels.state import (
    BEHAVIOURS,
    COLLECTED,
    DROP_OBJECT,
    HAS_OBJECT,
    LOST,
    ON_NEST,
    ON_SOURCE,
    PICKED,
    RANDOM_WALK,
    STATES,
    WANT_OBJECT,
    Physics,
)


@inlined
def sense(physics: Physics, robot: Any, step: int) -> None:
    """Percept bits: the zones from the robot's centre, unless missed; the gripper exactly."""
    percepts = HAS_OBJECT if robot.carried else 0
    if draw(robot.key, step, ZONE_MISS) >= physics.zone_miss:
        if robot.y < physics.nest_edge:
            percepts |= ON_NEST
        if robot.y > physics.source_edge:
            percepts |= ON_SOURCE
    robot.percepts = percepts


@inlined
def decide_by_table(
    upto: np.ndarray, outcomes: np.ndarray, table: int, robot: Any, step: int
) -> bool:
    """Draw the step's outcome from the control table; True if a random walk starts afresh.

    Args:
        upto: Cumulative probabilities, shape (tables, situations, outcomes), likeliest outcome
            first.
        outcomes: The outcomes in that order, same shape.
        table: Which table.
        robot: Updated in place.
        step: Control step.
    """
    situation = (robot.percepts * BEHAVIOURS + robot.behaviour) * STATES + robot.states
    u = draw(robot.key, step, OUTCOME)
    k = 0
    while u >= upto[table, situation, k]:
        k += 1
    outcome = outcomes[table, situation, k]
    robot.behaviour = outcome // (2 * STATES)
    robot.states = (outcome // 2) % STATES
    return bool(outcome % 2 == 1)


@inlined
def decide_by_rules(rules: Any, actions: Any, robot: Any, step: int) -> bool:
    """Interpret the rules in order; True if a random walk starts afresh."""
    behaviour = np.int64(robot.behaviour)
    states = np.int64(robot.states)
    restart = False
    for r in range(len(rules)):
        rule = rules[r]
        sensed = (robot.percepts & rule.sensed) == rule.expected
        if not (rule.enabled and sensed and (rule.behaviours >> behaviour) & 1):
            continue
        fired = False
        for a in range(rule.first_action, rule.end_action):
            action = actions[a]
            if draw(robot.key, step, FIRST_ACTION + a) >= action.p:
                continue
            fired = True
            action.fired += 1
            states = (states & ~action.clears) | action.sets
            if action.target >= 0 and action.target != behaviour:
                behaviour = action.target
                restart = behaviour == RANDOM_WALK
        if fired:
            robot.last_rule = r
            rule.fired += 1
    robot.behaviour = behaviour
    robot.states = states
    return restart


@inlined
def act_on_objects(
    physics: Physics, objects: np.ndarray, tally: np.ndarray, robot: Any, step: int
) -> None:
    """Drop, then pick up; DROP_OBJECT is false again afterwards."""
    if robot.states & DROP_OBJECT:
        robot.states &= WANT_OBJECT
        if robot.carried:
            robot.carried = False
            tally[COLLECTED if robot.y < physics.nest_edge else LOST] += 1
    if robot.carried or not robot.states & WANT_OBJECT:
        return
    if robot.y < physics.source_edge - physics.grip_reach:
        return  # objects lie in the source only
    nearest = _nearest_object(objects, robot.x, robot.y, physics.grip_reach)
    if nearest >= 0:
        robot.carried = True
        tally[PICKED] += 1
        u = draw(robot.key, step, OBJECT_X)
        place_object(physics, objects, nearest, u, draw(robot.key, step, OBJECT_Y))


@inlined
def _nearest_object(objects: np.ndarray, x: float, y: float, reach: float) -> int:
    """The nearest object within reach, or -1."""
    nearest = -1
    nearest_d2 = reach * reach
    for o in range(len(objects)):
        dx = objects[o, 0] - x
        dy = objects[o, 1] - y
        d2 = dx * dx + dy * dy
        if d2 <= nearest_d2:
            nearest, nearest_d2 = o, d2
    return nearest
