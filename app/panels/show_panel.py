"""The panel that chooses what is drawn over the arena."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

import viser

from .. import palette
from ..scene.overlays import HEAT, RANGE_COLOURS, sensing_ranges
from ..state.session import Session
from ..state.trace import TRAIL_SECONDS
from ..state.view import Whose
from .widgets import Mirror

_WHOSE: dict[str, Whose] = {"none": "none", "selected robot": "selected", "all robots": "all"}
_WORDS = {whose: words for words, whose in _WHOSE.items()}


@dataclass
class ShowHandles:
    """Widgets that `sync` updates."""

    trails: viser.GuiCheckboxHandle
    visits: viser.GuiCheckboxHandle
    ranges: viser.GuiDropdownHandle[str]


class ShowPanel:
    """Toggles, and what the colours mean."""

    handles: ShowHandles
    legend: viser.GuiHtmlHandle

    def __init__(self, session: Session) -> None:
        self.session = session
        self._mirror = Mirror()
        self._shown = ""

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        post, shown = self.session.post, self.session.shown
        trails = gui.add_checkbox(
            "Trails", shown.trails, hint=f"Paths of the last {TRAIL_SECONDS:g} s, by behaviour"
        )
        visits = gui.add_checkbox(
            "Visit heat map", shown.visits, hint="How often each place was visited in this run"
        )
        ranges = gui.add_dropdown("Sensing ranges", tuple(_WHOSE), initial_value="none")
        self.legend = gui.add_html("", visible=False)
        self.handles = ShowHandles(trails, visits, ranges)

        @trails.on_update
        def _(event: viser.GuiEvent[viser.GuiCheckboxHandle]) -> None:
            wanted = event.target.value
            post(lambda session: setattr(session.shown, "trails", wanted))

        @visits.on_update
        def _(event: viser.GuiEvent[viser.GuiCheckboxHandle]) -> None:
            wanted = event.target.value
            post(lambda session: setattr(session.shown, "visits", wanted))

        @ranges.on_update
        def _(event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
            whose = _WHOSE[event.target.value]
            post(lambda session: setattr(session.shown, "ranges", whose))

    def sync(self) -> None:
        """Show what is chosen, and the legends of what is drawn."""
        self._mirror.show(self.handles.trails, self.session.shown.trails)
        self._mirror.show(self.handles.visits, self.session.shown.visits)
        shown = self.session.shown.ranges
        self._mirror.show(self.handles.ranges, _WORDS[shown])
        text = heat_html() if self.session.shown.visits else ""
        if shown != "none":
            text += legend_html(
                sensing_ranges(self.session.scenario),
                hint=shown == "selected" and self.session.selected is None,
            )
        if text != self._shown:
            self._shown = self.legend.content = text
            self.legend.visible = bool(text)


def heat_html() -> str:
    """The colours of the visit heat map, as HTML."""
    colours = ", ".join(palette.css(colour) for colour in HEAT)
    return (
        '<div style="display:flex;align-items:center;gap:.5em;padding:.1em .9em .4em;'
        'font-size:.85em">visited rarely<span style="flex:1;height:.6em;border-radius:.3em;'
        f'background:linear-gradient(90deg, {colours})"></span>often</div>'
    )


def legend_html(ranges: dict[str, float], hint: bool) -> str:
    """Colour and radius of each circle, and perhaps how to have one, as HTML."""
    lines = [
        f'<div><span style="display:inline-block;width:.6em;height:.6em;border-radius:50%;'
        f'border:.15em solid {palette.css(RANGE_COLOURS[name])};margin-right:.5em"></span>'
        f"{escape(name)}, {radius:g} m</div>"
        for name, radius in ranges.items()
    ]
    if hint:
        lines.append('<div style="opacity:.65">Click a robot to select it.</div>')
    return f'<div style="padding:.1em .9em .4em;font-size:.85em">{"".join(lines)}</div>'
