"""Objects in polygons and in several patches: all over them, where robots reach, and only there."""

import math

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.stats import chisquare

from geswarm.rules import load_preset
from geswarm.sim import World, parse_scenario
from geswarm.sim.arena.geometry import corners, distances, signed_area
from geswarm.sim.arena.model import (
    Arena,
    Band,
    Box,
    Disc,
    HalfPlane,
    Patch,
    Polygon,
    normalised,
    regular,
)
from geswarm.sim.arena.numbers import triangle_numbers
from geswarm.sim.arena.source_place import where_objects_lie
from geswarm.sim.arena.start_places import places_of
from geswarm.sim.arena.triangles import Triangles, pieces, turn
from geswarm.sim.controllers.starting import _of_objects
from geswarm.sim.kernels import geometry
from geswarm.sim.kernels.jit import kernel_in_memory
from geswarm.sim.terms.ground import GroundError
from tests.sim.any_scenario import polygons
from tests.sim.assembly import ground_twin as twin
from tests.sim.assembly.arenas import MARGIN, RADIUS, started

EVO8 = load_preset("evo8")
ROUNDING = 1e-5  # m
ARROW = ((-0.8, -0.6), (0.0, -0.2), (0.8, -0.6), (0.0, 0.9))
TEXT = """
extends: paper
arena:
  rectangle: [4.2, 4.2]
  patches:
    - {{band: {{side: south, depth: 1.5}}, floor: white, area: nest}}
    - {{polygon: [[-2, 0.5], [0, 1], [2, 0.5], [2.1, 2.1], [0, 1.6], [-2.1, 2.1]], area: source}}
{more}
"""
MORE = "    - {box: {at: [0, 0], size: [1, 0.4]}, floor: black, area: source}"


def patched(outline, *shapes, obstacles=()):
    return normalised(
        Arena(outline, obstacles, tuple(Patch(each, "", "source") for each in shapes))
    )


@st.composite
def comb(draw):
    """A polygon with many inner corners: far from a star around a place in its middle."""
    teeth = draw(st.integers(1, 15))
    depths = draw(st.lists(st.floats(0.05, 1.0), min_size=teeth, max_size=teeth))
    tips = [[(k, -1.0), (k + 0.4, depth - 1.0)] for k, depth in enumerate(depths)]
    return Polygon((*(at for pair in tips for at in pair), (teeth, -1.0), (teeth, 1.0), (0.0, 1.0)))


@given(polygons() | comb())
def test_triangles_are_all_of_a_polygon_and_nothing_else(polygon):
    cut = Triangles.of(pieces(normalised(polygon)))
    areas = [signed_area(each) for each in cut.corners]
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(abs(signed_area(corners(polygon))), rel=1e-6)
    for each in cut.corners:
        assert distances(polygon, each.mean(axis=0, keepdims=True)) == 0
    assert cut.extent == pytest.approx((*corners(polygon).min(0), *corners(polygon).max(0)))


@st.composite
def reached(draw):
    """Arenas with a polygon, and perhaps a band that does not overlap it, as their source."""
    polygon = draw(polygons(least=0.2))
    if draw(st.booleans()):
        size = np.ptp(corners(polygon), axis=0).max() + 1.0
        return patched(Disc(0, 0, 2 * size), polygon, obstacles=(Disc(0, 1.5 * size, 0.2),))
    outline = Box(0, 0, draw(st.floats(0.5, 7.0)), draw(st.floats(0.5, 7.0)))
    beside = corners(polygon)[:, 0].max()
    bands = [HalfPlane("east", beside)] if beside < outline.width / 2 else []
    return patched(outline, *draw(st.permutations([polygon, *bands])))


def objects_in(arena, seed, objects=2000):
    _, items = started(arena, 1, objects, seed, 1)
    return items[0]


@given(reached(), st.integers(0, 2**32))
@settings(max_examples=40)
def test_objects_lie_all_over_a_source_and_nowhere_else(arena, seed):
    places, shape = objects_in(arena, seed), where_objects_lie(arena, MARGIN).shape
    np.testing.assert_array_equal(places, objects_in(arena, seed))
    for at in places[:300].tolist():
        inside, doubt = twin.in_area(arena, "source", *at)
        assert inside or doubt < 1e-9
        assert twin.clearance(arena, *at) >= MARGIN - 1e-9
    assert_even(places, shape)


def assert_even(places, triangles):
    """In each third of a triangle, around its middle, as many as its area is."""
    middle, first = triangles.corners.mean(axis=1), triangles.corners
    second = np.roll(first, -1, axis=1)
    cells = np.concatenate([np.stack((first[:, k], second[:, k], middle), 1) for k in range(3)])
    areas = turn(*cells.swapaxes(0, 1))
    sides = [turn(cells[:, None, k - 1], cells[:, None, k], places[None]) for k in range(3)]
    found = (np.min(sides, axis=0) >= 0).sum(axis=1)
    expected = len(places) * areas / areas.sum()
    assert abs(found.sum() - len(places)) <= 2  # but for edges
    large = expected >= 8
    counts = np.array([*found[large], found[~large].sum()])
    shares = np.array([*expected[large], expected[~large].sum()])
    told = shares > 0
    assert counts[~told].sum() == 0
    assert chisquare(counts[told], shares[told] * (counts.sum() / shares.sum()))[1] > 1e-6


