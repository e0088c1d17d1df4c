"""What the checks of arenas know of shapes, against points all over them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.sim.arena.checks import has_room_for_objects, room_at_start
from geswarm.sim.arena.geometry import (
    corners,
    crosses_itself,
    distances,
    grid,
    overlap,
    signed_area,
)
from geswarm.sim.arena.model import Arena, Band, Box, Disc, HalfPlane, Polygon, normalised
from tests.sim.any_scenario import arenas, boxes, discs, polygons, shapes

plain = shapes.filter(lambda shape: not isinstance(shape, Band))


@given(plain, plain)
def test_shapes_that_share_points_overlap(one, other):
    assert overlap(one, other) == overlap(other, one)
    points, _ = grid(one, Disc(0, 0, 6), 0.0)
    both = (distances(one, points) <= 0) & (distances(other, points) <= 0)
    if both.any():
        assert overlap(one, other)


@given(discs | boxes | polygons())
def test_the_area_is_that_of_the_points_inside(shape):
    around = corners(shape)
    points, each = grid(shape, Box(0, 0, 30, 30), 0.0)
    inside = (distances(shape, points) <= 0).sum() * each
    width, length = np.ptp(around, axis=0)
    assert abs(signed_area(around)) == pytest.approx(inside, abs=0.15 * width * length)
    assert signed_area(corners(normalised(shape))) > 0


@given(boxes, st.floats(-4, 4), st.floats(-4, 4))
def test_distance_from_a_turned_box(box, x, y):
    turn = math.radians(box.angle)
    dx, dy = x - box.x, y - box.y
    along = abs(dx * math.cos(turn) + dy * math.sin(turn)) - box.width / 2
    across = abs(dy * math.cos(turn) - dx * math.sin(turn)) - box.length / 2
    expected = math.hypot(max(along, 0), max(across, 0))
    assert distances(box, np.array([(x, y)]))[0] == pytest.approx(expected, abs=1e-9)


@given(polygons(), st.integers(0, 7), st.integers(0, 7))
def test_polygons_that_touch_themselves(polygon, place, other):
    points = corners(polygon)
    assert not crosses_itself(points)
    count = len(points)
    assert crosses_itself(np.insert(points, place % count, points[other % count], axis=0))
    assert crosses_itself(np.array([(0, 0), (2, 2), (2, 0), (0, 2)], dtype=float))


def test_a_shape_outside_only_touches():
    square = Polygon(((-1, -1), (1, -1), (1, 1), (-1, 1)))
    assert overlap(square, square)
    assert not overlap(square, Box(5, 0, 2, 2))
    assert not overlap(square, HalfPlane("north", 1.5))
    assert overlap(square, HalfPlane("north", 0.5))
    assert overlap(square, Disc(0, 0, 9))


@given(arenas)
def test_more_obstacles_leave_no_more_room(arena):
    free = Arena(arena.outline, (), arena.patches, arena.lights, arena.start, arena.floor)
    assert 0 <= room_at_start(arena) <= room_at_start(free)
    if has_room_for_objects(arena, 0.1):
        assert has_room_for_objects(free, 0.1)
        assert has_room_for_objects(arena, 0.05)
