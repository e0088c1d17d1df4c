"""Source of what the arena does: areas, floor, walls, obstacles and lights.

Components may name

| name | meaning |
| --- | --- |
| `in_<area>` | 1 if the robot's centre is in the area, else 0 |
| `floor` | the colour's number of the topmost patch at the robot's centre, 0 beside all of them |
| `push_x`, `push_y` | from walls and obstacles, by how much each is nearer than sensed (m) |
| `to_light_x`, `to_light_y` | unit vector towards the light, of several the brighter ones more |
| `brightness` | the sum of how bright the lights are here |
| `fresh_x`, `fresh_y` | a random place in the source, for what draws `object_x` and `object_y` |

The first two are expressions; what follows is written before it is used, by `prelude`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from geswarm.sim.kernels.single import F
from geswarm.sim.terms.component import Component, Update
from geswarm.sim.terms.ground import Form, Ground

if TYPE_CHECKING:
    from geswarm.sim.assembly.source import Source
    from geswarm.sim.terms.parts import Parts

PUSH, TO_LIGHT, BRIGHTNESS = ("push_x", "push_y"), ("to_light_x", "to_light_y"), "brightness"
FRESH = ("fresh_x", "fresh_y")
WRITTEN = frozenset((*PUSH, *TO_LIGHT, BRIGHTNESS, *FRESH))
"""Names that stand for a variable, which `prelude` or `fresh_place` has written before."""

_BOX = ("x", "y", "half_width", "half_length")
_NUMBERS = {
    "disc": ("x", "y", "radius"),
    "box": _BOX,
    "turned": (*_BOX, "cos", "sin"),
    **dict.fromkeys(("south", "north", "west", "east"), ("edge",)),
}
_AT_ONCE = 3
"""Walls off which robots are pushed in one loop."""
_WALL = ("x", "y", "along_x", "along_y", "length")
_PLACES = {
    "box": ("x", "half_width", "south", "depth"),
    "turned": _NUMBERS["turned"],
    "disc": _NUMBERS["disc"],
}
_BEYOND = {"south": "{y} < {edge}", "north": "{y} > {edge}", "west": "{x} < {edge}"}
_BEYOND["east"] = "{x} > {edge}"


def variable(name: str) -> str:
    """What a name of `WRITTEN` is called in the source: not as some component may be."""
    return f"{name}_here"


def is_name(ground: Ground, name: str) -> bool:
    """Whether the arena gives a name its meaning."""
    return name in WRITTEN or name == "floor" or name.removeprefix("in_") in _named(ground, name)


def _named(ground: Ground, name: str) -> tuple[str, ...]:
    return ground.areas if name.startswith("in_") else ()


def expression(source: Source, name: str, robot: str, lane: str) -> str | None:
    """What a name of the arena means for a robot, or None if it is not one."""
    ground = source.parts.ground
    if not is_name(ground, name):
        return None
    if name in WRITTEN:
        return variable(name)
    x, y = f"{robot}.x[{lane}]", f"{robot}.y[{lane}]"
    if name == "floor":
        return _topmost(source, x, y, [f"I({patch.colour})" for patch in ground.patches], "I(0)")
    inside = [
        _inside(source, f"patch{number}", patch.form, x, y)
        for number, patch in enumerate(ground.patches)
        if patch.area == name.removeprefix("in_")
    ]
    return _folded("|", inside)


def _topmost(source: Source, x: str, y: str, values: list[str], beside: str) -> str:
    """The value of the topmost patch at a place that is painted, or that of the floor beside."""
    value = beside
    for number, patch in enumerate(source.parts.ground.patches):
        if patch.colour >= 0:
            here = _inside(source, f"patch{number}", patch.form, x, y)
            value = f"({values[number]} if {here} != I(0) else {value})"
    return value


def grey_level(source: Source, x: str, y: str) -> str:
    """How bright the floor is at a place, from 0 to 1."""
    ground = source.parts.ground
    values = [source.number(f"patch{number}_grey") for number in range(len(ground.patches))]
    return _topmost(source, x, y, values, source.number("floor_grey"))


def _inside(source: Source, prefix: str, form: Form, x: str, y: str) -> str:
    """Whether a place is in a shape."""
    if form.kind in _BEYOND:
        edge = source.number(f"{prefix}_edge")
        return f"I({_BEYOND[form.kind].format(x=x, y=y, edge=edge)})"
    if form.kind != "polygon":
        numbers = _numbers(source, prefix, _NUMBERS[form.kind])
        return f"geometry.in_{form.kind}({x}, {y}, {numbers})"
    sides = []
    for k in range(form.sides):
        begin = _numbers(source, prefix, (f"x{k}", f"y{k}"))
        end = _numbers(source, prefix, (f"y{(k + 1) % form.sides}", f"slope{k}"))
        sides.append(f"geometry.crosses({x}, {y}, {begin}, {end})")
    return _folded("^", sides)


def _folded(operator: str, parts: list[str]) -> str:
    """Bits combined one after the other, each result as wide as they are."""
    whole = parts[0]
    for part in parts[1:]:
        whole = f"I({whole} {operator} {part})"
    return whole


def _numbers(source: Source, prefix: str, names: tuple[str, ...]) -> str:
    return ", ".join(source.number(f"{prefix}_{name}") for name in names)


def kept(parts: Parts) -> tuple[str, ...]:
    """What sensors and the motion both name, and where no update moves robots in between.

    It is worked out once in a step, where robots sense, and then stands in `work`.
    """
    if any({"x", "y"} & set(update.writes) for update in parts.updates):
        return ()
    sensed = {name for each in parts.sensors for name in each.needs}
    moved = {name for each in (*parts.behaviours, *parts.steering) for name in each.needs}
    groups = (PUSH, TO_LIGHT, (BRIGHTNESS,))
    both = (group for group in groups if sensed & set(group) and moved & set(group))
    return tuple(name for group in both for name in group)


def keep(source: Source) -> None:
    """At the end of the loop in which robots sense."""
    for name in kept(source.parts):
        source(f"work.{name}[lane] = {variable(name)}")


def prelude(source: Source, *components: Component | None, moves: bool = False) -> None:
    """At the top of a loop over the lanes: variables that some of these components name.

    If it is the loop in which robots move, some stand in `work` already.
    """
    needs = {name for each in components if each is not None for name in each.needs}
    if moves:
        for name in kept(source.parts):
            source(f"{variable(name)} = work.{name}[lane]")
        needs -= set(kept(source.parts))
    pushed, lit = needs & set(PUSH), needs & set(TO_LIGHT)
    if not (pushed or lit or BRIGHTNESS in needs):
        return
    source("x, y = robot.x[lane], robot.y[lane]")
    if pushed:
        _push(source)
    if lit:
        _to_light(source)
    if BRIGHTNESS in needs:
        terms = [f"geometry.brightness({_light(source, k)})" for k in _lights(source)]
        source(f"{variable(BRIGHTNESS)} = {' + '.join(terms) or 'ZERO'}")


def _lights(source: Source) -> range:
    return range(source.parts.ground.lights)


def _light(source: Source, number: int) -> str:
    return f"x, y, {_numbers(source, f'light{number}', ('x', 'y', 'height', 'intensity'))}"


def _to_light(source: Source) -> None:
    here = ", ".join(map(variable, TO_LIGHT))
    lights = source.parts.ground.lights
    if lights == 0:
        source(f"{here} = ZERO, ZERO")
    elif lights == 1:
        source(f"{here} = geometry.to_light(x, y, {_numbers(source, 'light0', ('x', 'y'))})")
    else:
        source("all_x, all_y = ZERO, ZERO")
        for number in _lights(source):
            source(f"one_x, one_y = geometry.to_one_of({_light(source, number)})")
            source("all_x, all_y = all_x + one_x, all_y + one_y")
        source(f"{here} = geometry.unit(all_x, all_y)")


def _push(source: Source) -> None:
    ground = source.parts.ground
    push_x, push_y = map(variable, PUSH)
    push = f"{push_x}, {push_y}"
    source(f"sensed = {source.number('radius')} + {source.number('proximity_range')}")
    if ground.outline == "box":
        source(f"{push} = geometry.box_push(x, y, sensed, {_extent(source)})")
    else:
        source(f"{push} = ZERO, ZERO")
    for surface in _felt(source):
        source(f"gap, normal_x, normal_y = {surface}\nmore = geometry.above_zero(sensed - gap)")
        source(f"{push} = fma(more, normal_x, {push_x}), fma(more, normal_y, {push_y})")


def _extent(source: Source) -> str:
    return f"{source.number('half_width')}, {source.number('half_length')}"


def _felt(source: Source) -> Iterator[str]:
    """Surfaces that push, those of a box outline left out."""
    ground = source.parts.ground
    if ground.outline == "disc":
        yield f"geometry.round_wall(x, y, {source.number('arena_radius')})"
    for k in range(ground.sides):
        yield f"geometry.wall_ahead(x, y, {_numbers(source, f'wall{k}', _WALL)})"
    for k in ground.inner:
        before = _numbers(source, f"wall{(k - 1) % ground.sides}", ("along_x", "along_y"))
        yield f"geometry.corner_ahead(x, y, {_numbers(source, f'wall{k}', _WALL[:4])}, {before})"
    yield from _obstacles(source)


def _obstacles(source: Source) -> Iterator[str]:
    for k, form in enumerate(source.parts.ground.obstacles):
        numbers = _numbers(source, f"obstacle{k}", _NUMBERS[form.kind])
        yield f"geometry.{form.kind}(x, y, {numbers})"


def in_the_way(source: Source) -> Iterator[str]:
    """Surfaces that robots do not get through, those of a box or disc outline left out."""
    ground = source.parts.ground
    for k in range(ground.sides):
        if ground.outline == "convex":
            yield f"geometry.wall_line(x, y, {_numbers(source, f'wall{k}', _WALL[:4])})"
        else:
            yield f"geometry.wall(x, y, {_numbers(source, f'wall{k}', _WALL)})"
    yield from _obstacles(source)


def fields(ground: Ground, wide: bool) -> dict[str, type]:
    """Fields of a robot that hold where it was before a step, if it may have to go back."""
    if ground.is_plain:
        return {}
    names = ("before_x", "before_y", *(("before_low_x", "before_low_y") if wide else ()))
    return dict.fromkeys(names, F)


def remember(source: Source) -> None:
    """Before robots move: where they are."""
    for field in fields(source.parts.ground, source.layout.wide):
        source(f"robot.{field}[lane] = robot.{field.removeprefix('before_')}[lane]")


def keep_inside(source: Source) -> None:
    """After the robots of a block have moved: push them off the walls, or back where they were.

    Unless one clamp does it, it is seen first whether some robot is near any wall: that is less
    than half of the work, and often all.
    """
    if source.parts.ground.is_plain:
        with source.lanes():
            source("x, y = robot.x[lane], robot.y[lane]")
            _stay_in_outline(source)
            _moved(source)
        return
    source("some = I(0)")
    with source.lanes():
        source("x, y = robot.x[lane], robot.y[lane]")
        _look_for_walls(source)
    with source.inside("if some:"):
        _push_inside(source)


def _look_for_walls(source: Source) -> None:
    """Whether some robot is so near to something that it may have to be pushed or go back."""
    radius = source.number("radius")
    gaps = [f"{surface}[0]" for surface in in_the_way(source)]
    if source.parts.ground.outline == "box":
        gaps.append(f"geometry.box_gap(x, y, {_extent(source)})")
    elif source.parts.ground.outline == "disc":
        gaps.append(f"geometry.round_wall(x, y, {source.number('arena_radius')})[0]")
    source(f"nearest = {gaps[0]}")
    for gap in gaps[1:]:
        source(f"gap = {gap}\nnearest = gap if gap < nearest else nearest")
    source(f"near = I(nearest < {radius})")
    if source.parts.ground.may_be_crossed:
        _look_how_far(source)
        source("near = I(near | I(moved2 >= too_far * too_far))")
    source("some = I(some | near)")


def _look_how_far(source: Source) -> None:
    source("moved_x, moved_y = x - robot.before_x[lane], y - robot.before_y[lane]")
    source(f"too_far = F(1.999) * {source.number('clearance')}")
    source("moved2 = fma(moved_x, moved_x, moved_y * moved_y)")


def _stay_in_outline(source: Source) -> None:
    ground, radius = source.parts.ground, source.number("radius")
    if ground.outline == "box":
        reach = f"half_width - {radius}, half_length - {radius}"
        _extent(source)
        source(f"x, y = geometry.stay_in_box(x, y, {reach})")
    elif ground.outline == "disc":
        source(f"x, y = geometry.stay_in_disc(x, y, {source.number('arena_radius')} - {radius})")


def _moved(source: Source) -> None:
    source("robot.x[lane], robot.y[lane] = x, y")  # once, or LLVM fears that the loop meets itself


def _push_inside(source: Source) -> None:
    """Push robots off one wall after the other.

    Each push waits for the one before it. In short loops the processor does several vectors of
    lanes at once meanwhile.
    """
    radius, surfaces = source.number("radius"), list(in_the_way(source))
    for begin in range(0, len(surfaces), _AT_ONCE):
        with source.lanes():
            source("x, y = robot.x[lane], robot.y[lane]")
            if begin == 0:
                _stay_in_outline(source)
            for surface in surfaces[begin : begin + _AT_ONCE]:
                source(f"gap, normal_x, normal_y = {surface}")
                source(f"more = geometry.above_zero({radius} - gap)")
                source("x, y = fma(more, normal_x, x), fma(more, normal_y, y)")
            _moved(source)
    with source.lanes():
        source("x, y = robot.x[lane], robot.y[lane]")
        _go_back(source)
        _moved(source)


def _go_back(source: Source) -> None:
    """Robots that are too near to something, or may have got through, go back."""
    ground = source.parts.ground
    source(f"clear = {source.number('clearance')}\ngoes_back = I(0)")
    if ground.outline == "box":
        source(f"goes_back = I(geometry.box_gap(x, y, {_extent(source)}) < clear)")
    elif ground.outline == "disc":
        radius = source.number("arena_radius")
        source(f"gap, normal_x, normal_y = geometry.round_wall(x, y, {radius})")
        source("goes_back = I(gap < clear)")
    for surface in in_the_way(source):
        source(f"gap, normal_x, normal_y = {surface}\ngoes_back = I(goes_back | I(gap < clear))")
    if ground.may_be_crossed:
        _look_how_far(source)
        source("goes_back = I(goes_back | I(moved2 >= too_far * too_far))")
    for field in fields(ground, source.layout.wide):
        now = field.removeprefix("before_")
        now = now if now in ("x", "y") else f"robot.{now}[lane]"
        source(f"{now} = robot.{field}[lane] if goes_back != I(0) else {now}")


def fresh_place(source: Source, update: Update) -> None:
    """After its random bits were drawn: a place in the source, if the update names one."""
    kind = source.parts.ground.source
    if not set(FRESH) & set(update.needs):
        return
    in_triangles = kind == "triangles"  # as many as there may be, see `triangle_numbers`
    numbers = "numbers" if in_triangles else _numbers(source, "object", _PLACES[kind])
    place = ", ".join(map(variable, FRESH))
    bits = "bits_object_x, bits_object_y"
    source(f"{place} = geometry.place_in_{kind}({bits}, {numbers})")
