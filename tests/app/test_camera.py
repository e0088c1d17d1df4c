import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.app.scene.camera import FIELD_OF_VIEW, framing
from geswarm.app.scene.scenery import outer_points
from geswarm.sim import load_scenario

PAPER = load_scenario("paper")


def picture(points, pose, aspect):
    """Places in the picture, shape (n, 2), -1 to 1 to the right and upwards."""
    forward = pose.look_at - pose.position
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    seen = points - pose.position
    depth = seen @ forward
    assert (depth > 0).all()
    half = math.tan(FIELD_OF_VIEW / 2)
    return np.column_stack((seen @ right / depth / half / aspect, seen @ up / depth / half))


@given(st.floats(1, 25), st.floats(1, 25), st.floats(0.4, 3))
def test_every_arena_fills_the_picture(width, length, aspect):
    points = outer_points(PAPER.with_changes(width=width, length=length, nest=0.2, source=0.6))
    places = picture(points, framing(points, aspect), aspect)
    assert np.abs(places).max() <= 1
    assert np.abs(places).max() > 0.9


def test_what_is_beside_the_origin_is_in_the_middle():
    points = outer_points(PAPER) + np.array((50.0, -7.0, 0.0))
    pose = framing(points, 1.35)
    places = picture(points, pose, 1.35)
    assert np.abs(places).max() <= 1
    assert places[:, 0].max() == pytest.approx(-places[:, 0].min())
    assert pose.position[0] == pytest.approx(50.0)


def test_north_is_up():
    points = outer_points(PAPER)
    south, north, east = np.array([(0, -1, 0), (0, 1, 0), (1, 0, 0)], dtype=float)
    places = picture(np.stack((south, north, east)), framing(points), 1.35)
    assert places[1, 1] > places[0, 1]
    assert places[2, 0] > 0
    assert places[:2, 0] == pytest.approx(0)
