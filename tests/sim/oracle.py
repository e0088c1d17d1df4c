"""The model's control step in plain Python: slow, readable, and the definition of the kernels.

Only `draw` and `make_key` are shared in meaning with the kernels; they are written out again here.
"""

import math
from dataclasses import dataclass, field

from geswarm.rules import FORAGING, BehaviourChange
from geswarm.sim.kernels.table import ROW_BEHAVIOURS

RADIUS, WHEEL_BASE, CONTROL_STEP = 0.085, 0.14, 0.1
WORD = 0xFFFFFFFF
(ZONE_MISS, OUTCOME, WALK_HEADING, WALK_TIME, OBJECT_X, OBJECT_Y, START_X, START_Y) = range(8)
START_HEADING, START_WALK, START_WALK_TIME, START_OBJECT_X, START_OBJECT_Y = range(8, 13)
FIRST_ACTION = 16


def mix(h):
    h ^= h >> 16
    h = h * 0x7FEB352D & WORD
    h ^= h >> 15
    h = h * 0x846CA68B & WORD
    return h ^ h >> 16


def make_key(*numbers):
    words = []
    for h in (0x243F6A88, 0x85A308D3):
        for number in numbers:
            h = mix(h ^ number & WORD)
            h = mix((h + 0x9E3779B9 & WORD) ^ number >> 32)
        words.append(h)
    return tuple(words)


def draw(key, step, purpose):
    h = mix((step * 0x9E3779B9 & WORD) + key[0] & WORD)
    return mix((h ^ key[1]) + (purpose * 0x85EBCA6B & WORD) & WORD) / 2**32


@dataclass
class Robot:
    key: tuple
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    behaviour: str = FORAGING.initial_behaviour
    states: dict = field(
        default_factory=lambda: {s.name: s.initially for s in FORAGING.internal_states}
    )
    percepts: dict = field(default_factory=dict)
    carried: bool = False
    walk: float = 0.0
    walk_until: float = 0.0
    last_rule: int = -1


