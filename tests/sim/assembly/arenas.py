"""Arenas of each form, with random numbers; and robots in them, without a scenario."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from hypothesis import strategies as st

from geswarm.sim import footbot, load_scenario
from geswarm.sim.arena.model import Arena, Band, Box, Disc, Light, Patch, Polygon, regular
from geswarm.sim.arena.numbers import ground_numbers, object_numbers, triangle_numbers
from geswarm.sim.arena.start_places import places_of, spots_of
from geswarm.sim.assembly.kernel import assemble
from geswarm.sim.assembly.records import GROUP, OBJECT, robot_type
from geswarm.sim.assembly.source import Layout
from geswarm.sim.controllers.encoding import fill_robots, grid_for, scenario_numbers
from geswarm.sim.controllers.starting import begun
from geswarm.sim.kernels.state import LANES, ROBOT, Beginning
from geswarm.sim.terms import avoidance, light, objects, walk
from geswarm.sim.terms.declare import measure, percept, sensor
from geswarm.sim.terms.ground import Ground
from tests.sim.assembly.made import parts_of

RADIUS, MARGIN = footbot.RADIUS, 0.1
PAPER = load_scenario("paper")


@sensor()
def at_nest(in_nest):
    return in_nest


@measure(at="end", kind=float)
def pushed_x(push_x):
    return push_x


@measure(at="end", kind=float)
def pushed_y(push_y):
    return push_y


@measure(at="end", kind=float)
def lit_x(to_light_x):
    return to_light_x


@measure(at="end", kind=float)
def lit_y(to_light_y):
    return to_light_y


@measure(at="end", kind=float)
def bright(brightness):
    return brightness


@measure(at="end")
def colour(floor):
    return floor


@measure(at="end")
def nested(in_nest):
    return in_nest


@measure(at="end")
def sourced(in_source):
    return in_source


MEASURED = (pushed_x, pushed_y, lit_x, lit_y, bright, colour, nested, sourced)


@cache
def parts_in(ground):
    return parts_of(
        f"in_{ground.outline}",
        percepts=(percept("ON_NEST", at_nest),),
        behaviours=(light.phototaxis, light.anti_phototaxis, walk.random_walk),
        first=walk.random_walk,
        registers=(objects.WANT_OBJECT, objects.DROP_OBJECT),
        sums=(avoidance.away_from_robot,),
        steering=(avoidance.avoid,),
        effects=(objects.drop, objects.pick_up),
        measures=(objects.picked, *MEASURED),
        ground=ground,
    )


@dataclass
class Run:
    """Robots in an arena that walk at random, drop what they carry and take objects."""

    arena: Arena
    layout: Layout
    robots: int = 3
    seed: int = 1
    number_of_objects: int = 4
    max_speed: float = 0.1

    def __post_init__(self):
        self.parts = parts_in(Ground.of(self.arena))
        self.kernel = assemble(self.parts, self.layout)
        arena = self.arena
        self.scenario = PAPER.with_changes(
            robots=self.robots,
            width=2 * arena.half_width,
            length=2 * arena.half_length,
            nest=2 * arena.half_length - 0.25,
            source=0.25,
            objects=self.number_of_objects,
            max_speed=self.max_speed,
        )
        known = {
            **scenario_numbers(self.scenario),
            **ground_numbers(arena, RADIUS),
            **object_numbers(arena, MARGIN),
        }
        named = [known[name] for name in self.kernel.numbers]
        self.numbers = np.array([*named, *triangle_numbers(arena, MARGIN)], dtype=np.float32)
        self.began, self.items = started(
            arena, self.robots, self.number_of_objects, self.seed, 1 if self.layout.swarm else 64
        )
        blocks = -(-self.robots // LANES) if self.layout.swarm else self.robots
        self.blocks = np.zeros(blocks, dtype=robot_type(self.parts, self.layout))
        if self.layout.swarm:
            lanes = np.zeros(blocks * LANES, dtype=ROBOT)
            lanes["cos"] = 1.0
            lanes[: self.robots] = self.began[0]
            fill_robots(self.blocks, lanes.reshape(-1, LANES))
            self.blocks["exists"] = (np.arange(len(lanes)) < self.robots).reshape(-1, LANES)
            self.objects = self.items[0].astype(np.float32)
            pairs = np.zeros((self.robots**2, 2), dtype=np.int32)
            grid = grid_for(self.scenario)
            self.last = grid._replace(pairs=pairs) if grid.listed[0] < 0 else grid
        else:
            fill_robots(self.blocks, self.began.T)
            self.objects = np.zeros(self.number_of_objects, dtype=OBJECT)
            for at, name in enumerate("xy"):
                self.objects[name] = self.items[:, :, at].T
            self.last = LANES

    def go(self, steps, first=0):
        table = np.zeros(1, dtype=GROUP)[0]
        # Stay in random walk, drop what is carried.
        outcomes = np.full(2, 2 << 1 | 2 << 14, dtype=np.uint32)
        rows = np.zeros(16, dtype=np.uint32)
        done = self.kernel.run(
            self.numbers, self.blocks, self.objects, table,
            np.zeros(16, dtype=np.uint16), rows, np.zeros(1, dtype=np.uint32), outcomes,
            self.last, first, steps,
        )  # fmt: skip
        assert done == steps

    def of(self, name):
        """A field of all robots, flat; those of 64 simulations together."""
        flat = self.blocks[name].reshape(-1)
        return flat[: self.robots].copy() if self.layout.swarm else flat.copy()

    def object_places(self):
        if self.layout.swarm:
            return self.objects.astype(float)
        return np.column_stack([self.objects[name].ravel() for name in "xy"]).astype(float)


def started(arena, robots, number_of_objects, seed, simulations):
    """Robots and objects at the start of some simulations."""
    places = places_of(arena, RADIUS, MARGIN)
    keys = np.array([(0, seed, 0, number) for number in range(simulations)])
    beginning, numbers = Beginning(2, 1, 5.0, 15.0, 0.1), (robots, number_of_objects)
    return begun(places, beginning, keys, numbers, lambda: spots_of(arena, RADIUS))


sizes = st.floats(0.8, 3.0)
few = st.floats(-0.5, 0.5)


@st.composite
def lamps(draw, number):
    return tuple(
        Light(
            draw(st.floats(-3, 3)), draw(st.floats(-3, 3)), draw(st.floats(0, 2)),
            draw(st.floats(0.5, 3)),
        )
        for _ in range(number)
    )  # fmt: skip


@st.composite
def boxes(draw):
    """A box with obstacles of all kinds, painted all over, two lamps."""
    width, length = draw(st.floats(2.6, 6.0)), draw(st.floats(2.6, 6.0))
    turn = st.floats(1.0, 89.0)
    return Arena(
        Box(0, 0, width, length),
        obstacles=(
            Disc(draw(few), draw(few), draw(st.floats(0.01, 0.3))),
            Box(draw(few), draw(few), draw(st.floats(0.01, 0.6)), draw(st.floats(0.01, 0.6))),
            Box(draw(few), draw(few), draw(st.floats(0.01, 0.6)), 0.4, draw(turn)),
        ),
        patches=(
            Patch(Band("north", draw(st.floats(0.2, 0.3))), "white", "source"),
            Patch(Band("west", draw(st.floats(0.2, 2.0))), "black"),
            Patch(Disc(draw(few), draw(few), draw(sizes)), "black", "nest"),
            Patch(Box(draw(few), draw(few), draw(sizes), draw(sizes)), "white", "nest"),
            Patch(Box(draw(few), draw(few), draw(sizes), 1.0, draw(turn)), "red", "nest"),
            Patch(regular(5, draw(sizes), draw(turn)), "blue", ""),
        ),
        lights=draw(lamps(2)),
    )


@st.composite
def rounds(draw):
    """A disc, its middle the source, robots start beside it."""
    radius = draw(st.floats(1.0, 4.0))
    return Arena(
        Disc(0, 0, radius),
        patches=(
            Patch(Disc(0, 0, draw(st.floats(0.2, 4.0))), "black", "source"),
            Patch(regular(3, draw(sizes)), "white", "nest"),
        ),
        lights=draw(lamps(1)),
        start=Disc(0.4, 0, draw(st.floats(0.6, 3.0))),
    )


@st.composite
def convex(draw):
    """A dodecagon, pressed; the source is a turned box."""
    points = regular(12, 1.0, draw(st.floats(0, 30))).points
    width, length = draw(sizes), draw(sizes)
    return Arena(
        Polygon(tuple((width * x, length * y) for x, y in points)),
        patches=(
            Patch(Box(0, 0, 0.5, draw(st.floats(0.1, 0.8)), draw(st.floats(1, 89))), "", "source"),
            Patch(Disc(draw(few), draw(few), 1.0), "black", "nest"),
        ),
        lights=draw(lamps(1)),
        start=Polygon(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (0.0, 0.2), (-0.5, 0.5))),
    )


@st.composite
def angles(draw):
    """An L with a disc in its corner and a thin wall in an arm; the source is in the other arm."""
    width, length = draw(st.floats(2.6, 4.0)), draw(st.floats(2.6, 4.0))
    west, south, arm = -width / 2, -length / 2, 1.2
    return Arena(
        Polygon(
            (
                (west, south), (-west, south), (-west, south + arm), (west + arm, south + arm),
                (west + arm, -south), (west, -south),
            )
        ),
        obstacles=(
            Disc(west + 0.5, south + 0.5, draw(st.floats(0.01, 0.3))),
            Box(-west - 0.7, south + 0.6, 0.004, draw(st.floats(0.1, 0.8))),
        ),
        patches=(
            Patch(Box(west + arm / 2, -south - 0.4, 0.5, 0.4), "", "source"),
            Patch(Band("south", draw(st.floats(0.2, 1.0))), "white", "nest"),
        ),
        lights=draw(lamps(1)),
    )  # fmt: skip


@st.composite
def stars(draw):
    """A star: every other corner stands out into the arena; no light.

    The source is an arrowhead and a box beside it.
    """
    outer, inner = draw(st.floats(1.6, 3.0)), draw(st.floats(0.7, 1.2))
    turn, notch = draw(st.floats(0, 72)), draw(st.floats(-0.25, 0.25))
    points = []
    for k in range(10):
        radius, angle = (inner if k % 2 else outer), math.radians(turn + 36 * k)
        points.append((radius * math.cos(angle), radius * math.sin(angle)))
    return Arena(
        Polygon(tuple(points)),
        patches=(
            Patch(Polygon(((0, 0.3), (-0.3, -0.3), (0, notch), (0.3, -0.3))), "black", "source"),
            Patch(Box(0, -0.35, 0.2, 0.1, draw(few)), "black", "source"),
            Patch(Disc(draw(few), draw(few), 1.0), "black", "nest"),
        ),
    )


KINDS = {"box": boxes(), "disc": rounds(), "convex": convex(), "angle": angles(), "star": stars()}
