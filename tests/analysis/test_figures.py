"""Figures show the values given, and names as they are."""

import numpy as np

from geswarm.analysis.cases import Case
from geswarm.analysis.figures import best_so_far, box_plots, sensitivity_curves
from geswarm.analysis.page import page, table_html
from geswarm.evaluation import Evaluation
from geswarm.sim import load_scenario

PAPER = load_scenario("paper")


def evaluation(*fitness):
    return Evaluation(PAPER.objective, np.array(fitness), {})


def test_best_so_far_keeps_every_step_and_the_end():
    figure = best_so_far({"seed 1": [3.0, 3.0, 5.0, 5.0, 5.0]}, {"hand-coded": 4.0})
    (line,) = figure.data
    assert list(zip(line.x, line.y, strict=True)) == [(1, 3.0), (3, 5.0), (5, 5.0)]
    assert line.line.shape == "hv"
    assert [shape.y0 for shape in figure.layout.shapes] == [4.0]
    assert [note.text for note in figure.layout.annotations] == ["hand-coded"]


def test_boxes_of_one_scenario_stand_side_by_side():
    samples = {Case("a", PAPER): evaluation(1, 2), Case("<b>", PAPER): evaluation(3, 9)}
    figure = box_plots(samples, baseline=1.5, starred=["<b>"])
    assert [(list(box.x), list(box.y)) for box in figure.data] == [
        ([0, 0], [1, 2]),
        ([1, 1], [3, 9]),
    ]
    assert list(figure.layout.xaxis.ticktext) == ["a", "&lt;b&gt;"]
    assert [(note.x, note.y, note.text) for note in figure.layout.annotations] == [(1, 9, "*")]
    assert [shape.y0 for shape in figure.layout.shapes] == [1.5]


def test_boxes_of_several_scenarios_are_grouped():
    crowd = PAPER.with_changes(name="crowd", robots=8)
    samples = {
        Case(rules, scenario): evaluation(at, at + 1)
        for at, (scenario, rules) in enumerate((s, r) for s in (PAPER, crowd) for r in "ab")
    }
    figure = box_plots(samples, label=lambda scenario: str(scenario.robots))
    assert figure.layout.boxmode == "group"
    assert list(figure.layout.xaxis.ticktext) == ["4", "8"]
    assert [(box.name, list(box.x), list(box.y)) for box in figure.data] == [
        ("a", [0, 0, 1, 1], [0, 1, 2, 3]),
        ("b", [0, 0, 1, 1], [1, 2, 3, 4]),
    ]


def test_sensitivity_has_means_bands_and_points():
    worse = PAPER.with_changes(zone_miss=0.1)
    samples = {Case("a", PAPER): evaluation(1, 3), Case("a", worse): evaluation(5, 5)}
    points = {Case("a", worse): evaluation(4, 6)}
    figure = sensitivity_curves(samples, {"a": "#102030"}, points, {"here": 0.05})
    band, line, point = figure.data
    assert list(line.x) == [0.08, 0.1]
    assert list(line.y) == [2.0, 5.0]
    assert max(band.y) == 5.0
    assert min(band.y) < 1.0
    assert (list(point.x), list(point.y)) == ([0.1], [5.0])
    assert [note.text for note in figure.layout.annotations] == ["here"]


def test_points_at_one_zone_miss_stand_apart_around_it():
    samples = {Case(name, PAPER): evaluation(1, 3) for name in ("a", "b")}
    figure = sensitivity_curves(samples, {"a": "#102030", "b": "#302010"}, samples, {})
    left, right = (trace.x[0] for trace in figure.data if trace.mode == "markers")
    assert left < PAPER.zone_miss < right
    assert left + right == 2 * PAPER.zone_miss


def test_tables_and_titles_are_escaped():
    assert '<td class="text">&lt;i&gt;</td>' in table_html(["name"], [["<i>"]])
    assert "<title>&lt;i&gt;</title>" in page("<i>", "")
