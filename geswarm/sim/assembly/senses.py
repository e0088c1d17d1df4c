"""Source of what e-pucks sense: the robots around them, walls, light and floor.

Components may name what comes of it, vectors in the robot's own frame (ahead, left):

| name | meaning |
| --- | --- |
| `prox_x`, `prox_y` | the sum of the proximity readings, at most 1 long |
| `light_x`, `light_y` | unit vector towards the light, none if no sensor is lit |
| `rab_x`, `rab_y` | the sum over all messages of the last 11 steps of 1 / (1 + gap in cm) |
| `heard` | messages of this step |
| `ground` | the floor: 0 grey, 1 black, 2 white |
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from geswarm.sim.assembly import ground
from geswarm.sim.bodies import E_PUCK
from geswarm.sim.kernels.contact import MOST_KEPT
from geswarm.sim.kernels.epuck import RAYS, READINGS
from geswarm.sim.kernels.single import F, I, U

if TYPE_CHECKING:
    from geswarm.sim.assembly.source import Source

MEMORY = 11
"""Steps for which messages are remembered."""
_RAYS = range(len(RAYS))
_LIGHT = 4
_GROUND = 8
"""Which of the robot's random numbers in a step are for the light and for the ground."""
_EYES = ((0.03, -0.009), (0.03, 0.0), (0.03, 0.009))
"""Where the ground sensors are: ahead, to the left (m)."""

ROWS = {
    "memory_x": (F, MEMORY),
    "memory_y": (F, MEMORY),
    "rays": (F, len(RAYS)),
    "kept_with": (I, MOST_KEPT),
    "kept_push": (F, MOST_KEPT),
    "kept_rub": (F, MOST_KEPT),
}
"""Fields of a robot that have several numbers: of the last steps, of each ray, of each contact."""
_WHOLE = ("heard", "ground")


def fields(lights: int) -> dict[str, type]:
    """Fields of a robot for its motion and senses."""
    walls = [f"wall{number}_{name}" for number in range(2) for name in ("gap", "x", "y")]
    lamps = [f"lamp{light}_{name}" for light in range(lights) for name in ("x", "y", "low")]
    return {
        **dict.fromkeys(("left", "right", "go_x", "go_y", "to_x", "to_y", "spin", "turn"), F),
        **dict.fromkeys(walls, F),
        **dict.fromkeys(("now_x", "now_y"), F),
        **dict.fromkeys(("held", "moves", "kept", "votes_black", "votes_white"), I),
        **dict.fromkeys([f"dark{light}" for light in range(lights)], I),
        **dict.fromkeys(lamps, F),
        "dice": U,
        **{name: I if name in _WHOLE else F for name in E_PUCK.senses},
    }


def _named(source: Source, *names: str) -> bool:
    return any(name in each.needs for each in source.parts.components for name in names)


def _number(value: float) -> str:
    return f"F({value!r})"


def _directions(angles: tuple[float, ...]) -> list[tuple[str, str]]:
    turns = [math.radians(angle) for angle in angles]
    return [(_number(math.cos(turn)), _number(math.sin(turn))) for turn in turns]


def of_others(source: Source) -> None:
    """What robots sense of each other: messages, bodies near by, bodies in the light."""
    hears, sees = _named(source, "rab_x", "heard"), _named(source, "prox_x")
    lights = source.parts.ground.lights if _named(source, "light_x") else 0
    source("# What robots sense of each other.")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            source("robot.heard[lane] = I(0)\nrobot.now_x[lane], robot.now_y[lane] = ZERO, ZERO")
            for ray in _RAYS:
                source(f"robot.rays[{ray}, lane] = epuck.FAR_RAY")
            for light in range(lights):
                source(f"robot.dark{light}[lane] = I(0)")
                _to_lamp(source, light, "robot")
    if hears:
        source("lost = U(F(65536.0) * rab_loss)")
        source(f"within2 = {source.number('rab_range')} * rab_range\n{source.number('rab_loss')}")
    reach = "TWO * radius + epuck.RAY_LENGTH + F(0.001)"
    source(f"near2 = ({reach}) * ({reach})")
    if hears:
        _side_by_side(source)
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.inside("for j in range(i + 1, len(robots)):"):
            source("other = robots[j]")
            _look_at_pair(source, hears)
            if hears:
                with source.inside("if some:"):
                    _hear(source)
            if sees:
                with source.inside("if near:"):
                    _see(source)
            for light in range(lights):
                _shade(source, light)


def _side_by_side(source: Source) -> None:
    """All places of a simulation in a row: who is between two robots is looked up in few of all."""
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            for along in "xy":
                source(f"work.places_{along}[lane, i] = robot.{along}[lane]")
    with (
        source.inside("for i in range(len(robots), -(-len(robots) // epuck.BLOCK) * epuck.BLOCK):"),
        source.lanes(),
    ):
        source("work.places_x[lane, i], work.places_y[lane, i] = epuck.AWAY, epuck.AWAY")


