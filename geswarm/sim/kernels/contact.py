"""How inert bodies push each other and walls: ten sub-steps for those that may touch in a step.

A robot's motors change its velocity by at most `acceleration` in a sub-step, towards what its
wheels are told. Bodies do not bounce, and each pair's push is remembered from one sub-step to the
next, so that motors work against each other: k robots move m that stand only if k > m.
"""

from __future__ import annotations

import math
from typing import Any

from geswarm.sim.kernels.jit import called, inlined
from geswarm.sim.kernels.single import HALF, ONE, TWO, ZERO, F, U, within
from geswarm.sim.kernels.state import LANES

MOST_PAIRS = 8 * LANES
"""Pairs that are followed; no more than six bodies touch one, and few others come near."""
_SUB_STEP, _SUB_STEPS = F(0.01), 10
_PER_SUB_STEP = F(100.0)
_CLOSE = F(0.004)  # what is further apart than this (m) does not touch in a sub-step
_SLOP = F(1e-4)  # bodies that are so near to a wall touch it

OF_THE_NEAR = ("x", "y", "go_x", "go_y", "to_x", "to_y", "spin")
"""Of each robot that may touch something: position, velocity, the one it is to reach, turn rate."""
OF_A_WALL = ("x", "y", "gap")
"""Of its two nearest walls: what points away from it, gap between wall and body at the origin."""
OF_NEAR_PAIRS = ("x", "y", "gap", "push")
"""Of each pair: from the second to the first robot, gap (m), push of the last sub-step (m/s)."""


@inlined
def _enter(robots: Any, lane: int, near: Any, radius: Any) -> int:
    """Enter the robots of a lane that may touch something; how many they are."""
    count = 0
    for i in range(len(robots)):
        robot = robots[i]
        if robot.held[lane]:
            near.number[count] = i
            near.x[count], near.y[count] = robot.x[lane], robot.y[lane]
            near.go_x[count], near.go_y[count] = robot.go_x[lane], robot.go_y[lane]
            near.to_x[count], near.to_y[count] = robot.to_x[lane], robot.to_y[lane]
            near.spin[count] = radius * robot.spin[lane]
            x, y = robot.x[lane], robot.y[lane]
            wall_x, wall_y = robot.wall0_x[lane], robot.wall0_y[lane]
            near.wall0_x[count], near.wall0_y[count] = wall_x, wall_y
            near.wall0_gap[count] = robot.wall0_gap[lane] - radius - x * wall_x - y * wall_y
            wall_x, wall_y = robot.wall1_x[lane], robot.wall1_y[lane]
            near.wall1_x[count], near.wall1_y[count] = wall_x, wall_y
            near.wall1_gap[count] = robot.wall1_gap[lane] - radius - x * wall_x - y * wall_y
            count += 1
    return count


@inlined
def _list_pairs(near: Any, count: int, reach: Any) -> int:
    """List the pairs that may touch; how many they are."""
    pairs = 0
    for one in range(count):
        for two in range(one):
            dx, dy = near.x[one] - near.x[two], near.y[one] - near.y[two]
            if dx * dx + dy * dy < reach * reach and pairs < MOST_PAIRS:
                near.one[pairs], near.two[pairs] = one, two
                near.pair_push[pairs] = ZERO
                pairs += 1
    return pairs


@inlined
def _list_walled(near: Any, count: int, reach: Any) -> int:
    """List the robots that may touch a wall; how many they are."""
    walled = 0
    for k in range(count):
        away = near.x[k] * near.wall0_x[k] + near.y[k] * near.wall0_y[k] + near.wall0_gap[k]
        if away < HALF * reach:
            near.walled[walled] = k
            walled += 1
    return walled


@inlined
def _push(near: Any, p: int, push_x: Any, push_y: Any) -> None:
    """Change the velocities of a pair, the first one's by this, the second one's the other way."""
    one, two = U(near.one[p]), U(near.two[p])
    near.go_x[one] += push_x
    near.go_y[one] += push_y
    near.go_x[two] -= push_x
    near.go_y[two] -= push_y


@inlined
def _begin_pair(near: Any, p: int, radius: Any) -> None:
    """Where the two of a pair are from each other; they push as in the last sub-step."""
    one, two = U(near.one[p]), U(near.two[p])
    dx, dy = near.x[one] - near.x[two], near.y[one] - near.y[two]
    d2, close = dx * dx + dy * dy, TWO * radius + _CLOSE
    if d2 > close * close:
        near.pair_gap[p], near.pair_push[p] = _CLOSE, ZERO
        return
    d = F(math.sqrt(d2))
    per_d = ONE / d if d > ZERO else ZERO
    near.pair_x[p], near.pair_y[p] = dx * per_d if d > ZERO else ONE, dy * per_d
    near.pair_gap[p] = d - TWO * radius
    if near.pair_push[p] > ZERO:
        _push(near, p, near.pair_push[p] * near.pair_x[p], near.pair_push[p] * near.pair_y[p])