class Oracle:
    """A swarm in a scenario; `decide(robot, step)` changes the robot and says if it restarts."""

    def __init__(self, scenario, seed, individual=0, replicate=0):
        self.scenario = scenario
        self.step_number = self.picked = self.collected = self.lost = 0
        self.west, self.south = -scenario.width / 2, -scenario.length / 2
        self.east, self.north = -self.west, -self.south
        self.robots = [
            Robot(make_key(seed, individual, replicate, i)) for i in range(scenario.robots)
        ]
        if not self.scatter():
            self.fill_cells()
        for robot in self.robots:
            robot.theta = 2 * math.pi * draw(robot.key, 0, START_HEADING)
            self.restart_walk(robot, 0, START_WALK, START_WALK_TIME)
        arena = make_key(seed, individual, replicate, scenario.robots)
        self.objects = [
            self.object_place(draw(arena, o, START_OBJECT_X), draw(arena, o, START_OBJECT_Y))
            for o in range(scenario.objects)
        ]

    def start_band(self):
        south = self.south + RADIUS
        return south, min(self.south + self.scenario.nest, self.north - RADIUS)

    def scatter(self):
        reach = self.east - RADIUS
        south, north = self.start_band()
        for i, robot in enumerate(self.robots):
            for attempt in range(200):
                robot.x = reach * (2 * draw(robot.key, attempt, START_X) - 1)
                robot.y = south + (north - south) * draw(robot.key, attempt, START_Y)
                if all(distance(robot, other) >= 2 * RADIUS for other in self.robots[:i]):
                    break
            else:
                return False
        return True

    def fill_cells(self):
        south, north = self.start_band()
        widest = int(self.scenario.width / (2 * RADIUS) + 1e-9)
        rows = math.ceil(len(self.robots) / widest)
        columns = math.ceil(len(self.robots) / rows)
        width = self.scenario.width / columns
        depth = (north - south + 2 * RADIUS) / rows
        for i, robot in enumerate(self.robots):
            row, column = divmod(i, columns)
            u, v = (draw(robot.key, 200, purpose) - 0.5 for purpose in (START_X, START_Y))
            robot.x = self.west + (column + 0.5) * width + (width - 2 * RADIUS) * u
            robot.y = south - RADIUS + (row + 0.5) * depth + (depth - 2 * RADIUS) * v

    def object_place(self, u, v):
        # In a corner, a robot's centre is its radius away from both walls.
        reached = RADIUS - self.scenario.grip_reach / math.sqrt(2)
        margin = max(self.scenario.object_margin, reached)
        south, north = self.north - self.scenario.source, self.north - margin
        return (self.east - margin) * (2 * u - 1), south + (north - south) * v

    def restart_walk(self, robot, step, heading, time):
        low, high = self.scenario.random_walk
        robot.walk = 2 * math.pi * draw(robot.key, step, heading)
        seconds = low + (high - low) * draw(robot.key, step, time)
        robot.walk_until = step + seconds / CONTROL_STEP

    def step(self, decide):
        now = self.step_number
        poses = [(robot.x, robot.y) for robot in self.robots]
        for i, robot in enumerate(self.robots):
            self.sense(robot, now)
            if decide(robot, now):
                self.restart_walk(robot, now, WALK_HEADING, WALK_TIME)
            self.act_on_objects(robot, now)
            self.move(robot, i, poses, now)
        self.collide()
        self.step_number += 1

    def in_nest(self, robot):
        return robot.y < self.south + self.scenario.nest

    def sense(self, robot, now):
        noticed = draw(robot.key, now, ZONE_MISS) >= self.scenario.zone_miss
        robot.percepts = {
            "ON_NEST": noticed and self.in_nest(robot),
            "ON_SOURCE": noticed and robot.y > self.north - self.scenario.source,
            "HAS_OBJECT": robot.carried,
        }

    def act_on_objects(self, robot, now):
        if robot.states["DROP_OBJECT"] and robot.carried:
            robot.carried = False
            if self.in_nest(robot):
                self.collected += 1
            else:
                self.lost += 1
        robot.states["DROP_OBJECT"] = False
        if robot.carried or not robot.states["WANT_OBJECT"]:
            return
        gaps = [math.hypot(x - robot.x, y - robot.y) for x, y in self.objects]
        if min(gaps) <= self.scenario.grip_reach:
            robot.carried = True
            self.picked += 1
            self.objects[gaps.index(min(gaps))] = self.object_place(
                draw(robot.key, now, OBJECT_X), draw(robot.key, now, OBJECT_Y)
            )

    def target(self, robot, now):
        if robot.behaviour == "RANDOM_WALK":
            if now >= robot.walk_until:
                self.restart_walk(robot, now, WALK_HEADING, WALK_TIME)
            return math.cos(robot.walk), math.sin(robot.walk)
        dx, dy = -robot.x, self.north + self.scenario.light - robot.y
        sign = 1 if robot.behaviour == "PHOTOTAXIS" else -1
        return sign * dx / math.hypot(dx, dy), sign * dy / math.hypot(dx, dy)

    def avoidance(self, robot, i, poses):
        ax = ay = 0.0
        for gap, nx, ny in (
            (robot.x - self.west, 1, 0),
            (self.east - robot.x, -1, 0),
            (robot.y - self.south, 0, 1),
            (self.north - robot.y, 0, -1),
        ):
            gap -= RADIUS
            if gap < self.scenario.proximity_range:
                ax += (1 - gap / self.scenario.proximity_range) * nx
                ay += (1 - gap / self.scenario.proximity_range) * ny
        for j, (x, y) in enumerate(poses):
            dx, dy = robot.x - x, robot.y - y
            d = math.hypot(dx, dy)
            if j != i and d < self.scenario.rab_range:
                # Two robots at the very same place part east and west, the first one to the east.
                ux, uy = (dx / d, dy / d) if d > 0 else (1 if i < j else -1, 0)
                ax += (1 - d / self.scenario.rab_range) * ux
                ay += (1 - d / self.scenario.rab_range) * uy
        return ax, ay

    def move(self, robot, i, poses, now):
        tx, ty = self.target(robot, now)
        ax, ay = self.avoidance(robot, i, poses)
        tx += self.scenario.avoidance_gain * ax
        ty += self.scenario.avoidance_gain * ay
        alpha = wrapped(math.atan2(ty, tx) - robot.theta) if (tx, ty) != (0, 0) else 0.0
        if alpha < 1e-9 - math.pi:
            alpha += 2 * math.pi  # straight behind: to the left, whatever the last bit says
        speed = self.scenario.max_speed * max(0.0, math.cos(alpha))
        turn = self.scenario.turn_gain * alpha
        wheels = (speed - turn * WHEEL_BASE / 2, speed + turn * WHEEL_BASE / 2)
        scale = min(1.0, self.scenario.max_speed / max(1e-300, *map(abs, wheels)))
        robot.theta += scale * turn * CONTROL_STEP
        robot.x += scale * speed * CONTROL_STEP * math.cos(robot.theta)
        robot.y += scale * speed * CONTROL_STEP * math.sin(robot.theta)

    def collide(self):
        for i, one in enumerate(self.robots):
            for other in self.robots[i + 1 :]:
                d = distance(one, other)
                if d < 2 * RADIUS:
                    dx, dy = one.x - other.x, one.y - other.y
                    ux, uy = (dx / d, dy / d) if d > 0 else (1, 0)
                    push = RADIUS - d / 2
                    one.x, one.y = one.x + push * ux, one.y + push * uy
                    other.x, other.y = other.x - push * ux, other.y - push * uy
        for robot in self.robots:
            robot.x = min(max(robot.x, self.west + RADIUS), self.east - RADIUS)
            robot.y = min(max(robot.y, self.south + RADIUS), self.north - RADIUS)


