"""Scenarios that anybody could write down, with arenas of every form."""

import keyword
import math

from hypothesis import assume
from hypothesis import strategies as st

from geswarm.sim.arena.model import (
    COLOURS,
    SIDES,
    Arena,
    Band,
    Box,
    Disc,
    HalfPlane,
    Light,
    Patch,
    Polygon,
    regular,
)
from geswarm.sim.scenario.model import Scenario, ScenarioError
from geswarm.sim.scenario.objective import Objective

coordinates = st.floats(-2.0, 2.0)
sizes = st.floats(0.05, 3.0)
discs = st.builds(Disc, coordinates, coordinates, sizes)
boxes = st.builds(Box, coordinates, coordinates, sizes, sizes, st.floats(-180.0, 180.0))
names = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True).filter(
    lambda name: not keyword.iskeyword(name)
)
areas = st.sampled_from(["nest", "source", "no", "black", "east"])


@st.composite
def polygons(draw, least=0.5):
    """Corners around the origin in the order of their angles, so that sides do not cross."""
    corners = draw(st.integers(3, 8))
    radii = draw(st.lists(st.floats(least, 3.0), min_size=corners, max_size=corners))
    turns = draw(st.lists(st.floats(-0.2, 0.2), min_size=corners, max_size=corners))
    angles = [2.0 * math.pi * (at + turn) / corners for at, turn in enumerate(turns)]
    pairs = zip(radii, angles, strict=True)
    return Polygon(tuple((r * math.cos(a), r * math.sin(a)) for r, a in pairs))


outlines = st.one_of(
    st.builds(lambda width, length: Box(0.0, 0.0, width, length), *[st.floats(0.5, 6.0)] * 2),
    st.builds(lambda radius: Disc(0.0, 0.0, radius), st.floats(0.5, 4.0)),
    st.builds(regular, st.integers(3, 64), st.floats(0.5, 4.0), st.none() | st.floats(0, 90)),
    polygons(),
)
sides = st.sampled_from(SIDES)
shapes = st.one_of(
    discs,
    boxes,
    polygons(),
    st.builds(HalfPlane, sides, st.floats(-0.2, 0.2)),
    st.builds(Band, sides, st.floats(0.1, 1.0)),
)
patches = st.builds(Patch, shapes, st.sampled_from(COLOURS), st.just("") | areas) | st.builds(
    Patch, shapes, st.just(""), areas
)
lights = st.builds(
    Light, coordinates, st.floats(-5, 100), st.floats(0, 3), st.floats(0.1, 9), st.booleans()
)
arenas = st.builds(
    Arena,
    outline=outlines,
    obstacles=st.lists(discs | boxes, max_size=3).map(tuple),
    patches=st.lists(patches, max_size=4).map(tuple),
    lights=st.lists(lights, max_size=2).map(tuple),
    start=st.none() | shapes,
    floor=st.sampled_from(COLOURS),
)
terms = st.sampled_from(["ON_NEST", "STOP", "ANTI-PHOTOTAXIS", "NO", "Y", "ON", "A1", "_B"])


@st.composite
def scenarios(draw):
    """Any scenario, with numbers far from those of the scenarios that come along."""
    measures = draw(st.lists(names, min_size=1, max_size=3, unique=True))
    arena = draw(arenas)
    walk = sorted(draw(st.tuples(st.floats(0.1, 20), st.floats(0.1, 20))))
    numbers = st.floats(-1e9, 1e9)
    try:
        return Scenario(
            name="any",
            robots=draw(st.integers(1, 3)),
            objects=draw(st.integers(1, 9)) if "source" in arena.areas else 0,
            duration=draw(st.floats(0.1, 1e4)),
            arena=arena,
            zone_miss=draw(st.floats(0, 1)),
            object_margin=draw(st.just(0.0) | st.floats(0, 0.2)),
            random_walk=tuple(walk),
            max_speed=draw(st.floats(0.01, 0.5)),
            avoidance_range=draw(st.none() | st.floats(0.1, 1)),
            evaluations=draw(st.integers(1, 20)),
            preconditions=draw(st.lists(terms, max_size=4, unique=True)),
            behaviours=draw(st.lists(terms, min_size=1, max_size=4, unique=True)),
            registers=draw(st.lists(terms, max_size=3, unique=True)),
            measures=measures,
            objective=Objective(
                draw(st.sampled_from([measures[0], f"-{measures[-1]} / robots + 1.5"])),
                draw(st.booleans()),
                draw(st.sampled_from(["", "objects", "m²", "no", "1"])),
            ),
            probabilities=sorted(draw(st.sets(st.floats(1e-9, 1), min_size=1, max_size=4))),
            reference=draw(st.sampled_from(["", "aac", "hand-coded"])),
            numbers=tuple(draw(st.dictionaries(names, numbers, max_size=2)).items()),
        )
    except ScenarioError:
        assume(False)
