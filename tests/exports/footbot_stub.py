"""A foot-bot as ARGoS 3 shows it to a Lua script: sensor readings from poses, in plain Python.

The formulas are those of ARGoS' sensors: 24 light sensors of which each sees the light less the
more it looks aside, 24 proximity rays from the body's edge, range and bearing in cm and radians.
"""

import math
import random

from lupa import lua53

from tests.sim.oracle import RADIUS

ANGLES = [math.remainder((i + 0.5) * math.pi / 12, 2 * math.pi) for i in range(24)]


class FootBot:
    """Runs a script; `uniform` takes its numbers from `random.Random(seed)`."""

    def __init__(self, script, seed=0, runtime=lua53.LuaRuntime):
        self.stream = random.Random(seed)
        self.lua = runtime()
        self.globals = self.lua.globals()
        self.wheels = None
        self.globals.robot = self.table(
            id="robot0",
            random=self.table(uniform=self.uniform),
            wheels=self.table(set_velocity=self.set_velocity),
            light=self.list_of(self.table(angle=angle, value=0.0) for angle in ANGLES),
            proximity=self.list_of(self.table(angle=angle, value=0.0) for angle in ANGLES),
            motor_ground=self.list_of(self.table(value=0.5) for _ in range(4)),
            range_and_bearing=self.lua.table(),
        )
        self.robot = self.globals.robot
        self.lua.execute(script)
        self.globals.init()

    def table(self, **entries):
        return self.lua.table_from(entries)

    def list_of(self, entries):
        return self.lua.table_from(list(entries))

    def uniform(self, *bounds):
        low, high = (0.0, 1.0) if not bounds else bounds if len(bounds) == 2 else (0.0, *bounds)
        return low + (high - low) * self.stream.random()

    def set_velocity(self, left, right):
        self.wheels = left, right

    def perceive(self, **percepts):
        for name, value in percepts.items():
            self.globals[name] = value

    def sense(self, scenario, pose, others):
        """Fill in all readings for a pose (x, y, theta) and the places of other robots."""
        for reading, value in zip(self.robot.light.values(), light(scenario, pose), strict=True):
            reading.value = value
        readings = proximity(scenario, pose, others)
        for reading, value in zip(self.robot.proximity.values(), readings, strict=True):
            reading.value = value
        self.robot.range_and_bearing = self.list_of(
            self.table(range=100 * distance, horizontal_bearing=bearing)
            for distance, bearing in neighbours(scenario, pose, others)
        )

    def step(self):
        self.globals.step()
        return self.globals.BEHAVIOUR


def light_direction(scenario, pose):
    x, y, theta = pose
    return math.atan2(scenario.length / 2 + scenario.light - y, -x) - theta


def light(scenario, pose):
    towards = light_direction(scenario, pose)
    return [
        0.8 * max(0.0, 1 - abs(math.remainder(towards - angle, 2 * math.pi)) / (math.pi / 2))
        for angle in ANGLES
    ]


def proximity(scenario, pose, others):
    x, y, theta = pose
    east, north = scenario.width / 2, scenario.length / 2
    readings = []
    for angle in ANGLES:
        dx, dy = math.cos(theta + angle), math.sin(theta + angle)
        hits = []
        if dx:
            hits.append((math.copysign(east, dx) - x) / dx)
        if dy:
            hits.append((math.copysign(north, dy) - y) / dy)
        for ox, oy in others:
            along, aside = (ox - x) * dx + (oy - y) * dy, (oy - y) * dx - (ox - x) * dy
            if along > 0 and abs(aside) < RADIUS:
                hits.append(along - math.sqrt(RADIUS**2 - aside**2))
        gap = max(0.0, min(hits) - RADIUS)
        if gap > 0.1:
            readings.append(0.0)
        else:
            readings.append(1.0 if gap < 0.009889556 else 0.0100527 / (gap + 0.000163144))
    return readings


def neighbours(scenario, pose, others):
    x, y, theta = pose
    for ox, oy in others:
        distance = math.hypot(ox - x, oy - y)
        if distance < scenario.rab_range:
            bearing = math.remainder(math.atan2(oy - y, ox - x) - theta, 2 * math.pi)
            yield distance, bearing