def distance(one, other):
    return math.hypot(one.x - other.x, one.y - other.y)


def wrapped(angle):
    return math.remainder(angle, 2 * math.pi)


def by_rules(rule_set, rule_counts=None, action_counts=None):
    """Decide by interpreting the rules; counts what fires."""

    def decide(robot, now):
        restart = False
        number = 0
        for r, rule in enumerate(rule_set.rules):
            active = rule.enabled and all(
                robot.percepts[str(p.percept)] == p.value for p in rule.preconditions
            )
            executed = list(map(str, rule.behaviours))
            active = active and (not executed or robot.behaviour in executed)
            fired = False
            for a, action in enumerate(rule.actions):
                if active and draw(robot.key, now, FIRST_ACTION + number) < action.p:
                    fired = True
                    if action_counts is not None:
                        action_counts[r][a] += 1
                    if isinstance(action, BehaviourChange):
                        target = str(action.behaviour)
                        if target != robot.behaviour:
                            restart = target == "RANDOM_WALK"
                        robot.behaviour = target
                    else:
                        robot.states[action.state] = action.value
                number += 1
            if fired:
                robot.last_rule = r
                if rule_counts is not None:
                    rule_counts[r] += 1
        return restart

    return decide


def by_table(tables, number=0):
    """Decide by one draw from the slots of a control table, which knows about missed zones."""
    names = [entry.name for entry in FORAGING.behaviours]
    state_names = [entry.name for entry in FORAGING.internal_states]
    first_code, first_row, _ = (int(begin) for begin in tables.begins[number])

    def decide(robot, now):
        zones = robot.percepts["ON_NEST"] + 2 * robot.percepts["ON_SOURCE"]
        code = zones + 4 * robot.carried + 8 * robot.states["WANT_OBJECT"]
        row = first_row + ROW_BEHAVIOURS * int(tables.classes[first_code + code])
        first_slot, slot_bits = divmod(int(tables.rows[row + names.index(robot.behaviour)]), 8)
        slot, rest = divmod(int(draw(robot.key, now, OUTCOME) * 2**32), 2 ** (32 - slot_bits))
        slot += first_slot
        other = rest * 2**slot_bits >= int(tables.thresholds[slot])
        outcome = int(tables.outcomes[2 * slot + other])
        robot.behaviour = names[outcome >> 1 & 31]
        states = bits(robot.states, FORAGING.state_index)
        states = states & ~(outcome >> 6 & 255) | outcome >> 14 & 255
        robot.states = {name: bool(states >> bit & 1) for bit, name in enumerate(state_names)}
        return bool(outcome & 1)

    return decide


def bits(values, names):
    return sum(values[name] << bit for bit, name in enumerate(names))