def _polygon(points):
    return Polygon(tuple(map(tuple, points.tolist())))


@kernel_in_memory
def _draw(u, v, numbers, found):
    for k in range(len(u)):
        found[k, 0], found[k, 1] = geometry.place_in_triangles(u[k], v[k], numbers)


@given(reached(), st.integers(0, 2**32))
@settings(max_examples=20, phases=[Phase.generate])
def test_a_picked_object_appears_where_the_start_would_put_it(arena, seed):
    bits = np.random.default_rng(seed).integers(0, 2**32, (2, 500), dtype=np.uint32)
    bits[:, :4] = [[0, 2**32 - 1, 0, 2**32 - 1], [0, 0, 2**32 - 1, 2**32 - 1]]
    bits &= np.uint32(0xFFFFFF00)  # what single precision makes of them
    numbers = np.array([7.0, *triangle_numbers(arena, MARGIN)], dtype=np.float32)
    found = np.empty((500, 2), dtype=np.float32)
    _draw(*bits, numbers, found)
    u, v = bits / 2.0**32
    expected = _of_objects(places_of(arena, RADIUS, MARGIN), u, v, u, v)
    same = np.hypot(*(found - expected).T) < 1e-3
    assert same.mean() > 0.98  # but for the edges of triangles and for slivers
    for x, y in found.tolist():
        inside, doubt = twin.in_area(arena, "source", x, y)
        assert inside or doubt < ROUNDING
        assert twin.clearance(arena, x, y) >= MARGIN - ROUNDING


@pytest.mark.parametrize("more", ["", MORE], ids=["one", "several"])
def test_worlds_keep_their_objects_in_a_source_that_robots_reach(more):
    scenario = parse_scenario(TEXT.format(more=more), "patched").with_changes(
        object_margin=0.2, grip_reach=0.4, max_speed=0.3
    )
    world, again = (World(scenario, EVO8, 3) for _ in range(2))
    for _ in range(3):
        world.step(300)
        for at in world.state.objects.tolist():
            assert twin.edge_of(scenario.arena.outline, *at) <= -0.2 + ROUNDING
            inside, doubt = twin.in_area(scenario.arena, "source", *at)
            assert inside or doubt < ROUNDING
    assert world.measures["picked"] > scenario.objects
    again.step(900)
    np.testing.assert_array_equal(world.state.objects, again.state.objects)
    world.move_object(0, 0.5, 3.0)
    assert world.state.objects[0] == pytest.approx((0.788627, 1.787768), abs=ROUNDING)


@given(reached(), st.floats(-4, 4), st.floats(-4, 4))
def test_what_is_put_by_hand_lies_nearest_in_the_source(arena, x, y):
    triangles = where_objects_lie(arena, MARGIN).shape
    found = triangles.nearest((x, y))
    shapes = [_polygon(each) for each in triangles.corners]
    gaps = [distances(each, np.array([found])).item() for each in shapes]
    assert min(gaps) < 1e-9
    away = min(distances(each, np.array([(x, y)])).item() for each in shapes)
    assert math.dist(found, (x, y)) == pytest.approx(away, abs=1e-9)


@pytest.mark.parametrize(
    ("arena", "message"),
    [
        (
            patched(Box(0, 0, 4, 4), Polygon(ARROW), Disc(1.5, 0, 0.2)),
            "boxes, bands or polygons where it has several patches, got a disc as number 2",
        ),
        (
            patched(Box(0, 0, 4, 4), Box(1.5, 1.5, 0.2, 0.2), Polygon(ARROW), Box(0, 0, 1, 1, 45)),
            "patches that do not overlap for objects to lie in, got numbers 2 and 3",
        ),
        (patched(Disc(0, 0, 1), Polygon(ARROW)), "all of it at least 0.1 m from the walls"),
        (
            patched(regular(4, 1.3, 0), Polygon(ARROW)),
            "all of it at least 0.1 m from the walls",
        ),
        (
            patched(Box(0, 0, 4, 4), Polygon(ARROW), obstacles=(Disc(0, -0.35, 0.1),)),
            r"expected it at least 0.1 m from obstacles, .* got 0.03\d+ m from obstacle 1",
        ),
        (
            patched(Box(0, 0, 4, 4), Polygon(ARROW), obstacles=(Disc(0, 0, 0.01),)),
            "got 0 m from obstacle 1",
        ),
        (
            patched(Box(0, 0, 4, 4), Polygon(((1.91, 0), (2, 0), (2, 1)))),
            "a margin of 0.1 m from the walls leaves no room for objects",
        ),
        (
            patched(Disc(0, 0, 4), Box(0, 0, 1, 1), Band("north", 1)),
            "a band is only for a rectangular arena",
        ),
    ],
)
def test_what_cannot_be_a_source_is_told(arena, message):
    with pytest.raises(GroundError, match=message):
        where_objects_lie(arena, MARGIN)


def test_patches_that_touch_are_one_source():
    arena = patched(Box(0, 0, 4, 4), Box(-0.5, 0, 1, 1), Box(0.5, 0, 1, 1), Box(0, 1, 2, 1))
    places = objects_in(arena, 5, 9000)
    counts = np.histogram2d(*places.T, bins=(4, 4), range=((-1, 1), (-0.5, 1.5)))[0].ravel()
    assert counts.sum() == 9000
    assert chisquare(counts)[1] > 1e-6
