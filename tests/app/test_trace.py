import numpy as np
import pytest

from geswarm.app import palette
from geswarm.app.scene.overlays import heat_map, trail_segments
from geswarm.app.state.trace import SAMPLE_STEPS, TRAIL_SECONDS, PathTrace
from geswarm.rules import load_preset
from geswarm.sim import World, load_scenario

PAPER = load_scenario("paper")


@pytest.fixture
def world():
    return World(PAPER, load_preset("evo8"), 1)


def run(world, trace, samples):
    for _ in range(samples):
        world.step(SAMPLE_STEPS)
        trace.record(world.state)


def test_trails_end_at_the_robots_and_go_back_in_time(world):
    trace = PathTrace(PAPER, world.state)
    start = world.state
    run(world, trace, 3)
    trails = trace.trails()
    ends = trails.ends.reshape(-1, PAPER.robots, 2, 2)
    np.testing.assert_allclose(ends[-1, :, 1], np.column_stack((world.state.x, world.state.y)))
    np.testing.assert_allclose(ends[-3, :, 0], np.column_stack((start.x, start.y)))
    np.testing.assert_allclose(
        ends[:-3], ends[-3, None, :, :1].repeat(2, axis=2) * np.ones_like(ends[:-3])
    )
    assert (trails.age[-1], trails.age[0]) == (0.0, 1.0)
    length = len(ends) * SAMPLE_STEPS * 0.1
    assert length == pytest.approx(TRAIL_SECONDS)


def test_a_robot_that_is_carried_leaves_no_line(world):
    trace = PathTrace(PAPER, world.state)
    run(world, trace, 2)
    world.move_robot(0, 2.0, 2.0)
    trace.record(world.state)
    ends = trace.trails().ends
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max() < 0.1


def test_visits_are_counted_where_they_were(world):
    trace = PathTrace(PAPER, world.state)
    for x, y, row, column in ((-2.0, 2.0, 0, 0), (2.0, -2.0, -1, -1), (2.0, 2.0, 0, -1)):
        trace.restart(PAPER, world.state)
        for robot in range(4):
            world.move_robot(robot, 3 * x, 3 * y)
        trace.record(world.state)
        rows, columns = np.nonzero(trace.visits)
        north, west = abs(rows[0] - row % trace.visits.shape[0]), abs(columns[0] - column % 84)
        assert max(north, west) <= 2  # a robot's centre keeps off the walls
    run(world, trace, 5)
    assert trace.visits.sum() == 4 * 6
    assert trace.samples == 6


def test_the_raster_of_a_large_arena_stays_small(world):
    wide = PAPER.with_changes(width=100.0, length=50.0)
    assert PathTrace(wide, World(wide, load_preset("evo8")).state).visits.size < 45_000


def test_heat_is_transparent_where_nobody_was():
    visits = np.zeros((10, 20), dtype=np.int64)
    assert not heat_map(visits)[..., 3].any()
    visits[2, 3] = 7
    picture = heat_map(visits)
    assert picture.shape == (10, 20, 4)
    assert picture[2, 3, 3] == picture[..., 3].max() > 150
    assert picture[8, 15, 3] == 0


def test_trails_fade(world):
    trace = PathTrace(PAPER, world.state)
    run(world, trace, 50)
    points, colours = trail_segments(trace.trails(), palette.BEHAVIOURS)
    assert points.shape == colours.shape
    spread = np.ptp(colours.astype(int)[:, 0], axis=1)  # grey has none
    assert spread[-4:].min() > 2 * spread[:4].max()
