"""How inert bodies push each other and walls: ten sub-steps for those that may touch in a step.

As Chipmunk does it, which ARGoS uses: bodies push each other only once they are found a little in
each other, where they may stay. They do not bounce. A robot's motors change its velocity by at most
`acceleration` in a sub-step, towards what its wheels are told, and what all of them and all pushes
come to is found pair after pair, from what it was in the sub-step before. So motors work against
each other: k robots move m that stand only if k > m.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import called, inlined
from geswarm.sim.kernels.single import HALF, ONE, TWO, ZERO, F, U, above_zero, within
from geswarm.sim.kernels.state import LANES

MOST_PAIRS = 8 * LANES
"""Pairs that are followed; no more than six bodies touch one, and few others come near."""
MOST_KEPT = 6
"""Pairs of a robot, with those of lower numbers, whose pushes are kept: more do not touch it."""
_SUB_STEP, _SUB_STEPS = F(0.01), 10
_ITERATIONS = 10
_SETTLED = F(5e-3)  # pushes are found when they change by less (m/s); they go on from there
_BLOCK = 16  # robots that are moved at once; LLVM makes no vectors of shorter loops
_SLOP = F(1e-4)  # bodies that are so near to a wall touch it

OF_THE_NEAR = ("x", "y", "go_x", "go_y", "to_x", "to_y", "spin", "drive_x", "drive_y")
"""Of each robot that may touch something: position, velocity, the one it is to reach, speed of its
surface by turning, change of velocity by its motors in this sub-step."""
OF_A_WALL = ("x", "y", "gap")
"""Of its two nearest walls: what points away from it, gap between wall and body at the origin."""
OF_NEAR_PAIRS = ("x", "y", "push", "rub")
"""Of each pair: from the second to the first robot; what they have changed each other's velocity by
in this sub-step, apart and along their surfaces (m/s)."""


@inlined
def _enter_walls(robot: Any, lane: int, near: Any, k: int, radius: Any) -> None:
    """Enter the two nearest walls of a robot."""
    x, y = robot.x[lane], robot.y[lane]
    wall_x, wall_y = robot.wall0_x[lane], robot.wall0_y[lane]
    near.wall0_x[k], near.wall0_y[k] = wall_x, wall_y
    near.wall0_gap[k] = robot.wall0_gap[lane] - radius - x * wall_x - y * wall_y
    wall_x, wall_y = robot.wall1_x[lane], robot.wall1_y[lane]
    near.wall1_x[k], near.wall1_y[k] = wall_x, wall_y
    near.wall1_gap[k] = robot.wall1_gap[lane] - radius - x * wall_x - y * wall_y


@inlined
def _enter(robots: Any, lane: int, near: Any, radius: Any, reach: Any) -> tuple[int, int]:
    """Enter the robots of a lane that may touch something; how many they are, how many a wall."""
    count, walled = 0, 0
    for i in range(len(robots)):
        robot = robots[i]
        if robot.held[lane]:
            near.number[count] = i
            near.x[count], near.y[count] = robot.x[lane], robot.y[lane]
            near.go_x[count], near.go_y[count] = robot.go_x[lane], robot.go_y[lane]
            near.to_x[count], near.to_y[count] = robot.to_x[lane], robot.to_y[lane]
            near.spin[count] = radius * robot.spin[lane]
            if robot.wall0_gap[lane] < radius + HALF * reach:
                _enter_walls(robot, lane, near, count, radius)
                near.walled[walled] = count
                walled += 1
            near.met[count], near.kept[count] = -1, robot.kept[lane]
            count += 1
    for k in range(count, (count + _BLOCK - 1) // _BLOCK * _BLOCK):
        near.x[k], near.y[k], near.go_x[k], near.go_y[k] = ZERO, ZERO, ZERO, ZERO
        near.to_x[k], near.to_y[k] = ZERO, ZERO
    return count, walled


@inlined
def _list_pairs(robots: Any, lane: int, near: Any, count: int, reach: Any) -> int:
    """List the pairs that may touch; how many they are."""
    pairs = 0
    for one in range(count):
        for two in range(one):
            dx, dy = near.x[one] - near.x[two], near.y[one] - near.y[two]
            if dx * dx + dy * dy < reach * reach and pairs < MOST_PAIRS:
                near.one[pairs], near.two[pairs] = one, two
                near.pair_push[pairs], near.pair_rub[pairs] = ZERO, ZERO
                robot = robots[near.number[one]]
                for slot in range(near.kept[one]):
                    if robot.kept_with[slot, lane] == near.number[two]:
                        near.pair_push[pairs] = robot.kept_push[slot, lane]
                        near.pair_rub[pairs] = robot.kept_rub[slot, lane]
                pairs += 1
    return pairs


@inlined
def _keep(robots: Any, lane: int, near: Any, count: int, touching: int) -> None:
    """Keep how pairs push for the next step, each with its robot of the higher number."""
    for k in range(count):
        if near.kept[k] > 0:
            robots[near.number[k]].kept[lane] = 0
    for at in range(touching):
        p = U(near.touching[at])
        robot = robots[near.number[near.one[p]]]
        slot = robot.kept[lane]
        if slot < MOST_KEPT:
            robot.kept[lane] = slot + 1
            robot.kept_with[slot, lane] = near.number[near.two[p]]
            robot.kept_push[slot, lane] = near.pair_push[p]
            robot.kept_rub[slot, lane] = near.pair_rub[p]


@inlined
def _push(near: Any, p: int, push_x: Any, push_y: Any) -> None:
    """Change the velocities of a pair, the first one's by this, the second one's the other way."""
    one, two = U(near.one[p]), U(near.two[p])
    near.go_x[one] += push_x
    near.go_y[one] += push_y
    near.go_x[two] -= push_x
    near.go_y[two] -= push_y


@inlined
def _go_on(near: Any, count: int) -> None:
    """Move all for a sub-step, in which motors have not changed a velocity yet."""
    for begin in range(0, count, _BLOCK):
        for at in range(_BLOCK):
            k = np.uint64(begin + at)
            near.x[k] += _SUB_STEP * near.go_x[k]
            near.y[k] += _SUB_STEP * near.go_y[k]
            near.drive_x[k], near.drive_y[k] = ZERO, ZERO


@inlined
def _meet(near: Any, pairs: int, width: Any, sub_step: int) -> tuple[int, int]:
    """List the pairs that touch and their robots; they push as in the last sub-step."""
    touching, met = 0, 0
    for p in range(pairs):
        one, two = U(near.one[p]), U(near.two[p])
        dx, dy = near.x[one] - near.x[two], near.y[one] - near.y[two]
        d2 = dx * dx + dy * dy
        if d2 >= width * width:
            near.pair_push[p], near.pair_rub[p] = ZERO, ZERO
            continue
        per_d = ONE / F(math.sqrt(d2)) if d2 > ZERO else ZERO
        x, y = dx * per_d if d2 > ZERO else ONE, dy * per_d
        near.pair_x[p], near.pair_y[p] = x, y
        push, rub = near.pair_push[p], near.pair_rub[p]
        _push(near, p, push * x - rub * y, push * y + rub * x)
        near.touching[touching] = p
        touching += 1
        if near.met[one] != sub_step:
            near.met[one], near.driven[met] = sub_step, one
            met += 1
        if near.met[two] != sub_step:
            near.met[two], near.driven[met] = sub_step, two
            met += 1
    return touching, met


@inlined
def _drive(near: Any, k: int, acceleration: Any) -> None:
    """The motors bring the velocity nearer to its target."""
    was_x, was_y = near.drive_x[k], near.drive_y[k]
    dx, dy = was_x + near.to_x[k] - near.go_x[k], was_y + near.to_y[k] - near.go_y[k]
    d2 = dx * dx + dy * dy
    share = ONE if d2 <= acceleration * acceleration else acceleration / F(math.sqrt(d2))
    near.drive_x[k], near.drive_y[k] = share * dx, share * dy
    near.go_x[k] += near.drive_x[k] - was_x
    near.go_y[k] += near.drive_y[k] - was_y


@inlined
def _keep_apart(near: Any, p: int, friction: Any) -> Any:
    """The two of a pair that touch come no nearer and rub; whether that changed a push."""
    one, two = U(near.one[p]), U(near.two[p])
    x, y = near.pair_x[p], near.pair_y[p]
    go_x, go_y = near.go_x[one] - near.go_x[two], near.go_y[one] - near.go_y[two]
    was, rubbed = near.pair_push[p], near.pair_rub[p]
    push = above_zero(was - HALF * (go_x * x + go_y * y))
    sliding = go_y * x - go_x * y - near.spin[one] - near.spin[two]
    rub = within(rubbed - HALF * sliding, friction * push)
    near.pair_push[p], near.pair_rub[p] = push, rub
    more, rub = push - was, rub - rubbed
    _push(near, p, more * x - rub * y, more * y + rub * x)
    return abs(more) + abs(rub) > _SETTLED


@inlined
def _keep_all_apart(near: Any, touching: int, friction: Any) -> Any:
    """Keep apart all pairs that touch; whether that changed a push."""
    changed = False
    for at in range(touching):
        changed |= _keep_apart(near, U(near.touching[at]), friction)
    return changed


@inlined
def _stop_at(near: Any, k: int, wall_x: Any, wall_y: Any, gap: Any, friction: Any) -> None:
    """A body does not go into a wall, along which it slides."""
    away = near.go_x[k] * wall_x + near.go_y[k] * wall_y
    if near.x[k] * wall_x + near.y[k] * wall_y + gap < _SLOP and away < ZERO:
        along = near.go_y[k] * wall_x - near.go_x[k] * wall_y
        along -= within(along, -friction * away)
        near.go_x[k], near.go_y[k] = -along * wall_y, along * wall_x


@inlined
def _stop_at_walls(near: Any, walled: int, friction: Any) -> None:
    """The robots that may touch a wall do not go into their nearest two."""
    for at in range(walled):
        k = U(near.walled[at])
        wall_x, wall_y, gap = near.wall0_x[k], near.wall0_y[k], near.wall0_gap[k]
        _stop_at(near, k, wall_x, wall_y, gap, friction)
        wall_x, wall_y, gap = near.wall1_x[k], near.wall1_y[k], near.wall1_gap[k]
        _stop_at(near, k, wall_x, wall_y, gap, friction)


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
    count, walled = _enter(robots, lane, near, radius, reach)
    pairs, touching = _list_pairs(robots, lane, near, count, reach), 0
    for sub_step in range(_SUB_STEPS):
        _go_on(near, count)
        touching, met = _meet(near, pairs, TWO * radius, sub_step)
        for begin in range(0, count, _BLOCK):
            for at in range(_BLOCK):
                _drive(near, np.uint64(begin + at), acceleration)
        for _ in range(_ITERATIONS if touching else 0):
            _stop_at_walls(near, walled, wall_friction)
            if not _keep_all_apart(near, touching, body_friction):
                break
            for at in range(met):
                _drive(near, U(near.driven[at]), acceleration)
        _stop_at_walls(near, walled, wall_friction)
    for k in range(count):
        robot = robots[near.number[k]]
        robot.x[lane], robot.y[lane] = near.x[k], near.y[k]
        robot.go_x[lane], robot.go_y[lane] = near.go_x[k], near.go_y[k]
    _keep(robots, lane, near, count, touching)


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
