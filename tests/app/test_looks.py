import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.app.scene.epuck import HEIGHT as EPUCK_HEIGHT
from geswarm.app.scene.epuck import distant_epuck, epuck
from geswarm.app.scene.footbot import (
    HEIGHT,
    OBJECT_HEIGHT,
    OBJECT_RADIUS,
    RADIUS,
    distant_footbot,
    footbot,
    puck,
    yaw_quaternions,
)
from geswarm.app.scene.lettering import painted, text_width
from geswarm.app.scene.shapes import box, lathe, line, prism, rectangle
from geswarm.sim.bodies import E_PUCK

PARTS = vars(footbot())
EPUCK = vars(epuck())
WORDS = ["NEST", "SOURCE", "1 m"]
MESHES = {
    **PARTS,
    **{f"distant {name}": mesh for name, mesh in vars(distant_footbot()).items()},
    **{f"e-puck's {name}": mesh for name, mesh in EPUCK.items()},
    **{f"distant e-puck's {name}": mesh for name, mesh in vars(distant_epuck()).items()},
    "puck": puck(),
    **{word: painted(word, 0.3) for word in WORDS},
    "line": line(((0, 0), (1, 0), (1, 0), (1, 1)), 0.1),
}


def corners(mesh):
    return mesh.vertices.astype(float)[mesh.faces]


def volume(mesh):
    a, b, c = corners(mesh).transpose(1, 0, 2)
    return np.sum(a * np.cross(b, c)) / 6


@pytest.mark.parametrize("name", MESHES)
def test_mesh_is_sound(name):
    mesh = MESHES[name]
    assert (mesh.vertices.dtype, mesh.faces.dtype) == (np.float32, np.uint32)
    assert np.isfinite(mesh.vertices).all()
    assert mesh.faces.max() < len(mesh.vertices)
    a, b, c = corners(mesh).transpose(1, 0, 2)
    assert (np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-9).all(), "a face without area"


@pytest.mark.parametrize("word", WORDS)
def test_flat_meshes_are_seen_from_above(word):
    a, b, c = corners(MESHES[word]).transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


@pytest.mark.parametrize("word", WORDS)
def test_letters_fit_their_box(word):
    vertices = MESHES[word].vertices
    stroke = 0.13 * 0.3
    assert np.abs(vertices[:, 0]).max() <= text_width(word, 0.3) / 2 + stroke
    assert np.abs(vertices[:, 1]).max() <= 0.15 + stroke


def test_solids_have_outward_faces():
    assert volume(box((0, 1), (0, 2), (0, 3))) == pytest.approx(6)
    assert volume(lathe(((0, 0), (1, 0), (1, 1), (0, 1)), 200)) == pytest.approx(math.pi, rel=1e-3)
    assert volume(prism(((0, 0), (1, 0), (0, 1)), -1, 1)) == pytest.approx(1)
    exact = math.pi * OBJECT_RADIUS**2 * OBJECT_HEIGHT
    assert 0.85 * exact < volume(puck()) < exact
    assert (rectangle((0, 1), (0, 1)).vertices[:, 2] == 0).all()


@pytest.mark.parametrize(
    ("parts", "height", "radius"), [(PARTS, HEIGHT, RADIUS), (EPUCK, EPUCK_HEIGHT, E_PUCK.radius)]
)
def test_robots_have_their_size(parts, height, radius):
    body, leds, trim = (parts[name].vertices for name in ("body", "leds", "trim"))
    assert max(body[:, 2].max(), leds[:, 2].max(), trim[:, 2].max()) == pytest.approx(height)
    assert body[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert np.hypot(*leds[:, :2].T).max() == pytest.approx(radius)
    assert np.hypot(*body[:, :2].T).max() <= radius + 0.003
    assert parts["carried"].vertices[:, 2].min() == pytest.approx(height)


def test_front_is_east():
    trim = PARTS["trim"].vertices
    assert trim[:, 0].max() > RADIUS + 0.01
    assert trim[:, 0].min() >= -RADIUS - 1e-6


@pytest.mark.parametrize(("near", "far"), [(footbot, distant_footbot), (epuck, distant_epuck)])
def test_large_swarms_are_cheap_and_look_alike_from_afar(near, far):
    near, far = vars(near()), vars(far())
    assert sum(len(mesh.faces) for mesh in near.values()) < 1000
    assert sum(len(mesh.faces) for mesh in far.values()) < 100
    for name in ("leds", "carried"):
        assert far[name].vertices[:, 2].max() == pytest.approx(near[name].vertices[:, 2].max())


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=5))
def test_quaternions_turn_east_to_the_heading(headings):
    w, x, y, z = yaw_quaternions(np.array(headings)).T.astype(float)
    assert not x.any()
    assert not y.any()
    np.testing.assert_allclose(1 - 2 * z * z, np.cos(headings), atol=1e-6)
    np.testing.assert_allclose(2 * w * z, np.sin(headings), atol=1e-6)
