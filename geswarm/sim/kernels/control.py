"""The first half of a control step: sense, decide, act on objects."""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.draws import (
    FIRST_ACTION,
    OBJECT_X,
    OBJECT_Y,
    OUTCOME,
    ZONE_MISS,
    draw,
    draw_bits,
)
from geswarm.sim.kernels.jit import inlined
from geswarm.sim.kernels.neighbours import insert_object, nearest_object, remove_object
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
from geswarm.sim.kernels.table import MEMORIES, memory_of, outcome_of, slot_of


@inlined
def sense(physics: Physics, robot: Any, step: int) -> None:
    """Percept bits: the zones from the robot's centre, unless missed; the gripper exactly."""
    percepts = HAS_OBJECT if robot.carried else 0
    if draw(robot.key, step, ZONE_MISS) >= physics.zone_miss:
        percepts |= zones_at(physics, robot.y)
    robot.percepts = percepts


@inlined
def zones_at(physics: Physics, y: float) -> int:
    """Percept bits of the zone that a place is in."""
    if y < physics.nest_edge:
        return ON_NEST
    return ON_SOURCE if y > physics.source_edge else 0


@inlined
def decide_by_table(physics: Physics, table: Any, slot_bits: int, robot: Any, step: int) -> bool:
    """Draw the step's outcome from the control table; True if a random walk starts afresh.

    Args:
        physics: Scenario in numbers.
        table: Words of one control table, which knows about missed zones; shape (situations,
            slots).
        slot_bits: Logarithm of the number of slots.
        robot: Updated in place.
        step: Control step.
    """
    low, high = np.uint32(robot.key & np.uint64(0xFFFFFFFF)), np.uint32(robot.key >> np.uint64(32))
    bits = draw_bits(low, high, step, OUTCOME)
    memory = memory_of(robot.carried, robot.behaviour, robot.states & WANT_OBJECT)
    word = table[zones_at(physics, robot.y) * MEMORIES + memory, slot_of(bits, slot_bits)]
    outcome = outcome_of(word, bits, slot_bits)
    robot.behaviour = outcome // (2 * STATES)
    robot.states = (outcome // 2) % STATES
    return bool(outcome % 2 == 1)


@inlined
def decide_by_rules(rules: Any, actions: Any, decisions: np.ndarray, robot: Any, step: int) -> bool:
    """Interpret the rules in order and count the outcome; True if a random walk starts afresh."""
    behaviour = np.int64(robot.behaviour)
    states = np.int64(robot.states)
    situation = (np.int64(robot.percepts) * BEHAVIOURS + behaviour) * STATES + states
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
    decisions[situation, (behaviour * STATES + states) * 2 + restart] += 1
    return restart


@inlined
def act_on_objects(
    physics: Physics,
    objects: np.ndarray,
    heads: np.ndarray,
    following: np.ndarray,
    tally: np.ndarray,
    robot: Any,
    step: int,
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
    nearest = nearest_object(physics, objects, heads, following, robot.x, robot.y)
    if nearest >= 0:
        robot.carried = True
        tally[PICKED] += 1
        remove_object(physics, objects, heads, following, nearest)
        u = draw(robot.key, step, OBJECT_X)
        place_object(physics, objects, nearest, u, draw(robot.key, step, OBJECT_Y))
        insert_object(physics, objects, heads, following, nearest)
