"""The rule table page in a real browser: the verdict on an edit and what each piece is worth."""

import pytest

from tests.app.rules_browser import expect, page_fixture, server_fixture, tells

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]

BETTER = ("before", 4.1, 1.4, 6.8, 0.0003)
EVEN = ("evo8", 0.4, -1.9, 2.7, 0.62)
WORSE = ("hand-coded", -3.2, -5.0, -1.4, 1e-9)


def test_no_verdict_takes_no_room(page, server):
    expect(page.get_by_test_id("verdict")).to_be_hidden()
    server.verdict([], busy=True, evo8=[100, 101])
    server.live(1.0, [0, 0, 0, 0])
    expect(page.get_by_test_id("live")).to_be_visible()
    expect(page.get_by_test_id("verdict")).to_be_hidden()


def test_the_verdict_says_whether_the_edit_made_it_better(page, server):
    others = {"before": [96, 100], "evo8": [98, 104], "hand-coded": [104, 107]}
    server.verdict([101, 103, 102.9], comparisons=[EVEN, WORSE, BETTER], **others)
    expect(page.get_by_test_id("verdict-mean")).to_have_text("102.3")
    answer = page.get_by_test_id("verdict-answer")
    expect(answer).to_have_text("▲ +4.1 vs before the edit")
    expect(answer).to_have_class("answer better")
    expect(page.get_by_test_id("verdict-before-mean")).to_have_text("98.0")
    differences = {
        "before": ("▲ +4.1 [1.4, 6.8], p = 0.0003", "difference better"),
        "evo8": ("≈ +0.4 [−1.9, 2.7], p = 0.62", "difference even"),
        "hand-coded": ("▼ −3.2 [−5.0, −1.4], p < 0.0001", "difference worse"),
    }
    for role, (text, judgement) in differences.items():
        cell = page.get_by_test_id(f"verdict-{role}-difference")
        expect(cell).to_have_text(text)
        expect(cell).to_have_class(judgement)
    expect(page.get_by_test_id("verdict-current").locator("circle")).to_have_count(3)
    expect(page.get_by_test_id("verdict-before").locator("circle")).to_have_count(2)
    assert page.get_by_test_id("verdict").bounding_box()["height"] <= 112


def test_dots_of_all_samples_lie_on_one_axis(page, server):
    server.verdict([100, 80], before=[90, 70])
    dots = page.locator(".sample circle")
    expect(dots).to_have_count(4)
    x = [dot.bounding_box()["x"] for dot in dots.all()]  # of 100, 80, 90 and 70
    assert x[3] < x[1] < x[2] < x[0]
    assert x[0] - x[1] == pytest.approx(x[2] - x[3], abs=0.5)


def test_without_an_edit_the_verdict_compares_with_the_first_other(page, server):
    server.verdict([100], evo8=[100], comparisons=[("evo8", 0, 0, 0, None)])
    expect(page.get_by_test_id("verdict-answer")).to_have_text("= the same as EVO 8")
    expect(page.get_by_test_id("verdict-evo8-difference")).to_have_text("= the same")
    server.verdict([100], comparisons=[])
    expect(page.get_by_test_id("verdict-answer")).to_be_hidden()


def test_old_figures_are_dimmed_until_new_ones_arrive(page, server):
    verdict = page.get_by_test_id("verdict")
    server.verdict([100] * 50)
    expect(page.get_by_test_id("verdict-progress")).to_have_text("50 runs")
    server.change({"do": "set_comment", "rule": 0, "comment": "the same rules in other words"})
    expect(page.get_by_test_id("undo")).to_be_enabled()
    expect(verdict).to_have_class("verdict")
    server.change({"do": "set_enabled", "rule": 0, "enabled": False})
    expect(verdict).to_have_class("verdict stale")
    server.verdict([], busy=True, before=[100] * 50)
    expect(page.get_by_test_id("verdict-progress")).to_have_text("0 of 50 runs")
    expect(verdict).to_have_class("verdict stale busy")
    expect(page.get_by_test_id("verdict-mean")).to_have_text("100.0")
    server.verdict([90, 91], busy=True, before=[100] * 50)
    expect(page.get_by_test_id("verdict-progress")).to_have_text("2 of 50 runs")
    expect(verdict).to_have_class("verdict busy")
    expect(page.get_by_test_id("verdict-mean")).to_have_text("90.5")
    server.verdict([100] * 50, version=1)  # was already on its way
    expect(verdict).to_have_class("verdict stale")


def test_the_runs_can_be_folded_away(page, server):
    server.verdict([100, 101])
    page.get_by_test_id("verdict-fold").click()
    expect(page.get_by_test_id("verdict-current")).to_be_hidden()
    expect(page.get_by_test_id("verdict-mean")).to_be_visible()
    server.verdict([100, 101, 102])
    expect(page.get_by_test_id("verdict-mean")).to_have_text("101.0")
    expect(page.get_by_test_id("verdict-current")).to_be_hidden()


