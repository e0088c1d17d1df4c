"""Source of a step of bodies with inertia: motion, senses, command, decision.

As ARGoS has it: robots move as they were told in the step before, sense where they are then, are
told how to go on, and decide what to do in the next step.
"""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.sim.assembly import acting, deciding, ground, senses
from geswarm.sim.assembly.source import Source


def step(source: Source) -> None:
    """One control step."""
    _move(source)
    senses.of_others(source)
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        senses.of_the_arena(source)
        _command(source)
        deciding.decide(source)
        acting.start_afresh(source)
        acting.effects(source)


def _move(source: Source) -> None:
    for name in ("radius", "wheel_base", "max_speed", "control_step", "wheel_noise"):
        source.number(name)
    for name in ("acceleration", "wall_friction", "body_friction"):
        source.number(name)
    source("# Who may touch whom or a wall in this step.")
    source("reach = max_speed * control_step * fma(F(4.0), wheel_noise, ONE)")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            _turn_wheels(source)
        with source.lanes():
            _look_for_walls(source)
    _look_for_others(source)
    source("# These are moved in sub-steps, one by one; the others freely.")
    with (
        source.inside("for lane in range(width):"),
        source.inside("if work.touch[lane]:"),
    ):
        numbers = "radius, near_by, acceleration, wall_friction, body_friction"
        source(f"settle(robots, lane, work, {numbers})")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            _go_freely(source)


def _turn_wheels(source: Source) -> None:
    """What velocity and turn rate the wheels would bring about."""
    source("dice = dice_of(robot.key_low[lane], robot.key_high[lane], step)")
    source("robot.dice[lane] = dice")
    for number, wheel in enumerate(("left", "right")):
        source(f"off = wheel_noise * epuck.gaussian(thrown(dice, E_PUCK + {number}))")
        source(f"{wheel} = fma(robot.{wheel}[lane], off, robot.{wheel}[lane])")
    source("speed = F(0.5) * (left + right)")
    source("robot.to_x[lane] = speed * robot.cos[lane]")
    source("robot.to_y[lane] = speed * robot.sin[lane]")
    source("moves = I(I(speed != ZERO) | I(robot.go_x[lane] != ZERO))")
    source("robot.moves[lane] = I(moves | I(robot.go_y[lane] != ZERO))")
    source("robot.turn[lane] = F(0.1) * control_step * robot.spin[lane]")
    source("robot.spin[lane] = (right - left) / wheel_base")


def _look_for_walls(source: Source) -> None:
    """The two nearest walls, and whether the nearest is near."""
    source("x, y = robot.x[lane], robot.y[lane]")
    source("first, second = (F(9e9), ZERO, ZERO), (F(9e9), ZERO, ZERO)")
    for surface in surfaces(source):
        source(f"gap, normal_x, normal_y = {surface}")
        source("first, second = nearer(gap, normal_x, normal_y, first, second)")
    for number, which in enumerate(("first", "second")):
        for at, name in enumerate(("gap", "x", "y")):
            source(f"robot.wall{number}_{name}[lane] = {which}[{at}]")
    source("near = I(first[0] < radius + reach)\nrobot.held[lane] = near")


def surfaces(source: Source) -> Iterator[str]:
    """All that robots do not get through: (gap, what points away from it) of each."""
    arena = source.parts.ground
    if arena.outline == "box":
        width, length = source.number("half_width"), source.number("half_length")
        yield f"{width} - x, -ONE, ZERO"
        yield f"{width} + x, ONE, ZERO"
        yield f"{length} - y, ZERO, -ONE"
        yield f"{length} + y, ZERO, ONE"
    elif arena.outline == "disc":
        yield f"geometry.round_wall(x, y, {source.number('arena_radius')})"
    yield from ground.in_the_way(source)


def _look_for_others(source: Source) -> None:
    source("near_by = TWO * (radius + reach)\nnear2 = near_by * near_by")
    with source.lanes():
        source("work.touch[lane] = I(0)")
    with (
        source.inside("for i in range(len(robots)):"),
        source.inside("for j in range(i + 1, len(robots)):"),
    ):
        source("robot, other, some = robots[i], robots[j], I(0)")
        with source.lanes():
            source("dx, dy = robot.x[lane] - other.x[lane], robot.y[lane] - other.y[lane]")
            source("near = I(fma(dx, dx, dy * dy) < near2)")
            source("work.happens[lane] = near")
            source("some = I(some | near)")
        with source.inside("if some:"), source.lanes():
            source("robot.held[lane] = I(robot.held[lane] | work.happens[lane])")
            source("other.held[lane] = I(other.held[lane] | work.happens[lane])")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            source("moves = I(robot.held[lane] & robot.moves[lane])")
            source("work.touch[lane] = I(work.touch[lane] | moves)")


def _go_freely(source: Source) -> None:
    """Robots that touch nothing; all turn."""
    source("go_x, go_y = robot.go_x[lane], robot.go_y[lane]")
    source("to_x, to_y = robot.to_x[lane], robot.to_y[lane]")
    source("change_x, change_y = to_x - go_x, to_y - go_y")
    source("change = F(np.sqrt(fma(change_x, change_x, change_y * change_y)))")
    source("parts, held = change / acceleration, robot.held[lane] != I(0)")
    for along in "xy":
        way = f"epuck.free_way(go_{along}, change_{along}, parts)"
        source(f"place = robot.{along}[lane] + {way}")
        source(f"robot.{along}[lane] = robot.{along}[lane] if held else place")
        source(f"robot.go_{along}[lane] = go_{along} if held else to_{along}")
    source("turned = fma(F(0.9) * control_step, robot.spin[lane], robot.turn[lane])")
    source("cos, sin, unit = turn(robot.cos[lane], robot.sin[lane], turned)")
    source("robot.cos[lane], robot.sin[lane] = cos * unit, sin * unit")


def _command(source: Source) -> None:
    """The behaviour's vector in the robot's frame, and the wheels that it asks for."""
    if source.parts.arguments:
        deciding.look_up_arguments(source)
    source("# The wheels are told how to turn in the next step.")
    with source.lanes():
        acting.choose_target(source)
        source("left, right = epuck.wheels_for(to_x, to_y, max_speed)")
        if any(behaviour.paced for behaviour in source.parts.behaviours):
            source("left, right = pace * left, pace * right")
        source("robot.left[lane], robot.right[lane] = left, right")
    acting.go_on(source)
