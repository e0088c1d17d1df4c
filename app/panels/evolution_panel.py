"""The panel that evolves: start and stop, fitness curves; the evolution page has all the rest."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

import numpy as np
import viser
from viser import uplot
from viser._gui_handles import GuiProgressBarHandle

from ..state.evolution import REFERENCES, EvolutionThread, Phase
from ..state.session import Session

_DASHED = uplot.Series(dash=(6.0, 4.0))
_CURVES = (
    ("best so far", "#0f62d6", 2.5, uplot.Series()),
    ("best of generation", "#7aa7e8", 1.0, uplot.Series()),
    ("mean", "#8a8f98", 1.5, uplot.Series()),
    ("hand-coded", "#c2410c", 1.5, _DASHED),
    ("EVO 8", "#15803d", 1.5, _DASHED),
)
_FONT = "11px system-ui, sans-serif"


@dataclass
class EvolutionHandles:
    """Widgets that `sync` updates."""

    status: viser.GuiHtmlHandle
    progress: GuiProgressBarHandle
    start: viser.GuiButtonHandle
    pause: viser.GuiButtonHandle
    stop: viser.GuiButtonHandle
    load_best: viser.GuiButtonHandle
    chart: viser.GuiUplotHandle


class EvolutionPanel:
    """Shows the background evolution; its buttons post commands."""

    handles: EvolutionHandles

    def __init__(self, session: Session) -> None:
        self.session = session
        self._shown: tuple[object, ...] = ()

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        status = gui.add_html(status_html(self.session.evolution, []))
        progress = gui.add_progress_bar(0.0, visible=False)
        chart = add_chart(gui)
        start = gui.add_button("Start evolution", icon=viser.Icon.DNA_2)
        pause = gui.add_button("Pause", icon=viser.Icon.PLAYER_PAUSE, visible=False)
        stop = gui.add_button("Stop", icon=viser.Icon.PLAYER_STOP, visible=False)
        load = gui.add_button(
            "Load the best into the arena", icon=viser.Icon.DOWNLOAD, disabled=True
        )
        self.handles = EvolutionHandles(status, progress, start, pause, stop, load, chart)
        start.on_click(lambda _: self.session.post(begin))

        @pause.on_click
        def _(_: object) -> None:
            self.session.post(lambda session: pause_or_go_on(session.evolution))

        stop.on_click(lambda _: self.session.post(lambda session: session.evolution.stop(0.0)))
        load.on_click(lambda _: self.session.post(load_best))

    def sync(self) -> None:
        """Show the evolution as it is."""
        evolution, handles = self.session.evolution, self.handles
        plan, rule_set = self.session.runs.plan, self.session.document.rule_set
        progress = (evolution.phase, len(evolution.history), len(evolution.references))
        shown = (*progress, plan, rule_set, self.session.campaigns.thread.active)
        if shown == self._shown:
            return
        self._shown = shown
        findings = plan.findings(rule_set)
        handles.status.content = status_html(evolution, list(findings))
        handles.start.disabled = bool(findings) or self.session.campaigns.thread.active
        handles.start.visible = not evolution.active
        handles.pause.visible = handles.stop.visible = evolution.active
        paused = evolution.phase is Phase.PAUSED
        handles.pause.label = "Go on" if paused else "Pause"
        handles.load_best.disabled = evolution.best is None
        handles.progress.visible = evolution.active
        if evolution.generations:
            done = 100.0 * len(evolution.history) / evolution.generations
            handles.progress.value = done  # type: ignore[misc]  # viser types it read-only
        drawn = bool(evolution.history) and len(evolution.references) == len(REFERENCES)
        if drawn:
            handles.chart.data = curves(evolution)
        handles.chart.visible = drawn


def begin(session: Session) -> None:
    """Start the planned run in the scenario of the arena, unless the plan has findings.

    While a campaign is under way nothing is started.
    """
    if session.campaigns.thread.active:
        return
    if not session.runs.plan.findings(session.document.rule_set):
        session.runs.start(session.scenario)


def load_best(session: Session) -> None:
    """Load the best rule set that evolution has found so far, if there is one."""
    if (best := session.evolution.best) is not None:
        session.load(best)


def pause_or_go_on(evolution: EvolutionThread) -> None:
    """The one button for both."""
    if evolution.phase is Phase.PAUSED:
        evolution.go_on()
    else:
        evolution.pause()


def add_chart(gui: viser.GuiApi) -> viser.GuiUplotHandle:
    """The fitness curves, hidden as long as there is nothing to draw."""

    def axis(label: str, size: float) -> uplot.Axis:
        return uplot.Axis(
            label=label,
            labelSize=16,
            labelFont=_FONT,
            font=_FONT,
            size=size,
            stroke="#7f8792",  # to be read on light and on dark ground
            ticks={"size": 4},
        )

    return gui.add_uplot(
        data=tuple(np.zeros(1) for _ in range(len(_CURVES) + 1)),
        series=(
            uplot.Series(label="generation"),
            *(
                uplot.Series(
                    label=label, stroke=colour, width=width, points={"show": False}, **dash
                )
                for label, colour, width, dash in _CURVES
            ),
        ),
        scales={"x": uplot.Scale(time=False)},
        axes=(axis("generation", 24), axis("objects collected", 32)),
        legend=uplot.Legend(live=False),
        aspect=1.35,
        padding=(8, 8, 0, 0),  # px: room for half of the highest number
        visible=False,
    )


def curves(evolution: EvolutionThread) -> tuple[np.ndarray, ...]:
    """Generations and the five curves over them, in the order of the legend."""
    history = evolution.history
    columns = [
        np.array([getattr(record, name) for record in history], dtype=np.float64)
        for name in ("generation", "best_so_far", "best", "mean")
    ]
    lines = [np.full(len(history), evolution.references[name]) for name in REFERENCES]
    return (*columns, *lines)


def status_html(evolution: EvolutionThread, findings: list[str]) -> str:
    """One or two lines about the run, as HTML.

    Args:
        evolution: It.
        findings: Names of the parameters of the next run that cannot be used.
    """
    if findings and not evolution.active:
        text = f"The page Evolution tells what is wrong with: {', '.join(findings)}."
    elif evolution.phase is Phase.IDLE:
        text = "Evolves foraging rules in the scenario of the arena, while the swarm goes on."
    elif evolution.phase is Phase.FAILED:
        text = f"Evolution failed: {evolution.error}"
    elif not evolution.history:
        text = "Running hand-coded and EVO 8 for comparison…"
    else:
        record = evolution.history[-1]
        text = (
            f"Generation {record.generation} of {evolution.generations}, {evolution.phase.value}: "
            f"best {record.best_so_far:.1f}, mean {record.mean:.1f}."
        )
    where = f" Kept in {evolution.directory}." if evolution.directory else ""
    return f'<div style="padding:.2em .9em;font-size:.85em">{escape(text + where)}</div>'
