"""The panel that looks into one robot: what it perceives, does and holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

import viser

from geswarm.rules import RuleSet
from geswarm.rules.model import Value, format_value
from geswarm.sim import World

from .. import palette
from ..state.session import Session
from .widgets import Mirror

_SOME, _NONE = "#0f8a4f", "#8a8f98"


@dataclass
class InspectorHandles:
    """Widgets that `sync` updates."""

    folder: viser.GuiFolderHandle
    text: viser.GuiHtmlHandle
    follow: viser.GuiCheckboxHandle


class InspectorPanel:
    """A folder that is there while a robot is selected."""

    handles: InspectorHandles

    def __init__(self, session: Session) -> None:
        self.session = session
        self._mirror = Mirror()
        self._shown = ""

    def build(self, gui: viser.GuiApi) -> None:
        """Make the folder, out of sight."""
        folder = gui.add_folder("Robot", visible=False)
        with folder:
            text = gui.add_html("")
            follow = gui.add_checkbox("Follow", False, hint="The camera goes with the robot")
        self.handles = InspectorHandles(folder, text, follow)

        @follow.on_update
        def _(event: viser.GuiEvent[viser.GuiCheckboxHandle]) -> None:
            wanted = event.target.value
            self.session.post(lambda session: session.follow(wanted))

    def sync(self) -> None:
        """Show the selected robot, or nothing."""
        session, handles = self.session, self.handles
        handles.folder.visible = session.selected is not None
        self._mirror.show(handles.follow, session.following)
        if session.selected is None:
            return
        handles.folder.label = f"Robot {session.selected + 1}"
        text = robot_html(session.world, session.selected, session.document.rule_set)
        if text != self._shown:
            self._shown = handles.text.content = text


def robot_html(world: World, robot: int, rule_set: RuleSet) -> str:
    """What there is to know of a robot, as HTML."""
    state = world.state
    colour = palette.css(palette.behaviour_colours(world.vocabulary)[state.behaviour[robot]])
    behaviour = (
        f'<span style="display:inline-block;width:.75em;height:.75em;border-radius:50%;'
        f'background:{colour};margin-right:.4em"></span>'
        f"<b>{escape(str(state.behaviours[state.instance[robot]]))}</b>"
    )
    heading = math.degrees(float(state.theta[robot]))
    rows = [
        ("behaviour", behaviour),
        ("perceives", _values(world.perceived(int(state.percepts[robot])))),
        ("internal states", _values(world.internal_states(int(state.internal_states[robot])))),
        ("last rule", last_rule_html(int(state.last_rule[robot]), rule_set)),
        (
            "place",
            f"{place(float(state.x[robot]), float(state.y[robot]))}<br>heading {compass(heading)}",
        ),
    ]
    if world.scenario.objects:
        rows.insert(3, ("carries", "an object" if state.carried[robot] else "nothing"))
    cells = "".join(
        '<tr style="vertical-align:top"><td style="opacity:.65;padding:.15em .8em .15em 0;'
        f'white-space:nowrap">{escape(label)}</td><td style="padding:.15em 0">{value}</td></tr>'
        for label, value in rows
        if value
    )
    return (
        '<div style="padding:.2em .9em .4em;font-size:.85em;line-height:1.35;'
        f'font-variant-numeric:tabular-nums"><table style="border:0">{cells}</table></div>'
    )


def last_rule_html(index: int, rule_set: RuleSet) -> str:
    """The rule that fired last, with its comment."""
    if not 0 <= index < len(rule_set.rules):
        return "none since the rules were set"
    comment = rule_set.rules[index].comment
    said = f'<div style="opacity:.75">{escape(comment)}</div>' if comment else ""
    return f"<b>R{index + 1}</b>{said}"


def place(x: float, y: float) -> str:
    """Where something is, metres from the centre of the arena, as people say it."""
    east_west, north_south = "west" if x < 0 else "east", "south" if y < 0 else "north"
    return f"{abs(x):.2f} m {east_west}, {abs(y):.2f} m {north_south} of the centre"


def compass(degrees: float) -> str:
    """A heading, given counter-clockwise from east, as people say it: `45° (north-east)`."""
    names = (
        "north",
        "north-east",
        "east",
        "south-east",
        "south",
        "south-west",
        "west",
        "north-west",
    )
    bearing = (90.0 - degrees) % 360.0
    return f"{round(bearing) % 360}° ({names[round(bearing / 45.0) % 8]})"


def _values(values: Mapping[str, Value]) -> str:
    """One line for each name; what is false, or nothing, is pale."""
    return "<br>".join(
        f"{escape(name if name.isupper() else name.replace('_', ' '))} "
        f'<b style="color:{_SOME if value else _NONE}">'
        f"{escape(format_value(value))}</b>"
        for name, value in values.items()
    )
