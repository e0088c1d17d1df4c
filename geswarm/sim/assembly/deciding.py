"""Source of how robots sense and decide: by one draw from a control table, or rule by rule."""

from __future__ import annotations

from geswarm.sim.assembly import acting, ground
from geswarm.sim.assembly.source import Source
from geswarm.sim.kernels.draws import FIRST_CHANCE
from geswarm.sim.kernels.table import ROW_BEHAVIOURS
from geswarm.sim.terms.component import Sensor


def decide(source: Source) -> None:
    """Sense and decide: the robot's behaviour and registers, and whether it starts afresh."""
    if any("object_near" in sensor.needs for sensor in source.parts.sensors):
        _look_for_objects(source)
    if source.layout.rules:
        _sense(source)
        _interpret(source)
        _count_decisions(source)
    else:
        _draw_from_table(source)
    if source.parts.arguments:
        look_up_arguments(source)


def _look_for_objects(source: Source) -> None:
    """Whether an object is near each robot of the block: `object_near`."""
    source("# Whether an object is in sight.")
    reach = source.number("object_range")
    if source.layout.swarm:
        sides = acting.sides_of_objects(source)
        with source.inside("for lane in range(LANES):"):
            source(
                f"o = nearest_object(objects, grid, robot.x[lane], robot.y[lane], {reach}, {sides})"
            )
            source("work.object_near[lane] = I(o >= 0)")
        return
    acting.distance_to_objects(source)
    with source.lanes():
        source(f"work.object_near[lane] = I(work.nearest[lane] <= {reach} * {reach})")


def _read(source: Source, sensor: Sensor) -> None:
    """A reading; of terms that are not GESwarm's own, kept in its range whatever they return."""
    now = f"{sensor.name}_now"
    source(f"{now} = {source.call(sensor)}")
    if sensor.module and not sensor.module.startswith("geswarm."):
        source(f"{now} = I({now})\n{now} = {now} if {now} > I(0) else I(0)")
        source(f"{now} = {now} if {now} < I({sensor.values - 1}) else I({sensor.values - 1})")


def _code(source: Source, readings: list[str]) -> str:
    """The readings as one number, the first one counting least."""
    code, size = "", 1
    for sensor, reading in zip(source.parts.sensors, readings, strict=True):
        code = f"U({reading})" if size == 1 else f"U({code} + U(U({reading}) * U({size})))"
        size *= sensor.values
    return code


def _draw_from_table(source: Source) -> None:
    source("# Sense: where the situation's class stands in the control table.")
    with source.lanes():
        ground.prelude(source, *source.parts.sensors)
        for sensor in source.parts.sensors:
            _read(source, sensor)
        code = _code(source, [f"{sensor.name}_now" for sensor in source.parts.sensors])
        source(f"work.place[lane] = U({code} + group.codes[lane])")
        source("work.row[lane] = U(U(robot.behaviour[lane]) + group.rows[lane])")
        source("low, high = robot.key_low[lane], robot.key_high[lane]")
        source("work.bits[lane] = draw_bits(low, high, step, OUTCOME)")
        ground.keep(source)
    source(
        "# Decide: class, row, slot, which of its two outcomes. A look-up has a loop of its own."
    )
    with source.lanes():
        source("work.word[lane] = U(classes[work.place[lane]])")
    with source.lanes():
        source(f"work.row[lane] = U(work.row[lane] + U(work.word[lane] * U({ROW_BEHAVIOURS})))")
    with source.lanes():
        source("work.word[lane] = rows[work.row[lane]]")
    with source.lanes():
        source("slot_bits = U(work.word[lane] & U(7))\nfirst_slot = U(work.word[lane] >> U(3))")
        source("work.place[lane] = U(first_slot + slot_of(work.bits[lane], slot_bits))")
        source("work.bits[lane] = U(work.bits[lane] << slot_bits)")
    with source.lanes():
        source("work.word[lane] = thresholds[work.place[lane]]")
    with source.lanes():
        source("other = U(work.bits[lane] >= work.word[lane])")
        source("work.place[lane] = U(U(work.place[lane] << U(1)) + other)")
    with source.lanes():
        source("work.word[lane] = outcomes[work.place[lane]]")
    with source.lanes():
        source("outcome = I(work.word[lane])")
        source("robot.behaviour[lane] = I(I(outcome >> I(1)) & I(31))")
        source("work.restarts[lane] = I(outcome & I(1))")
        if source.parts.registers:
            source("clears, sets = I(I(outcome >> I(6)) & I(255)), I(I(outcome >> I(14)) & I(255))")
            source("robot.state[lane] = I(I(robot.state[lane] & I(~clears)) | sets)")
        if source.parts.counter is not None:
            source("added = I(I(I(outcome >> I(22)) & I(15)) - I(8))")
            source("least, most = I(I(outcome >> I(26)) & I(7)), I(I(outcome >> I(29)) & I(7))")
            source(f"robot.state[lane] = {_counted(source)}")