def _look_at_pair(source: Source, hears: bool) -> None:
    source("some, near = I(0), I(0)")
    with source.lanes():
        source("dx, dy = other.x[lane] - robot.x[lane], other.y[lane] - robot.y[lane]")
        source("d2 = fma(dx, dx, dy * dy)")
        source("work.dx[lane], work.dy[lane], work.d2[lane] = dx, dy, d2")
        source("here = I(d2 < near2)\nwork.near[lane] = here\nnear = I(near | here)")
        if hears:
            source("bits = thrown(robot.dice[lane], MESSAGE + j)")
            source("here, there = I(U(bits & U(0xFFFF)) >= lost), I(U(bits >> U(16)) >= lost)")
            source("both = I(I(here | I(there << I(1))) * I(d2 < within2))")
            source("work.happens[lane] = both\nsome = I(some | both)")


def _hear(source: Source) -> None:
    """The messages that are not lost arrive if no body is in the way."""
    with source.inside("for lane in range(width):"), source.inside("if work.happens[lane]:"):
        source("dx, dy, d2 = work.dx[lane], work.dy[lane], work.d2[lane]")
        places = (
            "work.places_x[lane], work.places_y[lane], len(robots), robot.x[lane], robot.y[lane]"
        )
        with source.inside(f"if epuck.are_between({places}, dx, dy, d2, radius * radius * d2):"):
            source("work.happens[lane] = I(0)")
    with source.lanes():
        source("per_d = inverse_root(work.d2[lane])")
        source("gap = above_zero(fma(F(100.0), work.d2[lane] * per_d, F(-7.0)))")
        source("work.per_d[lane] = per_d / (ONE + gap)")
    for robot, bit, sign in (("robot", "I(1)", ""), ("other", "I(2)", "-")):
        with source.lanes():
            source(f"arrives = I(I(work.happens[lane] & {bit}) != I(0))")
            source(f"weight = {sign}work.per_d[lane] if arrives != I(0) else ZERO")
            source(f"{robot}.heard[lane] = I({robot}.heard[lane] + arrives)")
            for along in "xy":
                now = f"{robot}.now_{along}[lane]"
                source(f"{now} = fma(weight, work.d{along}[lane], {now})")


def _see(source: Source) -> None:
    """How far the bodies are on each other's rays, one lane at a time: few are so near."""
    with source.inside("for lane in range(width):"), source.inside("if work.near[lane]:"):
        source("dx, dy = work.dx[lane], work.dy[lane]")
        source("epuck.see(robot, lane, dx, dy, radius)\nepuck.see(other, lane, -dx, -dy, radius)")


def _to_lamp(source: Source, light: int, robot: str) -> None:
    """Unit vector towards a lamp, and how far from the robot bodies stand in its light."""
    x, y, height = (source.number(f"light{light}_{name}") for name in ("x", "y", "height"))
    source(f"lamp_x, lamp_y = {x} - {robot}.x[lane], {y} - {robot}.y[lane]")
    source("lamp2 = fma(lamp_x, lamp_x, lamp_y * lamp_y)\nper_lamp = inverse_root(lamp2)")
    source(f"{robot}.lamp{light}_x[lane] = lamp_x * per_lamp")
    source(f"{robot}.lamp{light}_y[lane] = lamp_y * per_lamp")
    low = f"{source.number('shadow')} * lamp2 * per_lamp / {height}"
    source(f"{robot}.lamp{light}_low[lane] = {low}")


def _shade(source: Source, light: int) -> None:
    for robot, sign in (("robot", ""), ("other", "-")):
        with source.lanes():
            lamp = ", ".join(f"{robot}.lamp{light}_{name}[lane]" for name in ("x", "y", "low"))
            pair = f"{sign}work.dx[lane], {sign}work.dy[lane], work.d2[lane]"
            source(f"dark = epuck.shades({pair}, {lamp}, radius)")
            source(f"{robot}.dark{light}[lane] = I({robot}.dark{light}[lane] | dark)")


def of_the_arena(source: Source) -> None:
    """Readings of all sensors, and what they are summed up to."""
    source("# Sense.")
    if _named(source, "rab_x", "heard"):
        _messages(source)
    if _named(source, "prox_x"):
        with source.lanes():
            _rays_to_walls(source)
        with source.lanes():
            _proximity(source)
    if _named(source, "light_x"):
        with source.lanes():
            _light(source)
    if _named(source, "ground"):
        with source.lanes():
            _floor(source)


def _messages(source: Source) -> None:
    """The messages of this step in the robot's frame take the place of the oldest."""
    source(f"slot = step % {MEMORY}")
    for along, turned in (
        ("x", "fma(x, cos, y * sin)"),
        ("y", "fma(y, cos, -x * sin)"),
    ):
        with source.lanes():
            source("x, y = robot.now_x[lane], robot.now_y[lane]")
            source("cos, sin = robot.cos[lane], robot.sin[lane]")
            source(f"robot.memory_{along}[slot, lane] = {turned}")
        with source.lanes():
            terms = " + ".join(f"robot.memory_{along}[{at}, lane]" for at in range(MEMORY))
            source(f"robot.rab_{along}[lane] = {terms}")


