"""The panel that plays the arena: time, score, speed, scenario."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

import viser

from geswarm.sim import load_scenario, scenario_names

from .playback import SPEEDS
from .session import Session

_PLAY, _PAUSE, _STEP, _RESET = "Play", "Pause", "Step", "Reset"


def speed_label(speed: float) -> str:
    """`1x`, `10x`, `max`."""
    return "max" if math.isinf(speed) else f"{speed:g}x"


@dataclass
class SwarmHandles:
    """Widgets that `sync` updates."""

    score: viser.GuiHtmlHandle
    play: viser.GuiButtonHandle
    speed: viser.GuiButtonGroupHandle
    scenario: viser.GuiDropdownHandle[str]
    seed: viser.GuiNumberHandle[int]


class SwarmPanel:
    """Shows the clock and the score; its buttons post commands."""

    handles: SwarmHandles

    def __init__(self, session: Session) -> None:
        self.session = session
        self._score = ""

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        post, session = self.session.post, self.session
        score = gui.add_html("")
        play = gui.add_button(_PLAY, icon=viser.Icon.PLAYER_PLAY)
        play.on_click(lambda _: post(lambda s: s.pause() if s.playback.playing else s.play()))
        run = gui.add_button_group(
            "Run", (_STEP, _RESET), hint="One control step of 0.1 s; or start the run again"
        )
        run.on_click(
            lambda event: post(lambda s: s.step() if event.target.value == _STEP else s.reset())
        )
        speeds = {speed_label(speed): speed for speed in SPEEDS}
        speed = gui.add_button_group("Speed", tuple(speeds))
        speed.on_click(lambda event: post(lambda s: s.set_speed(speeds[event.target.value])))
        names = list(dict.fromkeys([*scenario_names(), session.scenario.name]))
        given = session.scenario
        scenario = gui.add_dropdown("Scenario", tuple(names), initial_value=given.name)

        @scenario.on_update
        def _(event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
            name = event.target.value
            chosen = given if name == given.name else load_scenario(name)
            post(lambda s: s.set_scenario(chosen) if s.scenario != chosen else None)

        seed = gui.add_number("Seed", session.world.seed, min=0, step=1)

        @seed.on_update
        def _(event: viser.GuiEvent[viser.GuiNumberHandle[int]]) -> None:
            number = int(event.target.value)
            post(lambda s: s.reset(number) if s.world.seed != number else None)

        self.handles = SwarmHandles(score, play, speed, scenario, seed)

    def sync(self) -> None:
        """Show the session as it is."""
        session, handles = self.session, self.handles
        score = score_html(session)
        if score != self._score:
            self._score = handles.score.content = score
        playing = session.playback.playing
        if handles.play.label != (_PAUSE if playing else _PLAY):
            handles.play.label = _PAUSE if playing else _PLAY
            handles.play.icon = viser.Icon.PLAYER_PAUSE if playing else viser.Icon.PLAYER_PLAY


def score_html(session: Session) -> str:
    """Clock and score of the run, as HTML."""
    world = session.world
    minutes, seconds = divmod(int(world.time), 60)
    speed = speed_label(session.playback.speed)
    figures = (
        ("collected", f"{world.collected}"),
        ("lost", f"{world.lost}"),
        ("time", f"{minutes}:{seconds:02d}"),
    )
    cells = "".join(
        '<div style="flex:1"><div style="font-size:1.5em;font-weight:600;line-height:1.1;'
        f'font-variant-numeric:tabular-nums">{escape(value)}</div>'
        f'<div style="font-size:.75em;opacity:.65">{escape(label)}</div></div>'
        for label, value in figures
    )
    return (
        '<div style="padding:.2em .9em .5em">'
        f'<div style="display:flex;text-align:center">{cells}</div>'
        '<div style="font-size:.75em;opacity:.65;text-align:center;padding-top:.4em">'
        f"{escape(session.scenario.name)} · {session.scenario.robots} robots · {speed}</div></div>"
    )