def _counted(source: Source) -> str:
    """The registers with the counter as it is after `added`, from `least` to `most`."""
    assert source.parts.counter is not None
    shift = source.parts.shifts[source.parts.counter.name]
    source(f"counter = I(I(I(robot.state[lane] >> I({shift})) & I(7)) + added)")
    source("counter = counter if counter > least else least")
    source("counter = counter if counter < most else most")
    return f"I(I(robot.state[lane] & I({~(7 << shift)})) | I(counter << I({shift})))"


def _sense(source: Source) -> None:
    source("# Sense; a reading may fail as a whole.")
    failing = [sensor for sensor in source.parts.sensors if sensor.fails]
    for number, sensor in enumerate(failing):
        source(f"miss_{sensor.name} = misses[{number}].threshold")
        source(f"may_miss_{sensor.name} = misses[{number}].possible")
    with source.lanes():
        source("low, high = robot.key_low[lane], robot.key_high[lane]")
        ground.prelude(source, *source.parts.sensors)
        for sensor in source.parts.sensors:
            now = f"{sensor.name}_now"
            _read(source, sensor)
            if sensor.fails:
                purpose = source.parts.purpose(sensor, sensor.fails)
                source(f"drawn = draw_bits(low, high, step, {purpose})")
                source(f"missed = I(may_miss_{sensor.name} & I(drawn <= miss_{sensor.name}))")
                source(f"{now} = I({now} * I(I(1) - missed))")
            source(f"work.{now}[lane] = {now}")
        ground.keep(source)
        code = _code(source, [f"{sensor.name}_now" for sensor in source.parts.sensors])
        source(f"seen = I(U({code} % U({source.parts.sensed_codes})))")
        source("memory = I(I(robot.behaviour[lane] * I(STATES)) + robot.state[lane])")
        source("work.memory[lane] = I(I(seen * I(BEHAVIOURS * STATES)) + memory)")
        source("robot.percepts[lane] = seen")
        source("work.restarts[lane] = I(0)")


def _interpret(source: Source) -> None:
    source("# Decide: rule by rule, all robots of the block at once.")
    with source.inside("for r in range(len(rules)):"):
        source("rule = rules[r]\nbehaviours, some = rule.behaviours, I(0)")
        for number, sensor in enumerate(source.parts.sensors):
            source(f"accepted_{sensor.name} = accepted[r, {number}]")
        with source.lanes():
            source("active = I(U(behaviours >> U(robot.behaviour[lane])) & U(1))")
            for sensor in source.parts.sensors:
                reading = f"work.{sensor.name}_now[lane]"
                source(f"active = I(active & {_accepts(sensor.name, reading, sensor.values)})")
            if source.layout.swarm:
                source("active = I(active & robot.exists[lane])")
            source("work.active[lane], work.fired[lane] = active, I(0)\nsome = I(some | active)")
        with source.inside("if some and rule.enabled:"):
            _draw_preconditions(source)
            with source.inside("for a in range(rule.first_action, rule.end_action):"):
                _act(source)
            source("fired = I(0)")
            with source.lanes():
                source("last = robot.last_rule[lane]")
                source("robot.last_rule[lane] = I(r) if work.fired[lane] != I(0) else last")
                source("fired = I(fired + work.fired[lane])")
            source("rule.fired += fired")


