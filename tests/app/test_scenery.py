"""Floors, walls, names and lamps of arenas of any form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.app import palette
from geswarm.app.scene.arena import ShownArena
from geswarm.app.scene.ground import as_shown, floors, signs
from geswarm.app.scene.lamps import lamp_of
from geswarm.app.scene.lettering import painted, text_width
from geswarm.app.scene.overlays import outside
from geswarm.app.scene.plane import flat, rim, wall
from geswarm.app.scene.scenery import outer_points
from geswarm.app.state.trace import PathTrace
from geswarm.rules import RuleSet
from geswarm.sim import World, load_scenario
from geswarm.sim.arena.geometry import corners, distances, signed_area
from geswarm.sim.arena.model import Arena, Box, Disc, HalfPlane, Light, Patch, Polygon, regular
from geswarm.sim.arena.triangles import common, pieces, triangles

CONCAVE = Polygon(
    (
        *((-1.8, -1.4), (0.4, -1.4), (0.4, -0.2), (1.9, -0.2), (1.9, 1.5)),
        *((0.2, 1.5), (-0.2, 0.9), (-0.6, 1.5), (-1.8, 1.5)),
    )
)
OUTLINES = {
    "box": Box(0.0, 0.0, 4.0, 3.0),
    "disc": Disc(0.0, 0.0, 1.5),
    "polygon": regular(12, 1.27),
    "concave polygon": CONCAVE,
}
PATCHES = {
    "disc": Disc(0.3, 0.2, 0.7),
    "turned box": Box(-0.2, 0.4, 1.0, 0.5, 30.0),
    "half-plane": HalfPlane("north", 0.4),
    "concave polygon": Polygon(((-0.5, -0.5), (0.9, -0.9), (0.5, 0.0), (0.9, 0.9), (-0.4, 0.6))),
}


def area(mesh):
    a, b, c = mesh.vertices.astype(float)[mesh.faces].transpose(1, 0, 2)
    return np.cross(b - a, c - a)[:, 2].sum() / 2.0


def is_seen_from_above(mesh):
    a, b, c = mesh.vertices.astype(float)[mesh.faces].transpose(1, 0, 2)
    return (np.cross(b - a, c - a)[:, 2] > 0.0).all()


@pytest.mark.parametrize("outline", OUTLINES)
def test_a_floor_is_as_large_as_its_outline(outline):
    shape = OUTLINES[outline]
    ((mesh, colour),) = floors(Arena(shape))
    assert area(mesh) == pytest.approx(signed_area(corners(shape)), rel=1e-5)
    assert is_seen_from_above(mesh)
    assert colour == palette.FLOOR


@pytest.mark.parametrize("outline", OUTLINES)
@pytest.mark.parametrize("patch", PATCHES)
def test_a_patch_is_painted_as_far_as_the_walls(outline, patch):
    shape, border = PATCHES[patch], OUTLINES[outline]
    mesh = flat(common(shape, pieces(border)))
    assert is_seen_from_above(mesh)
    x, y = np.meshgrid(*(np.linspace(-2.0, 2.0, 401),) * 2)
    points = np.column_stack((x.ravel(), y.ravel()))
    # The simulator's own discs are round; those of the view have corners.
    both = (distances(shape, points) <= 0.0) & (distances(border, points) <= 0.0)
    assert area(mesh) == pytest.approx(both.sum() * 0.01**2, rel=0.02)


@given(st.lists(st.floats(0.2, 2.0), min_size=3, max_size=24))
def test_any_star_is_cut_into_triangles(radii):
    angles = np.arange(len(radii)) * (2.0 * math.pi / len(radii))
    border = np.array(radii)[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    cut = [border[list(each)] for each in triangles(border)]
    assert sum(map(signed_area, cut)) == pytest.approx(signed_area(border))
    assert min(map(signed_area, cut)) > 0.0


def test_straight_corners_are_no_trouble():
    border = Polygon(((0, 0), (1, 0), (2, 0), (2, 2), (1, 2), (1, 1), (0, 1), (0, 0.5)))
    assert area(flat(pieces(border))) == pytest.approx(3.0)


@pytest.mark.parametrize("outline", OUTLINES)
def test_walls_stand_along_the_outside(outline):
    shape = OUTLINES[outline]
    mesh = wall(shape, 0.05, 0.07)
    places = mesh.vertices[:, :2].astype(float)
    inside = distances(shape, places) <= 0.0
    gaps = np.min([np.linalg.norm(places - corner, axis=1) for corner in corners(shape)], axis=0)
    assert (gaps < 0.2).all()
    assert not (inside & (gaps > 1e-6)).any()
    a, b, c = mesh.vertices.astype(float)[mesh.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    top = normals[:, 2] > 0.5
    assert a[top][:, 2] == pytest.approx(0.07)
    before = (a + b + c)[:, :2] / 3.0 + 1e-3 * normals[:, :2]  # just before each face
    inward = distances(shape, before) <= 0.0
    assert top.sum() == inward.sum() == len(mesh.faces) / 3


@pytest.mark.parametrize("outline", OUTLINES)
def test_a_rim_lies_around_its_outline(outline):
    mesh = rim(OUTLINES[outline], 0.1)
    assert is_seen_from_above(mesh)
    border = corners(OUTLINES[outline])
    length = np.linalg.norm(border - np.roll(border, 1, axis=0), axis=1).sum()
    assert area(mesh) == pytest.approx(0.1 * length, rel=0.06)


def test_the_paper_is_shown_in_tints_and_colours_where_robots_see_them():
    paper = load_scenario("paper")
    assert [colour for _, colour in floors(as_shown(paper))] == [
        palette.FLOOR,
        palette.AREAS["nest"],
        palette.AREAS["source"],
    ]
    painted = [colour for _, colour in floors(as_shown(load_scenario("aac")))]
    assert painted == [palette.FLOORS[name] for name in ("grey", "black", "white")]


def test_layers_of_a_large_arena_are_farther_apart_but_none_is_above_robots():
    for stretch in (1.0, 5.0):
        levels = [mesh.vertices[0, 2] for mesh, _ in floors(load_scenario("aac").arena, stretch)]
        assert levels == sorted(levels)
        assert levels[-1] == 0.0
        assert min(np.diff(levels)) >= 0.0007 * stretch
        assert levels[0] > -0.003 * stretch


def test_names_stand_in_the_middle_of_bands():
    nest, source = signs(as_shown(load_scenario("paper")))
    assert (nest.text, nest.at, nest.height) == ("NEST", pytest.approx((0.0, -1.35)), 0.42)
    assert (source.text, source.at, source.height) == ("SOURCE", pytest.approx((0.0, 1.1)), 0.42)


def test_names_stand_where_their_area_is_seen():
    arena = Arena(
        CONCAVE,
        obstacles=(Disc(1.0, 1.0, 0.3),),
        patches=(
            Patch(HalfPlane("north", 0.5), area="north_side"),
            Patch(Disc(-1.2, -1.0, 0.3), area="home"),
            Patch(Disc(-1.2, -0.9, 0.6), "black", "home"),
            Patch(Disc(5.0, 5.0, 0.3), area="nowhere"),
            Patch(Disc(-1.4, 1.2, 0.4), "red"),
        ),
    )
    found = {sign.area: sign for sign in signs(arena)}
    assert set(found) == {"north_side", "home"}
    assert found["home"].at == pytest.approx((-1.2, -0.9), abs=0.1)  # on the larger patch
    for sign in found.values():
        reach = text_width(sign.text, sign.height) / 2.0
        ends = np.array([(sign.at[0] + part * reach, sign.at[1]) for part in (-1.0, 0.0, 1.0)])
        inside = np.min([distances(shape, ends) for shape in arena.area(sign.area)], axis=0)
        assert not inside.any()
        assert not distances(CONCAVE, ends).any()
        assert (distances(arena.obstacles[0], ends) > 0.0).all()
        assert (distances(arena.patches[-1].shape, ends) > 0.0).all()


@pytest.mark.parametrize("text", ["NEST", "1 m", "NORTH_SIDE2", "Q", "gjpqy", "X8%&@"])
def test_words_are_meshes_of_their_size(text):
    mesh = painted(text, 0.3)
    assert is_seen_from_above(mesh)
    east, north, _ = mesh.vertices.max(axis=0)
    west, south, _ = mesh.vertices.min(axis=0)
    assert east - west == pytest.approx(text_width(text, 0.3), rel=1e-5)
    assert east == pytest.approx(-west, abs=1e-5)
    assert max(north, -south) < 0.3
    ink = area(mesh) / (east - west) / 0.3
    assert 0.05 < ink < 0.7
    assert len(mesh.faces) < 500 * len(text)


def test_capitals_are_as_high_as_said():
    _, y, _ = painted("HEI", 0.3).vertices.T
    assert (y.min(), y.max()) == pytest.approx((-0.15, 0.15), abs=0.01)


def test_words_are_told_from_their_ground():
    grounds = [*palette.FLOORS.values(), *palette.AREAS.values(), *palette.OTHER_AREAS]
    for ground in grounds:
        assert max(abs(np.subtract(palette.on_ground(ground), ground))) > 25, ground  # of 255


def test_lamps_are_in_their_places_or_on_their_bearing():
    arena = Arena(Disc(0.0, 0.0, 1.5))
    hanging = lamp_of(arena, Light(0.2, 0.3, 0.6))
    assert (hanging.at, hanging.place, hanging.label) == ((0.2, 0.3, 0.6), "hanging", "")
    assert lamp_of(arena, Light(0.0, -1.7, 0.75)).place == "standing"
    far = lamp_of(arena, Light(0.0, 100.0, beyond=True))
    assert (far.at[:2], far.label) == ((0.0, 2.0), "light, 100 m north")
    aside = lamp_of(arena, Light(30.0, 0.0, 5.0))
    assert (aside.at[:2], aside.label) == ((2.0, 0.0), "light, 30 m away")
    high = lamp_of(arena, Light(0.0, 0.0, 8.0))
    assert high.at[2] < 2.0
    assert high.label == "light, 8 m up"


def test_any_arena_is_drawn(server):
    scenario = load_scenario("aac")
    drawn = ShownArena()
    for outline in OUTLINES.values():
        arena = Arena(
            outline,
            obstacles=(Disc(-0.5, 0.2, 0.1), Box(0.5, 0.3, 0.3, 0.05, 20.0)),
            patches=(
                Patch(Disc(-0.9, 0.0, 0.2), "red", "black"),
                Patch(PATCHES["disc"], "", "white"),
            ),
            lights=(Light(0.0, 0.5, 0.5), Light(0.0, -2.0, 0.5), Light(0.0, 9.0)),
        )
        placed = replace(scenario, arena=arena)
        drawn.build(server.scene, placed)
        assert np.isfinite(outer_points(placed)).all()


def test_visits_are_shown_inside_the_walls_only():
    scenario = load_scenario("aac")
    trace = PathTrace(scenario, World(scenario, RuleSet(())).state)
    hidden = outside(trace)
    assert hidden.shape == trace.visits.shape
    assert hidden[0, 0]
    assert not hidden[hidden.shape[0] // 2].all()
    assert 1.0 - hidden.mean() == pytest.approx(
        signed_area(corners(scenario.arena.outline)) / scenario.width / scenario.length, abs=0.03
    )
    paper = load_scenario("paper")
    assert not outside(PathTrace(paper, World(paper, RuleSet(())).state)).any()
