"""Arenas of every form: what robots perceive of them, where they start, where they may be."""

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from geswarm.sim.arena.start_places import room_for
from geswarm.sim.assembly.source import Layout
from tests.sim.assembly import ground_twin as twin
from tests.sim.assembly.arenas import KINDS, MARGIN, PAPER, RADIUS, Run

LANES, SWARM = Layout(), Layout(swarm=True)
USUAL = ("star",)
kinds = pytest.mark.parametrize(
    "kind",
    [kind if kind in USUAL else pytest.param(kind, marks=pytest.mark.long) for kind in KINDS],
)
layouts = pytest.mark.parametrize(
    "layout",
    [LANES, pytest.param(SWARM, marks=pytest.mark.long)],
    ids=lambda layout: layout.name,
)
SENSED = RADIUS + PAPER.proximity_range
DOUBT = 1e-5  # m: positions and shapes are rounded to single precision


def robots_for(arena, most):
    return max(1, min(most, room_for(arena, RADIUS)))


@kinds
@given(data=st.data(), seed=st.integers(0, 2**32))
@settings(max_examples=6, phases=[Phase.generate])
def test_what_robots_perceive_is_what_the_twin_says(kind, data, seed):
    arena = data.draw(KINDS[kind])
    run = Run(arena, LANES, robots=1, seed=seed)
    spread = np.random.default_rng(seed).uniform(-1.1, 1.1, (2, 64))
    free = np.array(
        [
            twin.clearance(arena, x, y) > DOUBT
            for x, y in (spread.T * (arena.half_width, arena.half_length)).tolist()
        ]
    )
    run.blocks["x"][0, free] = (spread[0] * arena.half_width)[free]
    run.blocks["y"][0, free] = (spread[1] * arena.half_length)[free]
    run.go(0)
    for lane, (x, y) in enumerate(zip(run.of("x").tolist(), run.of("y").tolist(), strict=True)):
        seen = {name: run.of(name)[lane] for name in run.blocks.dtype.names}
        expected = twin.push(arena, x, y, SENSED)
        assert (seen["pushed_x"], seen["pushed_y"]) == pytest.approx(expected, abs=2e-5)
        expected = twin.to_light(arena, x, y)
        assert (seen["lit_x"], seen["lit_y"]) == pytest.approx(expected, abs=1e-3)
        assert seen["bright"] == pytest.approx(twin.brightness(arena, x, y), rel=1e-5)
        for found, (value, doubt) in (
            (seen["colour"], twin.floor(arena, x, y)),
            (seen["nested"], twin.in_area(arena, "nest", x, y)),
            (seen["sourced"], twin.in_area(arena, "source", x, y)),
        ):
            assert found == value or doubt < DOUBT


@kinds
@layouts
@given(data=st.data(), seed=st.integers(0, 2**32))
@settings(max_examples=4, phases=[Phase.generate])
def test_robots_start_well_and_stay_inside(kind, layout, data, seed):
    arena = data.draw(KINDS[kind])
    robots = robots_for(arena, 150 if layout.swarm else data.draw(st.integers(1, 12)))
    run = Run(arena, layout, robots, seed, max_speed=data.draw(st.sampled_from([0.1, 0.6])))
    for places in run.began:
        assert_apart(arena, places["x"], places["y"])
    for steps in range(0, 200, 50):
        run.go(50, steps)
        x, y = run.of("x"), run.of("y")
        assert np.isfinite(x).all()
        assert np.isfinite(y).all()
        least = min(twin.clearance(arena, *at) for at in zip(x.tolist(), y.tolist(), strict=True))
        assert least >= RADIUS * (1 - 1e-3) - 2e-6
    assert np.ptp(run.of("cos")) > 0
    for x, y in run.object_places():
        inside, doubt = twin.in_area(arena, "source", x, y)
        assert inside or doubt < DOUBT
        assert twin.clearance(arena, x, y) >= MARGIN - DOUBT


def assert_apart(arena, x, y):
    places = np.column_stack((x, y))
    if len(places) > 1:
        assert cKDTree(places).query(places, k=2)[0][:, 1].min() >= 2 * RADIUS - 1e-9
    for at in places.tolist():
        assert twin.clearance(arena, *at) >= RADIUS - 1e-9
        if arena.start is not None:
            assert twin.edge_of(arena.resolved(arena.start), *at) <= 1e-9
