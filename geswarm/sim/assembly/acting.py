"""Source of what robots do: behaviours that start afresh, effects, motion."""

from __future__ import annotations

from geswarm.sim.assembly import ground
from geswarm.sim.assembly.source import Source, plus, zero
from geswarm.sim.terms.component import Behaviour, Component, Effect, Measure, Update
from geswarm.sim.terms.parts import of_object


def _which(source: Source) -> str:
    return "work.kind[lane]" if source.parts.arguments else "robot.behaviour[lane]"


def _exists(source: Source, flag: str) -> str:
    return f"I({flag} & robot.exists[lane])" if source.layout.swarm else flag


def _call(source: Source, component: Component, behaviour: Behaviour) -> str:
    """A call that knows the behaviour's arguments."""
    places = {name: f"work.argument{k}[lane]" for k, name in enumerate(behaviour.arguments)}
    return source.call(component, **places)


def start_afresh(source: Source) -> None:
    """What changing to a behaviour does, or its starting again by itself."""
    for code, behaviour in enumerate(source.parts.behaviours):
        if behaviour.start is None:
            continue
        source(f"# {behaviour.name} starts afresh.\nsome = I(0)")
        with source.lanes():
            ground.prelude(source, behaviour.again)
            flag = "work.restarts[lane]"
            if behaviour.again:
                flag = f"I({flag} | {_call(source, behaviour.again, behaviour)})"
            source(f"happens = I(I({_which(source)} == I({code})) & {flag})")
            source("work.happens[lane] = happens\nsome = I(some | happens)")
        with source.inside("if some:"), source.lanes():
            ground.prelude(source, behaviour.start)
            source("happens = work.happens[lane]")
            _update(source, behaviour.start, behaviour)


def _update(source: Source, update: Update, behaviour: Behaviour | None = None) -> None:
    """New values of fields where it happens."""
    news = ", ".join(f"new_{name}" for name in update.writes)
    source(f"{news} = {_drawn_call(source, update, behaviour)}")
    for name in update.writes:
        source.set_field(name, f"new_{name}")


def _drawn_call(source: Source, update: Update, behaviour: Behaviour | None = None) -> str:
    """Draw what an update needs; the call."""
    local = {name: f"bits_{name}" for name in update.draws}
    if behaviour is not None:
        local |= {name: f"work.argument{k}[lane]" for k, name in enumerate(behaviour.arguments)}
    if update.draws:
        source("low, high = robot.key_low[lane], robot.key_high[lane]")
    for name in update.draws:
        source(f"bits_{name} = draw_bits(low, high, step, {source.parts.purpose(update, name)})")
    ground.fresh_place(source, update)
    return source.call(update, **local)


def go_on(source: Source) -> None:
    """What behaviours note down in each step in which they are executed."""
    for code, behaviour in enumerate(source.parts.behaviours):
        if behaviour.goes_on:
            with source.lanes():
                source(f"happens = I({_which(source)} == I({code}))")
                _update(source, behaviour.goes_on, behaviour)


def effects(source: Source) -> None:
    """What happens to robots and objects; momentary registers fall back."""
    for effect in source.parts.effects:
        source(f"# Effect {effect.name}.")
        if effect.nearest:
            _effect_on_nearest(source, effect)
        else:
            with source.lanes():
                ground.prelude(source, effect, effect.then, *_counted_at(source, effect))
                source(f"happens = {_exists(source, source.call(effect))}")
                _measures(source, effect)
                if effect.then:
                    _update(source, effect.then)
    parts = source.parts
    if any(register.momentary for register in parts.registers):
        source("# Momentary registers fall back.")
        with source.lanes():
            kept = f"I(robot.state[lane] & I({parts.lasting}))"
            if parts.momentary_state:
                kept = f"I({kept} | I({parts.momentary_state}))"
            source(f"robot.state[lane] = {kept}")


def _effect_on_nearest(source: Source, effect: Effect) -> None:
    """Robots of few are compared with all objects; those of a swarm look into the objects' grid."""
    assert effect.nearest is not None
    assert effect.then is not None
    reach = source.number(effect.nearest)
    source("some = I(0)")
    with source.lanes():
        ground.prelude(source, effect)
        source(f"happens = {_exists(source, source.call(effect))}")
        if source.layout.swarm:
            sides = sides_of_objects(source)
            inside = f"is_near(robot.x[lane], robot.y[lane], {reach}, {sides})"
            source(f"happens = I(happens & {inside})\nsome = I(some | happens)")
        source("work.happens[lane] = happens")
    if not source.layout.swarm:
        _find_nearest(source, reach)
    with (
        source.inside("if some:"),
        source.inside(f"for lane in range({'LANES' if source.layout.swarm else 'width'}):"),
        source.inside("if work.happens[lane]:"),
    ):
        if source.layout.swarm:
            source(
                f"o = nearest_object(objects, grid, robot.x[lane], robot.y[lane], {reach}, {sides})"
            )
            with source.inside("if o >= 0:"):
                _take(source, effect, effect.then)
        else:
            source("o = 0")
            with source.inside("while distance2(objects[o], robot, lane) != work.nearest[lane]:"):
                source("o += 1")
            _take(source, effect, effect.then)


_SIDES = ("west", "south", "east", "north")


