import io
import time

import imageio.v3 as imageio
import numpy as np
import pytest

from geswarm.app.scene.arena import ShownArena
from geswarm.app.scene.camera import framing
from geswarm.app.scene.cameraman import Cameraman
from geswarm.app.scene.scenery import draw_backdrop, outer_points
from geswarm.app.state.view import ArenaView

from .test_arena import PAPER, WIDE
from .test_camera import picture

pytestmark = [pytest.mark.browser, pytest.mark.slow]

AMBER, BLUE, GREEN = range(3)
# Robots in places that no panel covers.
X, Y = np.array([-1.2, 0.0, 0.6]), np.array([-1.6, -0.3, -1.4])


def view(behaviour, x=X):
    carried = np.zeros(len(x), dtype=bool)
    lying = np.array([(-0.5, 1.2)])
    return ArenaView(x, Y, np.zeros(len(x)), np.array(behaviour), carried, lying)


def screenshot(page):
    return imageio.imread(io.BytesIO(page.screenshot(type="png")))[..., :3].astype(int)


def around(image, x, y, shape=PAPER, radius=26):
    """The part of the picture around a place on the ground, shape (m, m, 3)."""
    rows, columns = image.shape[:2]
    aspect = columns / rows
    pose = framing(outer_points(shape), aspect)
    right, up = picture(np.array([(x, y, 0.07)]), pose, aspect)[0]
    column = round((right + 1) / 2 * columns)
    row = round((1 - up) / 2 * rows)
    return image[row - radius : row + radius, column - radius : column + radius]


def strongest(part):
    """Which LED colour the part shows most, and on how many pixels."""
    red, green, blue = part[..., 0], part[..., 1], part[..., 2]
    counts = (
        np.sum((red > blue + 90) & (green > blue + 60)),
        np.sum((blue > red + 90) & (blue > green + 40)),
        np.sum((green > red + 60) & (green > blue + 15)),
    )
    return int(np.argmax(counts)), int(max(counts))


def wait_for(page, condition):
    """A screenshot for which the condition holds; the renderer in software needs its time."""
    deadline = time.monotonic() + 40
    while not condition(image := screenshot(page)):
        assert time.monotonic() < deadline, "not drawn within 40 s"
    return image


def shows(behaviours, x=X):
    def condition(image):
        found = [strongest(around(image, *place)) for place in zip(x, Y, strict=True)]
        return all(
            colour == behaviour and pixels > 60
            for (colour, pixels), behaviour in zip(found, behaviours, strict=True)
        )

    return condition


# Of the first picture with more in it than the backdrop: how far away the camera is, and its shape.
FIRST_PICTURE = """
    const drawn = WebGL2RenderingContext.prototype;
    let draws = 0;
    for (const name of ["drawElements", "drawArrays", "drawElementsInstanced"]) {
      const draw = drawn[name];
      drawn[name] = function (...how) { draws += 1; return draw.apply(this, how); };
    }
    const look = () => {
      const { camera, canvas: { clientWidth, clientHeight } = {} } = window.__viserMutable ?? {};
      if (draws > 5) window.first = [camera.position.length(), clientWidth / clientHeight];
      else requestAnimationFrame(look);
      draws = 0;
    };
    requestAnimationFrame(look);
"""


@pytest.fixture
def arena(server, page):
    page.add_init_script(FIRST_PICTURE)
    arena = ShownArena()
    draw_backdrop(server.scene)
    arena.build(server.scene, PAPER)
    arena.cameraman = Cameraman()
    arena.cameraman.build(server, outer_points(PAPER))
    arena.sync(view([AMBER, BLUE, GREEN]))
    page.goto(f"http://127.0.0.1:{server.get_port()}/")
    return arena


def test_robots_are_drawn_where_they_are_in_the_colour_of_what_they_do(arena, page):
    image = wait_for(page, shows([AMBER, BLUE, GREEN]))
    nest, source = (around(image, -1.8, y, radius=4).mean(axis=(0, 1)) for y in (-1.0, 1.0))
    assert nest[2] > nest[0] + 10
    assert source[0] > source[2] + 20
    assert nest.min() > 150
    assert source.min() > 150

    arena.sync(view([GREEN, AMBER, BLUE]))
    wait_for(page, shows([GREEN, AMBER, BLUE]))

    arena.sync(view([GREEN, AMBER, BLUE], x=X - 0.5))
    image = wait_for(page, shows([GREEN, AMBER, BLUE], x=X - 0.5))
    assert strongest(around(image, X[1], Y[1]))[1] < 30


def test_the_first_picture_of_the_arena_shows_all_of_it(arena, page):
    page.set_viewport_size({"width": 620, "height": 1000})
    page.reload()
    distance, aspect = page.wait_for_function("window.first", timeout=40_000).json_value()
    expected = framing(outer_points(PAPER), aspect).position
    assert distance == pytest.approx(np.linalg.norm(expected), rel=0.01)


def test_arena_stays_in_the_picture_when_the_window_changes(arena, page):
    wait_for(page, shows([AMBER, BLUE, GREEN]))
    page.set_viewport_size({"width": 820, "height": 1000})
    wait_for(page, shows([AMBER, BLUE, GREEN]))


def test_open_page_follows_a_change_of_the_scenario(arena, page, server):
    wait_for(page, shows([AMBER, BLUE, GREEN]))
    arena.build(server.scene, WIDE)
    arena.cameraman.frame(outer_points(WIDE))
    blues = ArenaView(
        *np.array([(-9.0, 9.0), (-1.0, -1.0), (0.0, 0.0)]),
        np.array([BLUE, BLUE]),
        np.array([False, False]),
        np.empty((0, 2)),
    )
    arena.sync(blues)
    wait_for(
        page,
        lambda image: all(
            strongest(around(image, x, -1.0, WIDE, radius=12)) > (BLUE, 20) for x in (-9.0, 9.0)
        ),
    )