def _draw_preconditions(source: Source) -> None:
    """In which robots a rule is active whose preconditions hold by chance."""
    drawn = source.parts.drawn_sensors
    for number, sensor in enumerate(drawn):
        purpose = f"{FIRST_CHANCE + number} + {len(drawn)} * r"
        with source.lanes():
            source("low, high = robot.key_low[lane], robot.key_high[lane]")
            source(f"threshold = holding[r, {number}, work.{sensor.name}_now[lane]]")
            source(f"holds = I(draw_bits(low, high, step, {purpose}) <= threshold)")
            source("work.active[lane] = I(work.active[lane] & holds)")


def _accepts(name: str, reading: str, values: int) -> str:
    if values <= 32:
        return f"I(U(U(accepted_{name}) >> U({reading})) & U(1))"
    return f"I((accepted_{name} >> np.uint64({reading})) & np.uint64(1))"


def _act(source: Source) -> None:
    """One action of a rule, for all robots in which the rule is active."""
    source("action = actions[a]\nfired = I(0)")
    source("threshold, possible, target = action.threshold, action.possible, action.target")
    source("keeps, sets, afresh = I(~action.clears), action.sets, action.restarts")
    if source.parts.counter is not None:
        source("added, least, most = action.added, action.least, action.most")
    with source.lanes():
        source("low, high = robot.key_low[lane], robot.key_high[lane]")
        source("drawn = draw_bits(low, high, step, FIRST_ACTION + a)")
        source("happens = I(I(work.active[lane] & possible) & I(drawn <= threshold))")
        source("fired = I(fired + happens)\nwork.fired[lane] = I(work.fired[lane] | happens)")
        source.set_field("state", "I(I(robot.state[lane] & keeps) | sets)")
        if source.parts.counter is not None:
            source.set_field("state", _counted(source))
        source("happens = I(happens & I(I(target >= I(0)) & I(robot.behaviour[lane] != target)))")
        source.set_field("behaviour", "target")
        source("work.restarts[lane] = afresh if happens != I(0) else work.restarts[lane]")
    source("action.fired += fired")


def _count_decisions(source: Source) -> None:
    """How often robots came from each situation to each outcome."""
    source("# Count from which situation they came to which outcome.")
    outcomes = 2 * source.parts.most_instances * source.parts.states
    with source.inside("if len(decisions):"):
        with source.lanes():
            source("after = I(I(robot.behaviour[lane] * I(STATES)) + robot.state[lane])")
            source("outcome = I(I(after * I(2)) + work.restarts[lane])")
            source(f"work.place[lane] = U(I(work.memory[lane] * I({outcomes})) + outcome)")
        with source.lanes():
            one = "robot.exists[lane]" if source.layout.swarm else "1"
            source(f"decisions[work.place[lane]] += {one}")


def look_up_arguments(source: Source) -> None:
    """Which behaviour an instance is, and with which arguments."""
    source("# Behaviours are instances: which one, with which arguments.")
    offset = "I(0)" if source.layout.rules else "I(group.instances[lane])"
    with source.lanes():
        source(f"work.place[lane] = U(robot.behaviour[lane] + {offset})")
    with source.lanes():
        source("work.kind[lane] = kinds[work.place[lane]]")
    for number in range(source.parts.arguments):
        with source.lanes():
            source(f"work.argument{number}[lane] = arguments[work.place[lane], {number}]")
