"""Many simulations side by side: the model's control step by control table, for small swarms.

Every number of a robot is an array with one lane per simulation, and every phase of the control
step is a loop over the lanes that does the same to each of them. The compiler turns such a loop
into instructions that handle 4 to 16 lanes at once, on four conditions: no branches (both sides are
worked out and one is chosen), no calls (`single` has the functions), 32 bits only, and a look-up
in a table stands alone in its loop. What is rare and needs a branch, picking up and touching, first
asks if any lane is concerned and then goes through these lanes one by one.

A lane never looks at another lane, and operations are the same in a vector and alone. So a
simulation has the same result in any lane, beside any others.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geswarm.sim.kernels.draws import (
    OBJECT_X,
    OBJECT_Y,
    OUTCOME,
    WALK_HEADING,
    WALK_TIME,
    draw_bits,
)
from geswarm.sim.kernels.jit import inlined, kernel
from geswarm.sim.kernels.placement import start
from geswarm.sim.kernels.single import (
    HALF,
    ONE,
    TWO,
    ZERO,
    F,
    I,
    U,
    above_zero,
    angle_of,
    cos_sin,
    fma,
    fraction,
    heading,
    inverse_root,
    within,
)
from geswarm.sim.kernels.state import (
    ANTI_PHOTOTAXIS,
    ON_NEST,
    ON_SOURCE,
    RANDOM_WALK,
    WANT_OBJECT,
    Physics,
)
from geswarm.sim.kernels.table import MEMORIES, memory_of, outcome_of, slot_of

_CARRIED = I(8)
_FAR = F(1e30)


def build_run_lanes(version: int) -> Any:
    """The kernel that runs simulations side by side; `version` becomes part of its cache key."""

    @kernel
    def run_lanes(
        physics: Physics,
        robots: Any,
        objects: Any,
        group: Any,
        words: Any,
        row_bits: int,
        width: int,
        first: int,
        steps: int,
    ) -> int:
        """Run control steps first..first+steps-1 of the simulations in lanes 0..width-1.

        Args:
            physics: Scenario in numbers, float32.
            robots: Of ROBOT_LANES, shape (robots,).
            objects: Of OBJECT_LANES, shape (objects,).
            group: Of GROUP.
            words: Control tables, see `table`, uint32, flat.
            row_bits: Logarithm of the number of words per situation.
            width: Multiple of 16.
            first: Control step to begin with.
            steps: How many.
        """
        for step in range(first, first + steps):
            _avoid_robots(physics, robots, group, width)
            for i in range(len(robots)):
                robot = robots[i]
                _decide(physics, robot, group, words, row_bits, width, step)
                _restart_walks(physics, robot, width, step)
                _take_objects(physics, robot, objects, group, width, step)
                _move(physics, robot, width)
            _collide(physics, robots, group, width)
        return version

    return run_lanes


@inlined
def _avoid_robots(physics: Physics, robots: Any, group: Any, width: int) -> None:
    """Avoidance vectors from the other robots; which simulations have a pair that may touch."""
    touch = TWO * (physics.radius + physics.max_speed * physics.control_step) + F(1e-6)
    touch2 = touch * touch
    range2 = physics.rab_range * physics.rab_range
    per_range = ONE / physics.rab_range
    for lane in range(width):
        group.touch[lane] = I(0)
    for i in range(len(robots)):
        robot = robots[i]
        for lane in range(width):
            robot.away_x[lane] = ZERO
            robot.away_y[lane] = ZERO
    for i in range(len(robots)):
        robot = robots[i]
        for j in range(i + 1, len(robots)):
            other = robots[j]
            for lane in range(width):
                dx = robot.x[lane] - other.x[lane]
                dy = robot.y[lane] - other.y[lane]
                d2 = fma(dx, dx, dy * dy)
                strength = inverse_root(d2) - per_range  # (1 - d/range) / d
                strength = strength if d2 < range2 else ZERO
                group.touch[lane] = I(group.touch[lane] | I(d2 < touch2))
                robot.away_x[lane] = fma(strength, dx, robot.away_x[lane])
                robot.away_y[lane] = fma(strength, dy, robot.away_y[lane])
                other.away_x[lane] = fma(-strength, dx, other.away_x[lane])
                other.away_y[lane] = fma(-strength, dy, other.away_y[lane])


@inlined
def _decide(
    physics: Physics, robot: Any, group: Any, words: Any, row_bits: int, width: int, step: int
) -> None:
    """Sense, draw the outcome, drop; which robots restart their walk and which want an object."""
    now = I(step)
    for lane in range(width):
        bits = draw_bits(robot.key_low[lane], robot.key_high[lane], step, OUTCOME)
        zones = U(ON_NEST) if robot.y[lane] < physics.nest_edge else U(0)
        zones = U(ON_SOURCE) if robot.y[lane] > physics.source_edge else zones
        situation = U(U(zones * U(MEMORIES)) + U(robot.memory[lane]))
        slot = slot_of(bits, group.slot_bits[lane])
        robot.bits[lane] = bits
        robot.place[lane] = U(U(U(situation << U(row_bits)) | slot) + group.table[lane])
    for lane in range(width):
        robot.word[lane] = words[robot.place[lane]]
    for lane in range(width):
        outcome = I(outcome_of(robot.word[lane], robot.bits[lane], group.slot_bits[lane]))
        behaviour = I(outcome >> I(3))
        want = I(I(outcome >> I(1)) & I(1))
        carried = I(robot.memory[lane] >> I(3))
        dropped = I(carried & I(outcome >> I(2)))
        in_nest = I(robot.y[lane] < physics.nest_edge)
        group.collected[lane] = I(group.collected[lane] + I(dropped & in_nest))
        group.lost[lane] = I(group.lost[lane] + I(dropped & I(I(1) - in_nest)))
        carried = I(carried - dropped)
        robot.memory[lane] = I(I(I(carried << I(3)) | I(behaviour << I(1))) | want)
        walk_over = I(behaviour == I(RANDOM_WALK)) & I(now >= robot.walk_until[lane])
        robot.restarts[lane] = I(I(outcome & I(1)) | walk_over)
        robot.takes[lane] = I(want & I(I(1) - carried))


@inlined
def _restart_walks(physics: Physics, robot: Any, width: int, step: int) -> None:
    """Fresh heading and time for the robots whose random walk restarts."""
    shortest = physics.walk_min / physics.control_step
    longer = (physics.walk_max - physics.walk_min) / physics.control_step
    now = I(step + 1)
    for lane in range(width):
        low, high = robot.key_low[lane], robot.key_high[lane]
        x, y = heading(draw_bits(low, high, step, WALK_HEADING))
        kept = fma(longer, fraction(draw_bits(low, high, step, WALK_TIME)), shortest)
        restarts = robot.restarts[lane] != I(0)
        robot.walk_x[lane] = x if restarts else robot.walk_x[lane]
        robot.walk_y[lane] = y if restarts else robot.walk_y[lane]
        robot.walk_until[lane] = I(now + I(kept)) if restarts else robot.walk_until[lane]


@inlined
def _take_objects(
    physics: Physics, robot: Any, objects: Any, group: Any, width: int, step: int
) -> None:
    """Those who want an object take the nearest one within reach."""
    reach2 = physics.grip_reach * physics.grip_reach
    for lane in range(width):
        robot.nearest[lane] = _FAR
    for o in range(len(objects)):
        item = objects[o]
        for lane in range(width):
            d2 = _distance2(item, robot, lane)
            robot.nearest[lane] = d2 if d2 < robot.nearest[lane] else robot.nearest[lane]
    any_takes = I(0)
    for lane in range(width):
        takes = I(robot.takes[lane] & I(robot.nearest[lane] <= reach2))
        robot.takes[lane] = takes
        any_takes = I(any_takes | takes)
    if any_takes:
        for lane in range(width):
            if robot.takes[lane]:
                _take(physics, robot, objects, lane, step)
                group.picked[lane] += I(1)


@inlined
def _take(physics: Physics, robot: Any, objects: Any, lane: int, step: int) -> None:
    """Take the nearest object; a new one appears in the source."""
    robot.memory[lane] = I(robot.memory[lane] | _CARRIED)
    o = 0
    while _distance2(objects[o], robot, lane) != robot.nearest[lane]:
        o += 1
    low, high = robot.key_low[lane], robot.key_high[lane]
    u = fraction(draw_bits(low, high, step, OBJECT_X))
    v = fraction(draw_bits(low, high, step, OBJECT_Y))
    north = physics.half_length - physics.object_margin
    objects[o].x[lane] = (physics.half_width - physics.object_margin) * (TWO * u - ONE)
    objects[o].y[lane] = fma(north - physics.source_edge, v, physics.source_edge)


@inlined
def _distance2(item: Any, robot: Any, lane: int) -> Any:
    """Squared distance between an object and a robot."""
    dx = item.x[lane] - robot.x[lane]
    dy = item.y[lane] - robot.y[lane]
    return fma(dx, dx, dy * dy)


@inlined
def _target(physics: Physics, robot: Any, lane: int) -> tuple[Any, Any]:
    """Target vector of the behaviour plus the avoidance vector."""
    x, y = robot.x[lane], robot.y[lane]
    behaviour = I(I(robot.memory[lane] >> I(1)) & I(3))
    north = physics.light_y - y
    scale = ONE / F(math.sqrt(fma(x, x, north * north)))
    scale = -scale if behaviour == I(ANTI_PHOTOTAXIS) else scale
    walking = behaviour == I(RANDOM_WALK)
    tx = robot.walk_x[lane] if walking else -x * scale
    ty = robot.walk_y[lane] if walking else north * scale
    near = physics.radius + physics.proximity_range  # a wall is sensed nearer than this
    per_range = ONE / physics.proximity_range
    near_x, near_y = near - physics.half_width, near - physics.half_length
    push_x = above_zero(near_x - x) - above_zero(near_x + x)
    push_y = above_zero(near_y - y) - above_zero(near_y + y)
    tx = fma(physics.avoidance_gain, fma(per_range, push_x, robot.away_x[lane]), tx)
    ty = fma(physics.avoidance_gain, fma(per_range, push_y, robot.away_y[lane]), ty)
    return tx, ty


@inlined
def _move(physics: Physics, robot: Any, width: int) -> None:
    """Wheel speeds from the target vector (Turgut et al. 2008); rotate, then advance."""
    half_base = HALF * physics.wheel_base
    for lane in range(width):
        tx, ty = _target(physics, robot, lane)
        cos, sin = robot.cos[lane], robot.sin[lane]
        ahead = fma(tx, cos, ty * sin)
        left = fma(ty, cos, -tx * sin)
        length = F(math.sqrt(fma(ahead, ahead, left * left)))
        forward = ahead / length if length > ZERO else ONE
        sideways = left / length if length > ZERO else ZERO
        speed = physics.max_speed * above_zero(forward)
        turn = physics.turn_gain * angle_of(forward, sideways)
        slowed = physics.max_speed / fma(abs(turn), half_base, speed)
        seconds = physics.control_step * (slowed if slowed < ONE else ONE)
        c, s = cos_sin(turn * seconds)
        cos, sin = fma(cos, c, -sin * s), fma(sin, c, cos * s)
        unit = fma(-HALF, fma(cos, cos, sin * sin), F(1.5))  # rounding must not add up
        robot.cos[lane] = cos * unit
        robot.sin[lane] = sin * unit
        robot.x[lane] = fma(speed * seconds, cos, robot.x[lane])
        robot.y[lane] = fma(speed * seconds, sin, robot.y[lane])


@inlined
def _collide(physics: Physics, robots: Any, group: Any, width: int) -> None:
    """Push overlapping pairs apart, pair after pair, then clamp everything inside the walls."""
    any_touch = I(0)
    for lane in range(width):
        any_touch = I(any_touch | group.touch[lane])
    if any_touch:
        for lane in range(width):
            if group.touch[lane]:
                for i in range(len(robots)):
                    for j in range(i + 1, len(robots)):
                        _push_apart(robots[i], robots[j], physics.radius, lane)
    reach_x = physics.half_width - physics.radius
    reach_y = physics.half_length - physics.radius
    for i in range(len(robots)):
        robot = robots[i]
        for lane in range(width):
            robot.x[lane] = within(robot.x[lane], reach_x)
            robot.y[lane] = within(robot.y[lane], reach_y)


@inlined
def _push_apart(robot: Any, other: Any, radius: Any, lane: int) -> None:
    """Move both by half of their overlap; east and west if they are at the very same place."""
    dx = robot.x[lane] - other.x[lane]
    dy = robot.y[lane] - other.y[lane]
    d2 = fma(dx, dx, dy * dy)
    if d2 >= TWO * TWO * radius * radius:
        return
    d = F(math.sqrt(d2))
    push = radius - HALF * d
    dx, dy = (dx / d, dy / d) if d > ZERO else (ONE, ZERO)
    robot.x[lane] += push * dx
    robot.y[lane] += push * dy
    other.x[lane] -= push * dx
    other.y[lane] -= push * dy


def build_start_lanes(version: int) -> Any:
    """The kernel that starts simulations side by side; `version` becomes part of its cache key."""

    @kernel
    def start_lanes(
        physics: Physics,
        swarm: Any,
        slots: Any,
        starts: Any,
        items: Any,
        simulations: Any,
        robots: Any,
        objects: Any,
    ) -> int:
        """Write the state at the start of as many simulations as there are.

        Args:
            physics: Scenario in numbers, float64.
            swarm: Working space, of ROBOT, shape (robots,).
            slots: As for `neighbours.avoid_robots`, and so `starts`.
            starts: Working space.
            items: Working space, shape (objects, 2).
            simulations: int64, shape (simulations, 4): table, seed, individual, replicate.
            robots: Of ROBOT_LANES, shape (robots,).
            objects: Of OBJECT_LANES, shape (objects,).
        """
        for lane in range(len(simulations)):
            _, seed, individual, replicate = simulations[lane]
            start(physics, swarm, slots, starts, items, seed, individual, replicate)
            for i in range(len(swarm)):
                _start_robot(robots[i], swarm[i], lane)
            for o in range(len(items)):
                objects[o].x[lane] = items[o, 0]
                objects[o].y[lane] = items[o, 1]
        return version

    return start_lanes


@inlined
def _start_robot(robot: Any, single: Any, lane: int) -> None:
    """Put one simulation's robot into its lane."""
    robot.key_low[lane] = single.key & np.uint64(0xFFFFFFFF)
    robot.key_high[lane] = single.key >> np.uint64(32)
    robot.x[lane] = single.x
    robot.y[lane] = single.y
    robot.cos[lane] = single.cos
    robot.sin[lane] = single.sin
    robot.walk_x[lane] = single.walk_x
    robot.walk_y[lane] = single.walk_y
    robot.walk_until[lane] = math.ceil(single.walk_until)
    want = single.states & WANT_OBJECT
    robot.memory[lane] = memory_of(single.carried, single.behaviour, want)