@inlined
def _drive(near: Any, k: int, acceleration: Any) -> None:
    """The motors bring the velocity nearer to its target."""
    dx, dy = near.to_x[k] - near.go_x[k], near.to_y[k] - near.go_y[k]
    d2 = dx * dx + dy * dy
    share = ONE if d2 <= acceleration * acceleration else acceleration / F(math.sqrt(d2))
    near.go_x[k] += share * dx
    near.go_y[k] += share * dy


@inlined
def _keep_apart(near: Any, p: int, friction: Any) -> None:
    """The two of a pair come no nearer than till they touch; their surfaces rub."""
    if near.pair_gap[p] >= _CLOSE:
        return
    one, two = U(near.one[p]), U(near.two[p])
    x, y = near.pair_x[p], near.pair_y[p]
    go_x, go_y = near.go_x[one] - near.go_x[two], near.go_y[one] - near.go_y[two]
    parting = go_x * x + go_y * y
    before = near.pair_push[p]
    push = before - HALF * (parting + _PER_SUB_STEP * near.pair_gap[p])
    push = push if push > ZERO else ZERO
    near.pair_push[p] = push
    more = push - before
    sliding = go_y * x - go_x * y - near.spin[one] - near.spin[two]
    rub = within(-HALF * sliding, friction * push)
    if more != ZERO or rub != ZERO:
        _push(near, p, more * x - rub * y, more * y + rub * x)


@inlined
def _stop_at(near: Any, k: int, wall_x: Any, wall_y: Any, gap: Any, friction: Any) -> None:
    """A body does not go into a wall, along which it slides."""
    away = near.go_x[k] * wall_x + near.go_y[k] * wall_y
    if near.x[k] * wall_x + near.y[k] * wall_y + gap < _SLOP and away < ZERO:
        along = near.go_y[k] * wall_x - near.go_x[k] * wall_y
        along -= within(along, -friction * away)
        near.go_x[k], near.go_y[k] = -along * wall_y, along * wall_x


@called
def settle(
    robots: Any,
    lane: int,
    near: Any,
    radius: Any,
    reach: Any,
    acceleration: Any,
    wall_friction: Any,
    body_friction: Any,
) -> None:
    """Move the robots of one lane that are `held` by a step.

    Args:
        robots: With position, velocity and what it is to be, turn rate and nearest walls.
        lane: Which simulation.
        near: Working space.
        radius: Of a body (m).
        reach: Pairs that are nearer than this may touch in the step (m).
        acceleration: Of a body by its motors, in a sub-step (m/s).
        wall_friction: Share of what a wall takes that slows down sliding.
        body_friction: The same of two bodies.
    """
    count = _enter(robots, lane, near, radius)
    pairs = _list_pairs(near, count, reach)
    walled = _list_walled(near, count, reach)
    for _ in range(_SUB_STEPS):
        for k in range(count):
            near.x[k] += _SUB_STEP * near.go_x[k]
            near.y[k] += _SUB_STEP * near.go_y[k]
        for p in range(pairs):
            _begin_pair(near, p, radius)
        for k in range(count):
            _drive(near, k, acceleration)
        for p in range(pairs):
            _keep_apart(near, p, body_friction)
        for at in range(walled):
            k = near.walled[at]
            wall_x, wall_y, gap = near.wall0_x[k], near.wall0_y[k], near.wall0_gap[k]
            _stop_at(near, k, wall_x, wall_y, gap, wall_friction)
            wall_x, wall_y, gap = near.wall1_x[k], near.wall1_y[k], near.wall1_gap[k]
            _stop_at(near, k, wall_x, wall_y, gap, wall_friction)
    for k in range(count):
        robot = robots[near.number[k]]
        robot.x[lane], robot.y[lane] = near.x[k], near.y[k]
        robot.go_x[lane], robot.go_y[lane] = near.go_x[k], near.go_y[k]


@inlined
def nearer(gap: Any, x: Any, y: Any, first: Any, second: Any) -> Any:
    """The two nearest of three walls, given as (gap, x, y) each, the nearest one first."""
    is_first, is_second = gap < first[0], gap < second[0]
    second_gap = gap if is_second else second[0]
    second_x, second_y = x if is_second else second[1], y if is_second else second[2]
    second = (
        first[0] if is_first else second_gap,
        first[1] if is_first else second_x,
        first[2] if is_first else second_y,
    )
    first = (
        gap if is_first else first[0],
        x if is_first else first[1],
        y if is_first else first[2],
    )
    return first, second
