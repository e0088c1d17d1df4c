"""Figures of experiments, as plotly draws them: notebooks show them, pages embed them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from html import escape
from itertools import cycle

import numpy as np
import plotly.graph_objects as go

from geswarm.analysis.cases import Samples
from geswarm.sim import Scenario

PALETTE = (
    "#e08214", "#2f6fde", "#1b9e77", "#c2347f", "#7b57c8",
    "#8c6d31", "#4aa3c7", "#6b7785", "#a3b42e", "#d1495b",
    "#2f4b7c", "#c9a227",
)  # fmt: skip
"""Colours of series; those of the first three are told apart by the colour-blind too."""

_FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif'
_INK, _GRID = "#1b2430", "#e3e7ec"
_COLLECTED = "collected objects"
_ASIDE = 0.002  # of zone_miss, between points that would cover each other
_LEVEL_TICKS = 6  # more names than these have no room side by side


def best_so_far(
    histories: Mapping[str, Sequence[float]],
    levels: Mapping[str, float],
    colours: Mapping[str, str] | None = None,
) -> go.Figure:
    """Best fitness so far over the generations (paper, Figure 2a).

    Args:
        histories: For each run, by its name, one fitness per generation, from generation 1 on.
        levels: Horizontal lines to compare with, by name.
        colours: Of the runs, by name; by default those of `PALETTE`.

    Returns:
        A plotly figure, one line per run.
    """
    colours = _colours(histories) if colours is None else colours
    figure = _figure("generation", "fitness of the best so far")
    for name, fitness in histories.items():
        steps = [at for at, value in enumerate(fitness) if at == 0 or value != fitness[at - 1]]
        shown = sorted({*steps, len(fitness) - 1})
        figure.add_scatter(
            x=[at + 1 for at in shown],
            y=[fitness[at] for at in shown],
            name=escape(name),
            line={"shape": "hv", "color": colours[name], "width": 2},
            mode="lines",
        )
    for name, level in levels.items():
        _level(figure, level)
        figure.add_annotation(
            x=1, xref="paper", y=level, text=escape(name), showarrow=False,
            xanchor="right", yanchor="bottom", font={"size": 12}, bgcolor="rgba(255,255,255,0.8)",
        )  # fmt: skip
    return figure


def box_plots(
    samples: Samples,
    colours: Mapping[str, str] | None = None,
    label: Callable[[Scenario], str] = lambda scenario: scenario.name,
    axis: str = "",
    baseline: float | None = None,
    starred: Collection[str] = (),
) -> go.Figure:
    """Fitness of each case as a box; whiskers reach to 1.5 interquartile ranges.

    Rule sets in one scenario stand side by side (paper, Figure 2b); in several scenarios they are
    told apart by colour (Figure 3).

    Args:
        samples: What came of each case.
        colours: Of the rule sets, by name; by default those of `PALETTE`.
        label: What a scenario is called on the axis.
        axis: Title of the axis along which the boxes stand.
        baseline: Height of a dashed line to compare with.
        starred: Rule sets that get a star above their box; for one scenario only.

    Returns:
        A plotly figure, one trace per rule set.
    """
    names = list(dict.fromkeys(case.rules for case in samples))
    scenarios = list(dict.fromkeys(case.scenario for case in samples))
    alone = len(scenarios) == 1
    colours = _colours(names) if colours is None else colours
    labels = [evaluation.objective.label for evaluation in samples.values()]
    figure = _figure(axis, " / ".join(dict.fromkeys(labels)))
    for number, name in enumerate(names):
        here = [case for case in samples if case.rules == name]
        places = [number if alone else scenarios.index(case.scenario) for case in here]
        figure.add_box(
            x=np.repeat(places, [samples[case].fitness.size for case in here]).tolist(),
            y=np.concatenate([samples[case].fitness for case in here]).tolist(),
            name=escape(name),
            offsetgroup="" if alone else str(number),
            marker={"color": colours[name], "size": 4},
            line={"width": 1.5},
            boxpoints="outliers",
        )
        if name in starred:
            top = max(float(samples[case].fitness.max()) for case in here)
            star = {"text": "*", "showarrow": False, "yshift": 12, "font": {"size": 22}}
            figure.add_annotation(x=number, y=top, **star)
    ticks = names if alone else [label(scenario) for scenario in scenarios]
    figure.update_xaxes(
        tickvals=list(range(len(ticks))),
        ticktext=[escape(tick) for tick in ticks],
        tickangle=-45 if len(ticks) > _LEVEL_TICKS else 0,
        showgrid=False,
    )
    figure.update_layout(boxmode="overlay" if alone else "group", showlegend=not alone)
    if baseline is not None:
        _level(figure, baseline)
    return figure


def sensitivity_curves(
    samples: Samples,
    colours: Mapping[str, str],
    references: Samples,
    marks: Mapping[str, float],
) -> go.Figure:
    """Mean of the collected objects over `zone_miss`, with a band of one standard deviation.

    Args:
        samples: Cases whose scenarios differ in `zone_miss`.
        colours: Of the rule sets, by name.
        references: The same from another simulator, drawn as points; those of one `zone_miss` stand
            a little apart, so that their bars are told apart.
        marks: Vertical lines, by name.

    Returns:
        A plotly figure, a line and a band per rule set.
    """
    figure = _figure("zone_miss: chance per control step that zones are not perceived", _COLLECTED)
    names = list(dict.fromkeys(case.rules for case in samples))
    for number, name in enumerate(names):
        x, mean, sd = _over_zone_miss(samples, name)
        colour, group = colours[name], {"legendgroup": name}
        red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
        figure.add_scatter(
            x=[*x, *x[::-1]],
            y=[*(mean + sd), *(mean - sd)[::-1]],
            fill="toself",
            fillcolor=f"rgba({red},{green},{blue},0.15)",
            line={"width": 0},
            hoverinfo="skip",
            showlegend=False,
            **group,
        )
        line = {"color": colour, "width": 2.5}
        figure.add_scatter(x=x, y=mean, name=escape(name), mode="lines", line=line, **group)
        x, mean, sd = _over_zone_miss(references, name)
        aside = _ASIDE * (number - (len(names) - 1) / 2)
        figure.add_scatter(
            x=[at + aside for at in x],
            y=mean,
            error_y={"type": "data", "array": sd, "color": colour},
            name=f"{escape(name)}, ARGoS 3",
            mode="markers",
            marker={"color": colour, "size": 10, "symbol": "diamond-open", "line": {"width": 2}},
            **group,
        )
    for mark, at in marks.items():
        figure.add_vline(at, line={"dash": "dot", "color": _INK, "width": 1})
        figure.add_annotation(
            x=at, y=1, yref="paper", text=escape(mark), showarrow=False, xanchor="left", xshift=4
        )
    return figure


def _over_zone_miss(samples: Samples, rules: str) -> tuple[list[float], np.ndarray, np.ndarray]:
    """The values of zone_miss, and for each the mean and standard deviation of the collected."""
    here = {
        case.scenario.zone_miss: found for case, found in samples.items() if case.rules == rules
    }
    x = sorted(here)
    mean = np.array([here[at].fitness.mean() for at in x])
    return x, mean, np.array([here[at].summary()["sd"] for at in x])


def _colours(names: Iterable[str]) -> dict[str, str]:
    return dict(zip(names, cycle(PALETTE), strict=False))


def _level(figure: go.Figure, level: float) -> None:
    figure.add_hline(level, line={"dash": "dash", "color": _INK, "width": 1})


def _figure(x: str, y: str) -> go.Figure:
    figure = go.Figure()
    axis = {"gridcolor": _GRID, "linecolor": _INK, "zeroline": False, "ticks": "outside"}
    axis |= {"ticklabeloverflow": "allow", "automargin": True}
    figure.update_xaxes(title={"text": x}, **axis)
    figure.update_yaxes(title={"text": y}, rangemode="tozero", **axis)
    figure.update_layout(
        template="none",
        font={"family": _FONT, "size": 14, "color": _INK},
        width=560,
        height=400,
        margin={"l": 60, "r": 20, "t": 40, "b": 52},
        legend={"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
        paper_bgcolor="#ffffff",
        plot_bgcolor="#ffffff",
    )
    return figure
