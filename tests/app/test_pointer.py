import asyncio
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.app.scene.pointer import Pointer, on_level
from geswarm.app.state.swarm import ShownSwarm
from geswarm.rules import RuleSet
from geswarm.sim import World, load_scenario
from geswarm.sim.arena.geometry import distances

coordinate = st.floats(-10, 10)


@given(coordinate, coordinate, st.floats(0.1, 0.9), coordinate, coordinate, st.floats(1, 20))
def test_a_ray_meets_the_plane(x, y, level, eye_x, eye_y, eye_z):
    eye = np.array((eye_x, eye_y, eye_z))
    ground = np.array((x, y, level))
    through = eye + 0.3 * (ground - eye)
    assert on_level(eye, through, level) == pytest.approx((x, y), abs=1e-6)


def test_a_ray_into_the_sky_meets_nothing():
    assert on_level((0, 0, 1), (0, 1, 2), 0.0) is None
    assert on_level((0, 0, 1), (0, 1, 1), 0.0) is None


class Told:
    """Stands for a session: remembers what it is told."""

    def __init__(self):
        self.calls = []

    def __getattr__(self, name):
        return lambda *values: self.calls.append((name, *values))


@pytest.fixture
def told():
    return Told()


@pytest.fixture
def pointer(told):
    return Pointer(lambda command: command(told))


def click(way, client=1, index=2):
    ray = {"ray_origin": (0, 0, 1), "ray_direction": way}
    return SimpleNamespace(client_id=client, instance_index=index, **ray)


def test_a_click_on_a_robot_is_not_taken_for_one_on_the_ground(pointer, told):
    asyncio.run(pointer._clicked_robot(click((0.0, 0.6, -0.8))))
    asyncio.run(pointer._clicked_anywhere(click((0.0003, 0.6002, -0.7998))))
    assert told.calls == [("select", 2)]
    asyncio.run(pointer._clicked_anywhere(click((0.0, 0.6, -0.8))))
    assert told.calls[1:] == [("deselect",)]


def test_another_client_s_click_on_the_ground_counts(pointer, told):
    asyncio.run(pointer._clicked_robot(click((0.0, 0.6, -0.8))))
    asyncio.run(pointer._clicked_anywhere(click((0.0, 0.6, -0.8), client=2)))
    assert told.calls == [("select", 2), ("deselect",)]


def drag(phase, end, start=(1.0, 1.0, 0.07)):
    return SimpleNamespace(
        client_id=1,
        instance_index=0,
        phase=phase,
        start_position=start,
        end_position=end,
        target=SimpleNamespace(batched_positions=np.array([(0.95, 1.02, 0.0)])),
        client=SimpleNamespace(camera=SimpleNamespace(position=np.array((0.0, -5.0, 8.0)))),
    )


def test_what_is_dragged_stays_under_the_mouse(pointer, told):
    asyncio.run(pointer._drag_robot(drag("start", (1.0, 1.0, 0.07))))
    asyncio.run(pointer._drag_robot(drag("update", (1.5, 0.5, 0.07))))
    asyncio.run(pointer._drag_robot(drag("end", (1.5, 0.5, 0.07))))
    assert [call[:3] for call in told.calls] == [
        ("hold", "robot", 0),
        ("hold", "robot", 0),
        ("release",),
    ]
    assert told.calls[0][3:] == pytest.approx((0.95, 1.02))  # it does not jump to the mouse
    assert told.calls[1][3:] == pytest.approx((1.45, 0.52))


def test_robots_are_carried_about_in_any_arena_as_far_as_its_walls():
    scenario = load_scenario("aac")
    swarm = ShownSwarm(World(scenario, RuleSet(())))
    for place in ((5.0, 5.0), (-5.0, 0.3), (0.2, -0.1)):
        swarm.place("robot", 3, *place)
        view = swarm.view(1.0)
        found = np.array([(view.x[3], view.y[3])])
        assert distances(scenario.arena.outline, found) == 0.0
    assert found[0] == pytest.approx((0.2, -0.1), abs=0.05)
    assert view.objects.shape == (0, 2)
