"""The panel that plays the arena: time, score, speed, scenario."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

import viser

from geswarm.rules import RuleSet
from geswarm.sim import World, load_scenario, scenario_names

from ..scene.detail import Detail, DetailKeeper
from ..state.keys import KEYS, Key
from ..state.plan import LARGEST_SEED
from ..state.playback import SPEEDS, clock
from ..state.score import figure, score
from ..state.session import Command, Session
from .widgets import Mirror, Refusal

_PLAY, _PAUSE, _STEP, _RESET = "Play", "Pause", "Step", "Reset"
_NOTHING = "nothing"


def speed_label(speed: float) -> str:
    """`1x`, `10x`, `max`."""
    return "max" if math.isinf(speed) else f"{speed:g}x"


@dataclass
class SwarmHandles:
    """Widgets that `sync` updates."""

    score: viser.GuiHtmlHandle
    play: viser.GuiButtonHandle
    back: viser.GuiButtonHandle
    speed: viser.GuiButtonGroupHandle
    scenario: viser.GuiDropdownHandle[str]
    seed: viser.GuiNumberHandle[int]
    compare: viser.GuiDropdownHandle[str]


class SwarmPanel:
    """Shows the clock and the score; its buttons post commands."""

    handles: SwarmHandles

    def __init__(self, session: Session, keeper: DetailKeeper) -> None:
        self.session = session
        self.keeper = keeper
        self._mirror = Mirror()
        self._score = ""

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        post, session = self.session.post, self.session
        score = gui.add_html("")
        play = gui.add_button(
            _PLAY,
            icon=viser.Icon.PLAYER_PLAY,
            hint="Keys: P plays, O pauses (click the arena first)",
        )
        play.on_click(lambda _: post(lambda s: s.pause() if s.playback.playing else s.play()))
        run = gui.add_button_group(
            "Run",
            (_STEP, _RESET),
            hint="X: one control step of 0.1 s; R: start the run again with the same seed",
        )
        run.on_click(
            lambda event: post(lambda s: s.step() if event.target.value == _STEP else s.reset())
        )
        back = gui.add_button(
            "",
            color="gray",
            icon=viser.Icon.ARROW_BACK_UP,
            hint="The run before, exactly as it was; this one is kept, too",
            visible=False,
        )
        back.on_click(lambda _: post(lambda s: s.take_back_reset()))
        speeds = {speed_label(speed): speed for speed in SPEEDS}
        speed = gui.add_button_group(
            "Speed", tuple(speeds), hint="Simulated seconds per second; F: max, or back to 1x"
        )
        speed.on_click(lambda event: post(lambda s: s.set_speed(speeds[event.target.value])))
        scenario = self._add_scenarios(gui)
        seed = gui.add_number("Seed", session.world.seed, min=0, max=LARGEST_SEED, step=1)

        @seed.on_update
        def _(event: viser.GuiEvent[viser.GuiNumberHandle[int]]) -> None:
            number = int(event.target.value)
            post(lambda s: s.reset(number) if s.world.seed != number else None)

        compare = gui.add_dropdown(
            "Compare with",
            (_NOTHING, *session.rivals_offered()),
            hint="A second arena beside this one, same seed and clock; both start again",
        )

        @compare.on_update
        def _(event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
            name = event.target.value
            post(lambda s: compare_with(s, None if name == _NOTHING else name))

        self._refusal = Refusal(gui)
        for key, label, command in KEYS:
            add_key(gui, session, key, label, command)
        self.handles = SwarmHandles(score, play, back, speed, scenario, seed, compare)

    def _add_scenarios(self, gui: viser.GuiApi) -> viser.GuiDropdownHandle[str]:
        given, post = self.session.scenario, self.session.post
        names = tuple(dict.fromkeys([*scenario_names(), given.name]))
        scenarios = gui.add_dropdown("Scenario", names, initial_value=given.name)

        @scenarios.on_update
        def _(event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
            name = event.target.value
            chosen = given if name == given.name else load_scenario(name)
            event.target.disabled = True
            World(chosen, RuleSet()).step()  # what must be compiled is so now: the arena goes on
            event.target.disabled = False
            post(lambda s: s.set_scenario(chosen) if s.loaded != chosen else None)

        return scenarios

    def sync(self) -> None:
        """Show the session as it is."""
        session, handles = self.session, self.handles
        score = score_html(session) + detail_html(self.keeper)
        if score != self._score:
            self._score = handles.score.content = score
        playing = session.playback.playing
        if handles.play.label != (_PAUSE if playing else _PLAY):
            handles.play.label = _PAUSE if playing else _PLAY
            handles.play.icon = viser.Icon.PLAYER_PAUSE if playing else viser.Icon.PLAYER_PLAY
        run = session.past.latest
        handles.back.visible = run is not None
        if run is not None:
            handles.back.label = f"Back to {clock(run.time)} of the run before"
        self._mirror.show(handles.seed, session.world.seed)
        handles.speed.label = f"Speed {speed_label(session.playback.speed)}"
        if session.loaded.name in handles.scenario.options:
            self._mirror.show(handles.scenario, session.loaded.name)
        rival = session.rival.name if session.rival else _NOTHING
        offered = tuple(dict.fromkeys((_NOTHING, *session.rivals_offered(), rival)))
        if handles.compare.options != offered:
            handles.compare.options = offered
        if self._refusal.show(session.rival_problem):
            self._mirror.forget(handles.compare)
        self._mirror.show(handles.compare, rival)


def add_key(gui: viser.GuiApi, session: Session, key: Key, label: str, command: Command) -> None:
    """Have a key, pressed anywhere but in a field, post a command."""
    gui.add_command(label, hotkey=key).on_trigger(lambda _: session.post(command))


def compare_with(session: Session, name: str | None) -> None:
    """Compare with another rule set, unless that is being done already."""
    if name != (session.rival.name if session.rival else None):
        session.compare_with(name)


def detail_html(keeper: DetailKeeper) -> str:
    """A word on robots that are drawn coarser than usual, as HTML; empty if they are not."""
    if keeper.frame is None or not keeper.coarser_than_usual:
        return ""
    drawn = "points" if keeper.detail is Detail.POINTS else "simple shapes"
    return (
        '<div style="padding:.1em .9em .5em;font-size:.85em;line-height:1.35">'
        f"<b>Robots are drawn as {drawn}</b>: a browser that looks on is slow "
        f"({1 / keeper.frame:.1f} frames per second). The simulation is the same.</div>"
    )


def score_html(session: Session) -> str:
    """Clock and score of the run, as HTML; of both runs if two are compared."""
    world = session.world
    figures = score(world)
    if session.rival is not None:
        figures = [
            ("these rules", figure(world.fitness)),
            (session.rival.name, figure(session.rival.swarm.world.fitness)),
        ]
    figures.append(("time", clock(world.time)))
    cells = "".join(
        '<div style="flex:1"><div style="font-size:1.5em;font-weight:600;line-height:1.1;'
        f'font-variant-numeric:tabular-nums">{escape(value)}</div>'
        f'<div style="font-size:.75em;opacity:.65">{escape(label)}</div></div>'
        for label, value in figures
    )
    changed = ", changed" if session.scenario != session.loaded else ""
    return (
        '<div style="padding:.2em .9em .5em">'
        f'<div style="display:flex;text-align:center">{cells}</div>'
        '<div style="font-size:.75em;opacity:.65;text-align:center;padding-top:.4em">'
        f"{escape(session.scenario.name)}{changed} · {session.scenario.robots} robots</div></div>"
    )
