"""The report as people open it: offline, in a browser, with rule sets of any name."""

from dataclasses import replace

import pytest

from geswarm.analysis.reproduction import Plan, claims
from geswarm.analysis.reproduction.report import files_of, report
from tests.analysis.reproduction.fabricated import WALK, fabricated

FIGURES = {
    "figure-2a": (".scatterlayer .trace", 10),
    "figure-2b": (".boxlayer path.box", 12),
    "figure-3a": (".boxlayer path.box", 9),
    "figure-3b": (".boxlayer path.box", 9),
    "figure-sensitivity": (".scatterlayer .trace", 6),
}
STROKES = "lines => lines.map(line => line.style.stroke)"
CUT = """boxes => [...document.querySelectorAll(boxes)]
    .filter(box => box.scrollWidth > box.clientWidth).map(box => box.innerText)"""
NASTY = "</script><script>alert(1)</script><b>&amp;"


def test_the_report_says_what_the_claims_say():
    results = fabricated()
    text = report(results, claims(results))
    assert "Of 14 claims of the paper, 14 hold,\n0 do not hold" in text
    results = fabricated(evolved=[20] * 10, evo8=30)
    text = report(results, claims(results))
    assert "Of 14 claims of the paper, 7 hold" in text
    assert '<span class="verdict does-not-hold">does not hold</span>' in text


def test_it_says_whether_the_sensing_of_zones_decides():
    depends, does_not = fabricated(at_zero=145), fabricated(at_zero=70)
    text = report(depends, claims(depends))
    assert "depends on how well robots sense zones" in text
    assert "They cross at 0.045" in text
    text = report(does_not, claims(does_not))
    assert "depends on how well robots sense zones" not in text
    assert "does not depend on zone_miss" in text


def test_files_are_the_same_each_time():
    results = fabricated()
    assert files_of(results) == files_of(results)


def test_history_has_every_generation_of_every_run_and_no_time():
    lines = files_of(fabricated())["data/history.csv"].splitlines()
    assert lines[0] == "rules,generation,best_so_far,best,mean,invalid,distinct"
    assert len(lines) == 1 + 10 * 3
    assert lines[1] == "seed 1,1,10,9,5,3,90"


def test_names_and_comments_are_escaped():
    nasty = replace(WALK, name=NASTY, comment=NASTY)
    results = fabricated(evolved=[100], plan=Plan(runs=1), rule_sets={"seed 1": nasty})
    text = report(results, claims(results))
    assert NASTY not in text
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in text


@pytest.mark.browser
def test_it_opens_offline_and_every_figure_is_drawn(browser, tmp_path):
    path = tmp_path / "report.html"
    nasty = replace(WALK, name=NASTY, comment=NASTY)
    results = fabricated(rule_sets={"seed 1": nasty})
    path.write_text(report(results, claims(results)), encoding="utf-8")
    context = browser.new_context(viewport={"width": 1200, "height": 800}, offline=True)
    page = context.new_page()
    complaints, requests = [], []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda message: complaints.append(message.text))
    page.on("dialog", lambda dialog: complaints.append(dialog.message))
    page.on("request", lambda request: requests.append(request.url))
    page.goto(path.as_uri())
    for name, (drawn, number) in FIGURES.items():
        assert page.locator(f"#{name} {drawn}").count() == number, name
    assert page.locator("#figure-2b .annotation").count() == 8
    assert page.locator("#claims tbody tr").count() == 14
    assert page.get_by_text(NASTY).count() == 1
    colours = page.locator("#figure-2a .scatterlayer .js-line").evaluate_all(STROKES)
    assert len(set(colours)) == 10
    for width, media in ((1200, "screen"), (700, "screen"), (566, "screen"), (688, "print")):
        page.emulate_media(media=media)
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= width, media
        boxes = "figure, .scroll" if width > 600 else "figure"  # there, tables scroll
        assert page.evaluate(CUT, boxes) == [], media
    tops = [page.locator(f"#figure-{at}").bounding_box()["y"] for at in ("2a", "2b", "3a", "3b")]
    context.close()
    assert tops[0] == tops[1] < tops[2] == tops[3]
    assert complaints == []
    assert requests == [path.as_uri()]
