import numpy as np
import pytest

from geswarm.app import palette
from geswarm.app.scene.arena import ShownArena
from geswarm.app.state.view import ArenaView
from geswarm.rules.vocabulary import FORAGING
from geswarm.sim import load_scenario

PAPER = load_scenario("paper")
WIDE = PAPER.with_changes(width=21.0)


def view(robots=3, objects=2, behaviour=0, x=0.0):
    return ArenaView(
        x=np.full(robots, x),
        y=np.arange(robots) * 0.5,
        theta=np.full(robots, np.pi / 2),
        behaviour=np.full(robots, behaviour),
        carried=np.arange(robots) % 2 == 1,
        objects=np.full((objects, 2), 1.5),
    )


@pytest.fixture
def arena(server):
    arena = ShownArena()
    arena.build(server.scene, PAPER)
    return arena


def test_view_arrives_in_the_batches(arena):
    arena.sync(view())
    arena.sync(view(behaviour=1, x=1.0))
    robots, objects = arena.handles.robots, arena.handles.objects
    for batch in (*robots.posed, robots.shadows, robots.glows):
        np.testing.assert_allclose(batch.batched_positions, [(1, 0, 0), (1, 0.5, 0), (1, 1, 0)])
    for batch in robots.posed:
        np.testing.assert_allclose(batch.batched_wxyzs, [[0.5**0.5, 0, 0, 0.5**0.5]] * 3)
    blue = palette.linear(palette.behaviour_colours(FORAGING)[1])
    np.testing.assert_array_equal(robots.leds.batched_colors, [blue] * 3)
    np.testing.assert_array_equal(robots.glows.batched_colors, [blue] * 3)
    np.testing.assert_array_equal(robots.carried.batched_scales, [0, 1, 0])
    np.testing.assert_allclose(objects.batched_positions, [(1.5, 1.5, 0)] * 2)


def test_batches_are_kept_while_the_counts_stay(arena):
    arena.sync(view())
    robots, objects = arena.handles.robots, arena.handles.objects
    arena.sync(view(x=2.0))
    assert arena.handles.robots is robots
    assert arena.handles.objects is objects


@pytest.mark.parametrize("counts", [(5, 2), (3, 4), (0, 0), (1, 0), (0, 1), (20, 25)])
def test_counts_may_change(arena, counts):
    arena.sync(view())
    before = arena.handles.robots
    arena.sync(view(*counts))
    robots, objects = arena.handles.robots, arena.handles.objects
    assert (len(robots.leds.batched_positions) if robots else 0) == counts[0]
    assert (len(objects.batched_positions) if objects else 0) == counts[1]
    if counts[0] != 3:
        with pytest.raises(RuntimeError, match="removed"):
            before.bodies.visible = False
    arena.sync(view())


def test_another_scenario_replaces_the_old_one(arena, server):
    arena.sync(view())
    robots = arena.handles.robots
    arena.build(server.scene, WIDE, at=(3.0, -2.0))
    assert arena.handles.robots is None
    np.testing.assert_allclose(arena.handles.root.position, (3, -2, 0))
    with pytest.raises(RuntimeError, match="removed"):
        robots.bodies.visible = False
    arena.sync(view(20, 25))


def test_sync_before_build_is_told():
    with pytest.raises(RuntimeError, match=r"expected build\(\)"):
        ShownArena().sync(view())


def test_view_is_not_kept(arena):
    shown = view()
    arena.sync(shown)
    shown.x[:] = 9.0
    assert not arena.handles.robots.bodies.batched_positions[:, 0].any()


def test_new_batches_are_told_once(server):
    made = []
    arena = ShownArena("/arena", lambda kind, batches: made.append((kind, batches)))
    arena.build(server.scene, PAPER)
    for _ in range(3):
        arena.sync(view())
    handles = arena.handles
    assert made == [("robot", handles.robots.posed), ("object", (handles.objects,))]
    arena.sync(view(4, 2))
    assert [kind for kind, _ in made] == ["robot", "object", "robot"]
