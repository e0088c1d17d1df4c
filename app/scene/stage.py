"""Everything in the 3D scene: the arena, the rival's beside it, overlays, titles, the camera."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import viser

from geswarm.sim import Scenario

from ..state.playback import clock
from ..state.score import figure, score
from ..state.session import Session
from .arena import ShownArena
from .cameraman import Cameraman
from .detail import Detail, DetailKeeper
from .overlays import Overlays
from .pointer import Pointer
from .replay import THESE_RULES
from .scenery import MARGIN, draw_backdrop, outer_points

_TRAIL_SECONDS, _VISIT_SECONDS = 0.1, 0.5  # from one drawing to the next
_APART = 0.35  # m between the tables of two arenas


class Stage:
    """Shows a session in the scene; what happens there is posted to it.

    Attributes:
        arena: The swarm.
        rival: The other swarm's arena, drawn while there is one.
        keeper: Chooses how finely robots are drawn.
        captioned: Time and score stand beside the arena: a replay has no panel that tells them.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self.pointer = Pointer(session.post)
        self.arena = ShownArena("/arena", self.pointer.attach)
        self.rival = ShownArena("/rival")
        self.overlays = Overlays()
        self.cameraman = Cameraman()
        self.keeper = DetailKeeper()
        self.captioned = False
        self._caption: viser.LabelHandle | None = None
        self._titles: dict[str, viser.LabelHandle] = {}
        self._since_robots = self._since_trails = self._since_visits = 0.0

    def build(self, server: viser.ViserServer) -> None:
        """Draw the session as it is and begin to listen to the mouse."""
        self._server = server
        draw_backdrop(server.scene)
        self.pointer.watch_ground(server.scene)
        self._layout = self._wanted_layout()
        self._draw()
        self.cameraman.build(server, self._points())

    def sync(self, elapsed: float) -> None:
        """Show the session as it is; called by the loop once a frame.

        Args:
            elapsed: Seconds since the last call.
        """
        session = self.session
        browsers = len(self._server.get_clients())
        robots = session.scenario.robots * (1 if session.rival is None else 2)
        self.keeper.sync(elapsed, robots, browsers)
        self.pointer.points_only = self.keeper.detail is Detail.POINTS
        with self._server.atomic():
            if (layout := self._wanted_layout()) != self._layout:
                self._layout = layout
                self._draw()
                self.cameraman.frame(self._points())
                self._since_robots = math.inf
            self._since_robots += elapsed
            if self._since_robots >= self.keeper.pause:
                self._since_robots = 0.0
                self._sync_robots()
            self._sync_caption()
            self._sync_now_and_then(elapsed)

    def _sync_robots(self) -> None:
        session, detail = self.session, self.keeper.detail
        view = session.view()
        self.arena.sync(view, detail)
        if (rival_view := session.rival_view()) is not None:
            self.rival.sync(rival_view, detail)
            self._sync_titles()
        self.overlays.sync_ranges(session.scenario, session.shown)
        self.overlays.sync_robots(view, session.selected, session.shown)
        robot = session.selected if session.following else None
        self.cameraman.follow(
            None if robot is None else (float(view.x[robot]), float(view.y[robot]))
        )

    def _sync_now_and_then(self, elapsed: float) -> None:
        session = self.session
        self._since_trails += elapsed
        self._since_visits += elapsed
        if self._since_trails >= _TRAIL_SECONDS:
            self._since_trails = 0.0
            self.overlays.sync_trace(session.trace, session.shown)
        if self._since_visits >= _VISIT_SECONDS:
            self._since_visits = 0.0
            self.overlays.sync_visits(session.trace, session.shown)

    def _wanted_layout(self) -> tuple[object, ...]:
        """All that the scenery and the colours of the robots depend on."""
        session = self.session
        return session.scenario.arena, session.vocabulary, session.rival is not None

    def _draw(self) -> None:
        scenario, scene = self.session.scenario, self._server.scene
        self._titles = {}
        self.arena.build(scene, scenario)
        self.overlays.build(scene, scenario)
        self.rival.remove()
        if self._caption is not None:
            self._caption.remove()
            self._caption = None
        if self.session.rival is not None:
            self.rival.build(scene, scenario, beside(scenario))
            front = (0.0, -scenario.length / 2 - MARGIN, 0.0)
            for root, text in self._title_texts().items():
                self._titles[root] = scene.add_label(
                    f"{root}/title",
                    text,
                    position=front,
                    anchor="top-center",
                    font_screen_scale=1.5,
                )

    def _title_texts(self) -> dict[str, str]:
        """What stands before each of two arenas, by their nodes; nothing before one alone."""
        session = self.session
        if session.rival is None:
            return {}
        mine, other = session.world, session.rival.swarm.world
        return {
            self.arena.root: f"{THESE_RULES}: {figure(mine.fitness)}",
            self.rival.root: f"{session.rival.name}: {figure(other.fitness)}",
        }

    def _sync_titles(self) -> None:
        for root, text in self._title_texts().items():
            self._titles[root].text = text

    def _sync_caption(self) -> None:
        world, scenario = self.session.world, self.session.scenario
        if not self.captioned:
            if self._caption is not None:
                self._caption.remove()
                self._caption = None
            return
        text = clock(world.time)
        if self.session.rival is None:
            text += " · " + ", ".join(f"{value} {name}" for name, value in score(world))
        if self._caption is None:
            west, north = -scenario.width / 2 - MARGIN, scenario.length / 2 + MARGIN
            self._caption = self._server.scene.add_label(
                "/caption",
                text,
                position=(west, north, 0.0),
                anchor="bottom-left",
                font_screen_scale=1.5,
            )
        self._caption.text = text

    def _points(self) -> npt.NDArray[np.float64]:
        """What must be in the picture, shape (n, 3), metres."""
        scenario = self.session.scenario
        points = outer_points(scenario)
        if self.session.rival is None:
            return points
        titles = points - np.array((0.0, 0.15 * scenario.length, 0.0))
        points = np.concatenate((points, titles))
        return np.concatenate((points, points + np.array((*beside(scenario), 0.0))))


def beside(scenario: Scenario) -> tuple[float, float]:
    """Where the second arena is: to the right of the first, or below it if they are wide."""
    across, along, _ = np.ptp(outer_points(scenario), axis=0)
    if scenario.width > 2.0 * scenario.length:
        return 0.0, -float(0.5 * scenario.length + along + MARGIN + _APART)
    return float(across) + _APART, 0.0