def sides_of_objects(source: Source) -> str:
    """Names of the sides of the box in which objects lie."""
    return ", ".join(source.number(f"objects_{side}") for side in _SIDES)


def distance_to_objects(source: Source) -> None:
    """How near the nearest object is in each lane, squared: `work.nearest`."""
    with source.lanes():
        source("work.nearest[lane] = FAR")
    with source.inside("for o in range(len(objects)):"):
        source("item = objects[o]")
        with source.lanes():
            source("d2 = distance2(item, robot, lane)")
            source("work.nearest[lane] = d2 if d2 < work.nearest[lane] else work.nearest[lane]")


def _find_nearest(source: Source, reach: str) -> None:
    """Whether the nearest object is within reach in each lane."""
    distance_to_objects(source)
    with source.lanes():
        source(f"happens = I(work.happens[lane] & I(work.nearest[lane] <= {reach} * {reach}))")
        source("work.happens[lane] = happens\nsome = I(some | happens)")


def _take(source: Source, effect: Effect, update: Update) -> None:
    """The effect on object o, in one lane."""
    source("happens = I(1)")
    ground.prelude(source, update, *_counted_at(source, effect))
    _measures(source, effect)
    places = []
    moves = any(of_object(name) for name in update.writes)
    for name in update.writes:
        at = {"object_x": ("x", 0), "object_y": ("y", 1)}.get(name)
        if at is None:
            places.append(f"robot.{name}[lane]")
        else:
            places.append(
                f"objects[o, {at[1]}]" if source.layout.swarm else f"objects[o].{at[0]}[lane]"
            )
    sides = sides_of_objects(source) if source.layout.swarm else ""
    if source.layout.swarm and moves:
        source(f"remove_object(objects, grid, o, {sides})")
    call = _drawn_call(source, update)
    source(f"{', '.join(places)} = {call}")
    if source.layout.swarm and moves:
        source(f"insert_object(objects, grid, o, {sides})")


def _measures(source: Source, at: Effect) -> None:
    for measure in _counted_at(source, at):
        count(source, measure, "happens != I(0)")


def _counted_at(source: Source, at: Effect) -> list[Measure]:
    return [each for each in source.parts.measures if isinstance(each, Measure) and each.at is at]


def count(source: Source, measure: Measure, where: str | None, afresh: bool = False) -> None:
    """Add what a measure counts for the robot of the lane, where it is to be counted.

    If `afresh`, nothing of before counts.
    """
    kind = source.parts.own_fields[measure.name]
    value = source.call(measure)
    if where:
        value = f"({value} if {where} else {zero(kind)})"
    place = f"robot.{measure.name}[lane]"
    source(f"{place} = {value if afresh else plus(kind, place, value)}")


def move(source: Source) -> None:
    """Target of the behaviour, what steers all, wheels."""
    source("# Move: the behaviour's target and what steers all of them, by the wheels.")
    with source.lanes():
        ground.remember(source)
        ground.prelude(source, *source.parts.behaviours, *source.parts.steering, moves=True)
        choose_target(source)
        for number, steering in enumerate(source.parts.steering):
            gain = source.number(steering.gain)
            source(f"by_x_{number}, by_y_{number} = {source.call(steering)}")
            source(
                f"to_x = fma({gain}, by_x_{number}, to_x)\nto_y = fma({gain}, by_y_{number}, to_y)"
            )
        _drive(source)


def choose_target(source: Source) -> None:
    """The target of the robot's behaviour, and its share of the highest speed if one has it."""
    paced = any(behaviour.paced for behaviour in source.parts.behaviours)
    source(f"behaviour = {_which(source)}")
    for code, behaviour in enumerate(source.parts.behaviours):
        results = f"to_x_{code}, to_y_{code}" + (f", pace_{code}" if behaviour.paced else "")
        source(f"{results} = {_call(source, behaviour, behaviour)}")
    last = len(source.parts.behaviours) - 1
    chosen = ("to_x", "to_y", "pace") if paced else ("to_x", "to_y")
    for code in range(last, -1, -1):
        for name in chosen:
            value = f"{name}_{code}"
            if name == "pace" and not source.parts.behaviours[code].paced:
                value = "ONE"
            choice = value if code == last else f"{value} if behaviour == I({code}) else {name}"
            source(f"{name} = {choice}")


def _drive(source: Source) -> None:
    names = ("max_speed", "turn_gain", "wheel_base", "control_step")
    numbers = ", ".join(source.number(name) for name in names)
    source("cos, sin = robot.cos[lane], robot.sin[lane]")
    source(f"turned, way = wheels(to_x, to_y, cos, sin, {numbers})")
    if any(behaviour.paced for behaviour in source.parts.behaviours):
        source("turned, way = turned * pace, way * pace")
    turn = "turn_far" if source.layout.wide else "turn"
    source(f"cos, sin, unit = {turn}(cos, sin, turned)")
    source("robot.cos[lane], robot.sin[lane] = cos * unit, sin * unit")
    for along, part in (("x", "cos"), ("y", "sin")):
        place = f"robot.{along}[lane]"
        if source.layout.wide:
            low = f"robot.low_{along}[lane]"
            source(f"{place}, {low} = advance_exactly({place}, {low}, way, {part})")
        else:
            source(f"{place} = fma(way, {part}, {place})")
