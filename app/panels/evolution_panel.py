"""The panel that evolves: start and stop, fitness curves; the evolution page has all the rest."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
import viser
from viser import uplot
from viser._gui_handles import GuiProgressBarHandle

from geswarm.evaluation import shown as figure
from geswarm.ge import GenerationRecord, fall_in_words
from geswarm.rules.names import name_errors

from ..state.evolution import EvolutionThread, Phase
from ..state.runs import Runs
from ..state.session import Session

_DASHED = uplot.Series(dash=(6.0, 4.0))
_BEST = ("#0f62d6", 2.5, uplot.Series())
_CURVES = (
    ("best of generation", "#7aa7e8", 1.0, uplot.Series()),
    ("mean", "#8a8f98", 1.5, uplot.Series()),
)
_REFERENCES = ("#15803d", "#c2410c")
"""Colours of the references, of which there are at most so many."""
_FONT = "11px system-ui, sans-serif"
_WHOLE = tuple(float(size * 10**power) for power in range(6) for size in (1, 2, 5))
"""Distances between two ticks of the generations."""


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
    """Shows the run looked at and the background evolution; its buttons post commands."""

    handles: EvolutionHandles

    def __init__(self, session: Session) -> None:
        self.session = session
        self._shown: tuple[object, ...] = ()
        self._drawn: tuple[object, ...] = ()

    def build(self, gui: viser.GuiApi) -> None:
        """Make the widgets in the present container."""
        status = gui.add_html(status_html(self.session.runs, []))
        progress = gui.add_progress_bar(0.0, visible=False)
        chart = add_chart(gui)
        start = gui.add_button("Start evolution", icon=viser.Icon.DNA_2)
        pause = gui.add_button("Pause", icon=viser.Icon.PLAYER_PAUSE, visible=False)
        stop = gui.add_button("Stop", icon=viser.Icon.PLAYER_STOP, visible=False)
        load = gui.add_button(
            "Load the best",
            icon=viser.Icon.DOWNLOAD,
            disabled=True,
            hint="The best of the run above, into the table and the arena",
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
        evolution, runs, handles = self.session.evolution, self.session.runs, self.handles
        plan, rule_set = runs.plan, self.session.document.rule_set
        history, references = runs.history, runs.references
        progress = (evolution.phase, len(evolution.history), evolution.remarks)
        looked_at = (runs.shown, len(history), len(references), can_load(self.session))
        campaign = self.session.campaigns.thread.active
        shown = (*progress, *looked_at, plan, rule_set, campaign)
        if shown == self._shown:
            return
        self._shown = shown
        findings = plan.findings(self.session.scenario, rule_set)
        handles.status.content = status_html(runs, list(findings))
        handles.start.disabled = bool(findings) or campaign
        handles.start.visible = not evolution.active
        handles.pause.visible = handles.stop.visible = evolution.active
        paused = evolution.phase is Phase.PAUSED
        handles.pause.label = "Go on" if paused else "Pause"
        handles.load_best.disabled = not can_load(self.session)
        handles.progress.visible = evolution.active
        if evolution.generations:
            done = 100.0 * len(evolution.history) / evolution.generations
            handles.progress.value = done  # type: ignore[misc]  # viser types it read-only
        if history:
            drawn = (runs.reevaluated, tuple(references), runs.label)
            handles.chart.data = curves(history, references)  # first: series need their data
            if drawn != self._drawn:
                self._drawn = drawn
                handles.chart.axes = axes(runs.label)
                handles.chart.series = series(runs.reevaluated, references)
        handles.chart.visible = bool(history)


def begin(session: Session) -> None:
    """Start the planned run in the scenario of the arena, unless the plan has findings.

    While a campaign is under way nothing is started.
    """
    if session.campaigns.thread.active:
        return
    if not session.runs.plan.findings(session.scenario, session.document.rule_set):
        session.runs.start(session.scenario)


def load_best(session: Session) -> None:
    """Load the best rule set of the run looked at, if there is one that can run in the arena."""
    if can_load(session) and (best := session.runs.best) is not None:
        session.load(best)


def can_load(session: Session) -> bool:
    """There is a best rule set, and the scenario of the arena offers all that it mentions."""
    best = session.runs.best
    return best is not None and not name_errors(best, session.vocabulary)


def pause_or_go_on(evolution: EvolutionThread) -> None:
    """The one button for both."""
    if evolution.phase is Phase.PAUSED:
        evolution.go_on()
    else:
        evolution.pause()


def axes(label: str) -> tuple[uplot.Axis, uplot.Axis]:
    """Generations, and what the curves are of."""

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

    return {**axis("generation", 24), "incrs": _WHOLE}, axis(label, 48)


def add_chart(gui: viser.GuiApi) -> viser.GuiUplotHandle:
    """The fitness curves, hidden as long as there is nothing to draw."""
    return gui.add_uplot(
        data=tuple(np.zeros(1) for _ in series(False, {})),
        series=series(False, {}),
        scales={"x": uplot.Scale(time=False)},
        axes=axes(""),
        legend=uplot.Legend(live=False),
        aspect=1.35,
        padding=(8, 8, 0, 0),  # px: room for half of the highest number
        visible=False,
    )


def series(reevaluated: bool, references: Collection[str]) -> tuple[uplot.Series, ...]:
    """What the chart shows.

    Args:
        reevaluated: The best is evaluated again and again, so that its curve can fall.
        references: Their titles.
    """
    best = "best, re-evaluated" if reevaluated else "best so far"
    return (
        uplot.Series(label="generation"),
        *(
            uplot.Series(label=label, stroke=colour, width=width, points={"show": False}, **dash)
            for label, colour, width, dash in ((best, *_BEST), *_CURVES)
        ),
        *(
            uplot.Series(
                label=name,
                stroke=colour,
                width=1.5,
                points={"show": False},
                **_DASHED,
            )
            for name, colour in zip(references, _REFERENCES, strict=False)
        ),
    )


def curves(
    history: Sequence[GenerationRecord], references: Mapping[str, float]
) -> tuple[np.ndarray, ...]:
    """Generations and five curves over them, in the order of the legend, which may have fewer."""
    columns = [
        np.array([getattr(record, name) for record in history], dtype=np.float64)
        for name in ("generation", "best_so_far", "best", "mean")
    ]
    levels = [*references.values(), *(history[0].mean for _ in _REFERENCES)]
    lines = [np.full(len(history), level) for level in levels[: len(_REFERENCES)]]
    return (*columns, *lines)


def status_html(runs: Runs, findings: list[str]) -> str:
    """A few lines about the run looked at, and the one under way if that is another, as HTML.

    Args:
        runs: All of them.
        findings: Names of the parameters of the next run that cannot be used.
    """
    evolution, history, shown = runs.evolution, runs.history, runs.shown
    if findings and not evolution.active:
        text = f"The page Evolution tells what is wrong with: {', '.join(findings)}."
    elif not runs.shows_present:
        text = _opened(runs)
    elif evolution.phase is Phase.IDLE:
        text = "Evolves rules in the scenario of the arena, while the swarm goes on."
    elif evolution.phase is Phase.FAILED:
        text = f"Evolution failed: {evolution.error}"
    elif not history:
        text = "Running what evolved rules are compared with…"
    else:
        done = f"Generation {len(history)} of {evolution.generations}, {evolution.phase.value}"
        text = f"{done}: {_figures(history)}"
    where = f" Kept in {shown}." if shown else ""
    remarks = " ".join(("", *evolution.remarks)) if runs.shows_present else ""
    text += where + remarks
    return f'<div style="padding:.2em .9em;font-size:.85em">{escape(text)}</div>'


def _figures(history: Sequence[GenerationRecord]) -> str:
    record = history[-1]
    fall = fall_in_words([one.best_so_far for one in history], figure)
    best, mean = figure(record.best_so_far), figure(record.mean)
    return f"best {best}{fall and f' ({fall})'}, mean {mean}."


def _opened(runs: Runs) -> str:
    """Another run is looked at than the present or last one."""
    evolution, history = runs.evolution, runs.history
    text = "An earlier run, opened on the page Evolution"
    text += f": generation {len(history)}, {_figures(history)}" if history else "."
    if evolution.active and evolution.directory is not None:
        text += f" Meanwhile {evolution.directory.name} is {evolution.phase.value}."
    return text