def _rays_to_walls(source: Source) -> None:
    """The nearest wall on each ray: each wall is a plane, the nearest the greatest 1 / way."""
    from geswarm.sim.assembly.inert import surfaces

    source("x, y, cos, sin = robot.x[lane], robot.y[lane], robot.cos[lane], robot.sin[lane]")
    for ray, (ahead, left) in enumerate(_directions(RAYS[:4])):
        source(
            f"ray{ray}_x, ray{ray}_y = fma({ahead}, cos, -{left} * sin), "
            f"fma({ahead}, sin, {left} * cos)"
        )
        source(f"front{ray}, back{ray} = ZERO, ZERO")
    for surface in surfaces(source):
        source(f"gap, normal_x, normal_y = {surface}")
        source("per_gap = ONE / gap if gap > F(0.001) else F(1000.0)")
        source("normal_x, normal_y = normal_x * per_gap, normal_y * per_gap")
        for ray in range(4):
            source(f"away = fma(normal_x, ray{ray}_x, normal_y * ray{ray}_y)")
            source(f"front{ray} = -away if -away > front{ray} else front{ray}")
            source(f"back{ray} = away if away > back{ray} else back{ray}")
    for ray in range(4):
        for name, at in (("front", ray), ("back", ray + 4)):
            source(f"distance = epuck.wall_distance({name}{ray})")
            place = f"robot.rays[{at}, lane]"
            source(f"{place} = distance if distance < {place} else {place}")


def _noise(source: Source, first: int, number: int, noise: str) -> None:
    """A random number in two for each of some readings."""
    if number % 2 == 0:
        source(f"bits = thrown(robot.dice[lane], E_PUCK + {first + number // 2 + 2})")
    source(f"off = epuck.spread(bits, {number % 2}, {noise})")


def _proximity(source: Source) -> None:
    noise = source.number("proximity_noise")
    source("sum_x, sum_y = ZERO, ZERO")
    for ray, (cos, sin) in enumerate(_directions(READINGS)):
        _noise(source, 0, ray, noise)
        source(f"reading = epuck.between_0_and_1(epuck.curve(robot.rays[{ray}, lane]) + off)")
        source(f"sum_x, sum_y = fma(reading, {cos}, sum_x), fma(reading, {sin}, sum_y)")
    source("robot.prox_x[lane], robot.prox_y[lane] = epuck.capped(sum_x, sum_y)")


def _light(source: Source) -> None:
    lights = range(source.parts.ground.lights)
    noise = source.number("light_noise")
    source("cos, sin = robot.cos[lane], robot.sin[lane]")
    for light in lights:
        numbers = [f"light{light}_{name}" for name in ("x", "y", "height", "intensity")]
        x, y, height, intensity = map(source.number, numbers)
        source(f"x, y = {x} - robot.x[lane], {y} - robot.y[lane]")
        source(f"d2 = fma(x, x, fma(y, y, {height} * {height}))")
        source("ahead, left = fma(x, cos, y * sin), fma(y, cos, -x * sin)")
        source(f"bearing{light} = epuck.bearing_of(ahead, left)")
        source(f"bright = epuck.brightness_at(d2, {intensity})")
        source(f"bright{light} = bright if robot.dark{light}[lane] == I(0) else ZERO")
    source("sum_x, sum_y, lit = ZERO, ZERO, I(0)")
    for at, (cos, sin) in enumerate(_directions(READINGS)):
        _noise(source, _LIGHT, at, noise)
        looks = _number(math.radians(READINGS[at]))
        terms = [f"epuck.sensed_light(bearing{n}, {looks}, bright{n})" for n in lights]
        source(f"reading = epuck.between_0_and_1({' + '.join([*terms, 'off'])})")
        source("lit = I(lit | I(epuck.is_lit(reading)))")
        source(f"sum_x, sum_y = fma(reading, {cos}, sum_x), fma(reading, {sin}, sum_y)")
    source("robot.light_x[lane], robot.light_y[lane] = epuck.unit_if(lit != I(0), sum_x, sum_y)")


def _floor(source: Source) -> None:
    noise = source.number("ground_noise")
    source("cos, sin = robot.cos[lane], robot.sin[lane]")
    source("here_x, here_y = robot.x[lane], robot.y[lane]")
    source(f"bits = thrown(robot.dice[lane], E_PUCK + {_GROUND + 2})")
    source("black, white = I(0), I(0)")
    for number, (ahead, left) in enumerate(_EYES):
        source(f"x = fma({_number(ahead)}, cos, fma({_number(-left)}, sin, here_x))")
        source(f"y = fma({_number(ahead)}, sin, fma({_number(left)}, cos, here_y))")
        source(f"level = {ground.grey_level(source, 'x', 'y')}")
        source(f"is_black, is_white = epuck.ground_votes(level, bits, {number}, {noise})")
        source("black, white = I(black + is_black), I(white + is_white)")
    for colour in ("black", "white"):
        place = f"robot.votes_{colour}[lane]"
        source(f"{colour} = epuck.remember_votes({place}, {colour})\n{place} = {colour}")
        source(f"{colour} = epuck.most_votes({colour})")
    source("white = I(white * I(I(1) - black))")
    source("robot.ground[lane] = I(black + I(white * I(2)))")
