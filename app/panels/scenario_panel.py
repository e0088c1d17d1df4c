"""The panel that changes the scenario while the swarm runs."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any

import viser

from geswarm.sim import NEEDS_RESET, Scenario
from geswarm.sim.arena.model import Box

from ..state.session import Session
from .widgets import Mirror, Refusal

APPLY_SECONDS = 0.6
"""A number counts once it has stood for this long: every keystroke arrives as a change."""


@dataclass(frozen=True)
class Value:
    """A number of the scenario.

    Attributes:
        key: Attribute of the scenario; `random_walk.0` is its first number.
        label: For people, with unit.
        step: Of the arrows beside the number.
        hint: What it means.
    """

    key: str
    label: str
    step: float
    hint: str

    @property
    def needs_reset(self) -> bool:
        """The run cannot go on with another value."""
        return self.key in NEEDS_RESET

    def applies(self, scenario: Scenario) -> bool:
        """The scenario has such a number: a nest, objects, an arena that is a rectangle."""
        if self.key in ("width", "length"):
            return isinstance(scenario.arena.outline, Box)
        if self.key in ("nest", "source", "light", "objects"):
            return bool(getattr(scenario, self.key))
        if self.key in ("grip_reach", "object_range", "object_margin"):
            return bool(scenario.objects)
        return True

    def of(self, scenario: Scenario) -> float:
        """Its value."""
        name, _, part = self.key.partition(".")
        value: Any = getattr(scenario, name)
        return float(value[int(part)]) if part else value

    def change(self, scenario: Scenario, value: float) -> dict[str, Any]:
        """The attribute of the scenario with another value for this number."""
        name, _, part = self.key.partition(".")
        if part:
            pair = list(getattr(scenario, name))
            pair[int(part)] = value
            return {name: tuple(pair)}
        whole = isinstance(getattr(scenario, name), int) and math.isfinite(value)
        return {name: int(value) if whole else value}


VALUES = (
    Value("zone_miss", "zone_miss", 0.01, "Probability of perceiving neither zone in a step"),
    Value("max_speed", "Speed, m/s", 0.01, "Highest speed of a wheel"),
    Value("avoidance_gain", "Avoidance", 0.1, "Weight of the avoidance vector"),
    Value("turn_gain", "Turn gain, 1/s", 0.1, "Turning speed per angle to the target"),
    Value("random_walk.0", "Walk min, s", 1.0, "Shortest time for which a heading is kept"),
    Value("random_walk.1", "Walk max, s", 1.0, "Longest time for which a heading is kept"),
    Value("grip_reach", "Grip reach, m", 0.01, "From the robot's centre to an object"),
    Value("object_range", "Sight, m", 0.05, "From the robot's centre to an object that it sees"),
    Value("proximity_range", "Proximity, m", 0.01, "From the body's edge to a wall"),
    Value("rab_range", "Rab range, m", 0.05, "Between the centres of two robots"),
    Value("object_margin", "Margin, m", 0.01, "Objects do not appear nearer to a wall"),
    Value("light", "Light, m", 10.0, "From the north wall to the light"),
    Value("robots", "Robots", 1, "How many"),
    Value("objects", "Objects", 1, "How many always lie at the source"),
    Value("width", "Width, m", 0.1, "From west to east"),
    Value("length", "Length, m", 0.1, "From south to north"),
    Value("nest", "Nest, m", 0.1, "Depth of the nest"),
    Value("source", "Source, m", 0.1, "Depth of the source"),
)
"""What can be changed; all but the duration, which is not the arena's."""


class ScenarioPanel:
    """Shows the numbers of the scenario; a change acts a moment after the last keystroke."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._mirror = Mirror()
        self._numbers: dict[str, viser.GuiNumberHandle[float]] = {}
        self._wanted: dict[str, tuple[float, float]] = {}  # by key: value, and when it was typed

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        self._refusal = Refusal(gui)
        for title, needs_reset in (
            ("acts at once", False),
            ("starts the run again", True),
        ):
            gui.add_html(
                f'<div style="padding:.3em .9em 0;font-size:.75em;opacity:.65">{title}</div>'
            )
            for value in VALUES:
                if value.needs_reset == needs_reset:
                    self._add_number(gui, value)
        self._restore = gui.add_button(self._restore_label(), icon=viser.Icon.RESTORE)
        self._restore.on_click(lambda _: self.session.post(self._take_back))

    def sync(self) -> None:
        """Carry out what was typed, then show the scenario as it is."""
        session, now = self.session, time.monotonic()
        for value in VALUES:
            wanted = self._wanted.get(value.key)
            if wanted is not None and now - wanted[1] >= APPLY_SECONDS:
                del self._wanted[value.key]
                session.change_scenario(**value.change(session.scenario, wanted[0]))
                self._mirror.forget(self._numbers[value.key])
        for value in VALUES:
            if value.key not in self._wanted:
                self._mirror.show(self._numbers[value.key], value.of(session.scenario))
            applies = value.applies(session.scenario)
            if self._numbers[value.key].visible != applies:
                self._numbers[value.key].visible = applies
        self._restore.disabled = session.scenario == session.loaded
        if self._restore.label != self._restore_label():
            self._restore.label = self._restore_label()
        self._refusal.show(session.scenario_problem)

    def _add_number(self, gui: viser.GuiApi, value: Value) -> None:
        number = gui.add_number(
            value.label, value.of(self.session.scenario), step=value.step, hint=value.hint
        )
        self._numbers[value.key] = number

        @number.on_update
        def _(event: viser.GuiEvent[viser.GuiNumberHandle[float]]) -> None:
            typed = event.target.value
            if event.client is not None:  # else the panel itself assigned it
                self.session.post(lambda session: self._type(session, value, typed))

    def _type(self, session: Session, value: Value, typed: float) -> None:
        """Remember a number that was typed; why the one before was refused is of no interest."""
        session.scenario_problem = ""
        if typed != value.of(session.scenario):
            self._wanted[value.key] = (typed, time.monotonic())
        else:
            self._wanted.pop(value.key, None)

    def _take_back(self, session: Session) -> None:
        self._wanted.clear()
        for number in self._numbers.values():
            self._mirror.forget(number)
        session.restore_scenario()

    def _restore_label(self) -> str:
        return f"Reset to {self.session.loaded.name}'s values"
