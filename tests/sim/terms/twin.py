"""Sensors and behaviours in plain Python: what robots read, and where they are a step later."""

import math

from geswarm.sim import CONTROL_STEP
from geswarm.sim.footbot import RADIUS
from tests.sim import oracle
from tests.sim.assembly import ground_twin

DOUBT = 2e-5
"""Metres within which single precision may see something on either side of an edge."""


def others(places, i):
    """(vector from each other robot to robot i, distance)."""
    x, y = places[i]
    for j, (other_x, other_y) in enumerate(places):
        if j != i:
            dx, dy = x - other_x, y - other_y
            yield dx, dy, math.hypot(dx, dy)


def near(gaps, reach):
    """Whether a least gap is within reach, both where that is in doubt."""
    gap = min(gaps, default=math.inf)
    return {gap < reach - DOUBT, gap < reach + DOUBT}


def readings(scenario, seen, i):
    """What robot i may read, by name of the reading: a set each, of two values if in doubt."""
    arena, places = scenario.arena, list(zip(seen.x.tolist(), seen.y.tolist(), strict=True))
    at = places[i]
    distances = [d for _, _, d in others(places, i)]
    neighbours = [
        sum(d < scenario.rab_range + doubt for d in distances) for doubt in (-DOUBT, DOUBT)
    ]
    light = ground_twin.brightness(arena, *at)
    colour, doubt = ground_twin.floor(arena, *at)
    found = {
        "HAS_OBJECT": {bool(seen.carried[i])},
        "SEES_OBJECT": near((math.dist(at, o) for o in seen.objects), scenario.object_range),
        "SEES_OBSTACLE": near(
            [
                ground_twin.clearance(arena, *at) - RADIUS,
                *(d - 2 * RADIUS for d in distances),
            ],
            scenario.proximity_range,
        ),
        "neighbours": {min(7, count) for count in range(neighbours[0], neighbours[1] + 1)},
        "light_level": {min(7, int(light * (1 + sign * 1e-5))) for sign in (-1, 1)},
        "floor": {arena.colours[colour]} if doubt > DOUBT else set(arena.colours),
    }
    for name in arena.areas:
        inside, doubt = ground_twin.in_area(arena, name, *at)
        found[f"ON_{name.upper()}"] = {inside} if doubt > DOUBT else {False, True}
    return found


class Walks:
    """The headings of robots that walk at random with times of their own."""

    def __init__(self, world):
        self.parts = world._parts
        self.until, self.heading = {}, {}
        self.keys = [oracle.make_key(world.seed, 0, 0, i) for i in range(world.scenario.robots)]

    def drawn(self, i, step, name):
        (update,) = (each for each in self.parts.updates if name in each.draws)
        return oracle.draw(self.keys[i], step, self.parts.purpose(update, name))

    def target(self, i, term, step, changed):
        if changed or step >= self.until[i]:
            shortest, longest = term.arguments
            self.heading[i] = 2 * math.pi * self.drawn(i, step, "wander_heading")
            kept = shortest + max(0, longest - shortest) * self.drawn(i, step, "wander_time")
            self.until[i] = step + 1 + int(kept / CONTROL_STEP)
        return math.cos(self.heading[i]), math.sin(self.heading[i])


def target(scenario, places, i, term, walk):
    """The target of a behaviour; `walk` is where random walk goes to."""
    if term.name == "RANDOM_WALK":
        return walk
    if term.name in ("PHOTOTAXIS", "ANTI-PHOTOTAXIS"):
        sign = 1 if term.name == "PHOTOTAXIS" else -1
        x, y = ground_twin.to_light(scenario.arena, *places[i])
        return sign * x, sign * y
    sign = -1 if term.name == "ATTRACTION" else 1
    x = y = 0.0
    for dx, dy, d in others(places, i):
        if d < scenario.rab_range:
            weight = sign * term.arguments[0] / (1 + 100 * d)
            x, y = x + weight * dx / d, y + weight * dy / d
    return x, y


def moved(scenario, places, theta, i, to):
    """Pose of robot i after a step to a target, if nobody pushes it; and how sure that is."""
    x, y = places[i]
    push = ground_twin.push(scenario.arena, x, y, RADIUS + scenario.proximity_range)
    away = [part / scenario.proximity_range for part in push]
    for dx, dy, d in others(places, i):
        if d < scenario.avoidance_range:
            away = [
                a + (1 - d / scenario.avoidance_range) * along / d
                for a, along in zip(away, (dx, dy), strict=True)
            ]
    tx, ty = (t + scenario.avoidance_gain * a for t, a in zip(to, away, strict=True))
    length = math.hypot(tx, ty)
    alpha = oracle.wrapped(math.atan2(ty, tx) - theta) if length else 0.0
    speed = scenario.max_speed * max(0.0, math.cos(alpha))
    turn = scenario.turn_gain * alpha
    wheel = abs(turn) * oracle.WHEEL_BASE / 2 + speed
    scale = min(1.0, scenario.max_speed / wheel) * CONTROL_STEP if wheel else 0.0
    theta += scale * turn
    pose = x + scale * speed * math.cos(theta), y + scale * speed * math.sin(theta), theta
    sure = (length == 0 or length > 0.01) and abs(alpha) < math.pi - 0.01
    return pose, sure