def test_the_header_fits_at_any_width(page, server):
    server.simpler = 12
    server.show(server.document.rule_set)
    others = {"before": [96] * 50, "evo8": [98] * 50, "hand-coded": [104] * 50}
    server.verdict(range(60, 110), comparisons=[EVEN, WORSE, BETTER], **others)
    server.worth([(0, "rule", None, -40.1, -43.0, -37.2)], busy=True, total=17)
    expect(page.get_by_test_id("worth-cancel")).to_be_visible()
    for width in (420, 590, 1280):
        page.set_viewport_size({"width": width, "height": 700})
        for node in page.locator("#header :is(button, .answer, .difference):visible").all():
            box = node.bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width
        assert page.evaluate("document.documentElement.scrollWidth") <= width


PIECES = [
    (0, "rule", None, -40.0, -43.0, -37.0),
    (0, "behaviours", 0, 4.0, 2.0, 6.0),
    (1, "preconditions", 0, -0.3, -2.0, 1.4),
    (1, "actions", 0, -20.0, -23.0, -17.0),
]


def width_of_bar(page, testid):
    return page.get_by_test_id(testid).locator("rect").bounding_box()["width"]


def test_each_piece_gets_a_bar_of_what_it_is_worth(page, server):
    page.get_by_test_id("worth-start").click()
    tells(page, server, {"type": "worth_start"})
    server.worth(PIECES[:1], busy=True, total=17)
    expect(page.get_by_test_id("worth-progress")).to_have_text("1 of 17")
    page.get_by_test_id("worth-cancel").click()
    tells(page, server, {"type": "worth_cancel"})
    server.worth(PIECES)
    expect(page.get_by_test_id("worth-cancel")).to_be_hidden()
    rule = page.get_by_test_id("rule-1-worth")
    expect(rule).to_have_class("worth needed")
    expect(rule).to_contain_text("−40.0")
    expect(page.get_by_test_id("rule-1-behaviour-1-worth")).to_have_class("worth harmful")
    expect(page.get_by_test_id("rule-2-precondition-1-worth")).to_have_class("worth idle")
    words = "Without action 1 of rule 2: −20.0 objects (worse), 95 % interval [−23.0, −17.0]"
    expect(page.get_by_test_id("rule-2-action-1-worth")).to_have_attribute("title", words)
    half = width_of_bar(page, "rule-2-action-1-worth")
    assert width_of_bar(page, "rule-1-worth") == pytest.approx(2 * half, abs=1)
    page.get_by_test_id("worth-hide").click()
    expect(page.locator(".worth")).to_have_count(0)
    expect(page.get_by_test_id("worth-start")).to_be_visible()


def test_the_legend_of_the_bars_is_shown_with_the_table_alone(page, server):
    server.worth(PIECES)
    expect(page.get_by_test_id("worth-legend")).to_be_visible()
    page.get_by_test_id("tab-changes").click()
    expect(page.get_by_test_id("worth-legend")).to_be_hidden()
    page.get_by_test_id("tab-table").click()
    expect(page.get_by_test_id("worth-legend")).to_be_visible()


@pytest.mark.parametrize("width", [470, 560, 600, 660])
def test_tabs_and_tools_do_not_overlap(page, server, width):
    page.set_viewport_size({"width": width, "height": 660})
    server.change({"do": "set_enabled", "rule": 0, "enabled": False})
    expect(page.get_by_test_id("tab-changes")).to_contain_text("1")
    page.get_by_test_id("tab-text").click()
    page.get_by_test_id("source").fill("# half a sen")
    page.get_by_test_id("tab-table").click()
    expect(page.get_by_test_id("tab-text")).to_contain_text("edited")
    buttons = page.locator(".tab-bar button:visible")
    boxes = [button.bounding_box() for button in buttons.all()]
    assert len(boxes) >= 6  # four tabs, what each piece is worth, in words
    for i, a in enumerate(boxes):
        assert a["x"] + a["width"] <= width
        for b in boxes[i + 1 :]:
            beside = a["x"] + a["width"] <= b["x"] or b["x"] + b["width"] <= a["x"]
            assert beside or abs(a["y"] - b["y"]) >= min(a["height"], b["height"])


def test_bars_go_when_the_rules_change(page, server):
    server.worth(PIECES)
    expect(page.locator(".worth")).to_have_count(4)
    page.get_by_test_id("rule-2-precondition-1-value").click()
    expect(page.locator(".worth")).to_have_count(0)
    server.worth(PIECES)
    expect(page.locator(".worth")).to_have_count(4)
    server.worth([])
    expect(page.locator(".worth")).to_have_count(0)
    expect(page.get_by_test_id("worth-legend")).to_be_hidden()
