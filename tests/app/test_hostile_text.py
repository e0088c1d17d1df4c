"""Script in every text that somebody types: nothing of it runs, in no page and no export."""

import threading
import time
from dataclasses import replace
from html.parser import HTMLParser
from xml.etree import ElementTree

import plotly.graph_objects as go
import pytest
from markdown_it import MarkdownIt  # comes with rich

from geswarm.analysis.page import figure_html, page, table_html
from geswarm.analysis.reproduction import Campaign
from geswarm.app.dashboard import open_dashboard
from geswarm.app.panels.evolution_panel import status_html
from geswarm.app.panels.inspector_panel import robot_html
from geswarm.app.panels.swarm_panel import score_html
from geswarm.app.state.evolution import EvolutionThread, Phase
from geswarm.app.state.journal import Journal, journal_directory
from geswarm.app.state.session import Session
from geswarm.evolution import EvolutionRun, RunConfig
from geswarm.exports import format_html, format_markdown, format_svg
from geswarm.ge import Settings
from geswarm.rules import RuleSet, format_yaml, parse_text
from geswarm.sim import load_scenario

IMAGE = '<img src=x onerror="top.ran=1">'
EVIL = f"{IMAGE}</title></style></script><script>top.ran=1</script><svg onload=top.ran=1>'\"--"
HARMFUL = {"img", "script", "svg", "iframe", "object", "embed"}


def evil_rules():
    (rule,) = parse_text("rule while RANDOM_WALK do p = 1, PHOTOTAXIS").rules
    return RuleSet((replace(rule, comment=EVIL),), name=EVIL, comment=EVIL)


class Tags(HTMLParser):
    """Collects what a browser would make elements of, with their attributes."""

    def __init__(self, markup):
        super().__init__()
        self.tags, self.attributes = [], []
        self.feed(markup)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += [name for name, _ in attributes]


def is_harmless(markup, allowed=()):
    found = Tags(markup)
    harmful = HARMFUL.intersection(found.tags) - set(allowed)
    return not harmful and not any(name.startswith("on") for name in found.attributes)


def test_tags_are_seen():
    assert not is_harmless(EVIL)
    assert not is_harmless("<p onclick=x>")
    assert is_harmless("<p>&lt;img&gt;</p>")


def test_exports_that_become_html():
    assert is_harmless(format_html(evil_rules()))
    assert is_harmless(MarkdownIt("commonmark").render(format_markdown(evil_rules())))


def test_pictures():
    picture = format_svg(evil_rules())
    names = {element.tag.rpartition("}")[2] for element in ElementTree.fromstring(picture).iter()}
    assert not names & {"script", "img", "foreignObject"}
    assert picture.count("<svg") == 1


def test_pages_of_reports():
    assert is_harmless(table_html([EVIL], [[EVIL]]))
    assert EVIL not in page(EVIL, "")
    figure = go.Figure(go.Bar(name=EVIL, x=[EVIL], y=[1]))
    figure.update_layout(title=EVIL, width=100)
    drawn = figure_html(figure, "figure", "caption")
    assert is_harmless(drawn, allowed=["script"])  # plotly's own
    assert "<img" not in drawn
    assert drawn.count("</script>") == Tags(drawn).tags.count("script")


@pytest.fixture
def session():
    evolution = EvolutionThread(workers=1)
    session = Session(
        load_scenario("paper").with_changes(name=EVIL, duration=50.0), evil_rules(), evolution
    )
    yield session
    session.close()


def test_widgets_of_the_dashboard(session, tmp_path):
    session.play()
    session.frame(1.0, 1.0)
    assert is_harmless(score_html(session))
    assert is_harmless(robot_html(session.world, 0, session.document.rule_set))
    session.evolution.phase, session.evolution.error = Phase.FAILED, EVIL
    session.evolution.directory = tmp_path / EVIL
    assert is_harmless(status_html(session.runs, [EVIL]))


@pytest.mark.browser
@pytest.mark.slow
def test_nothing_typed_runs_in_a_browser(browser, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    before = Journal(journal_directory())
    before.keep(evil_rules())
    deadline = time.monotonic() + 60
    while not list(journal_directory().glob("*.db")):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    before._writer.close()  # killed
    before._connection.close()
    scenario = load_scenario("paper").with_changes(name=IMAGE, duration=50.0)
    dashboard = open_dashboard(scenario, evil_rules(), "127.0.0.1", 0)
    dashboard.session.post(lambda session: session.select(0))
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    first = browser.new_context(viewport={"width": 1500, "height": 900}).new_page()
    second = browser.new_context(viewport={"width": 600, "height": 900}).new_page()
    try:
        first.set_default_timeout(60_000)
        first.goto(dashboard.address)
        second.goto(f"{dashboard.address}/rules/rules.html")
        table = first.frame_locator("iframe[title='Rule table']")
        type_everywhere(table, second, tmp_path)
        first.get_by_role("button", name="Start evolution").click()
        first.get_by_text("Generation").first.wait_for()
        for page_ in (first, second):
            page_.wait_for_timeout(1000)
            assert page_.evaluate("window.ran") is None
            for frame in page_.frames:
                assert frame.locator("img[src=x], [onerror], [onload]").count() == 0
    finally:
        first.context.close()
        second.context.close()
        dashboard.stop()
        loop.join(60)
        dashboard.close()


def type_everywhere(table, second, tmp_path):
    """Every field of the rule table, with somebody looking on."""
    for field in ("name", "rule-1-comment"):
        table.get_by_test_id(field).fill(f"{EVIL} {field}")
        table.get_by_test_id(field).press("Enter")
        second.get_by_test_id("others").wait_for()
    second.get_by_test_id("people").click()
    second.get_by_test_id("person-name").fill(IMAGE)
    second.keyboard.press("Enter")
    second.keyboard.press("Escape")
    second.get_by_test_id("rule-1-enabled").click()
    table.get_by_test_id("others").wait_for()
    table.get_by_test_id("rule-1-action-1-p").fill(EVIL)
    table.get_by_test_id("rule-1-action-1-p").press("Escape")
    files = {"<img src=x onerror=top.ran=1>.yaml": f"rules: {EVIL}", "evil.yaml": None}
    for name, text in files.items():
        (tmp_path / name).write_text(text or format_yaml(evil_rules()))
        table.get_by_test_id("file").set_input_files(tmp_path / name)
    table.get_by_test_id("notice-error").first.wait_for()
    table.get_by_test_id("tab-text").click()
    table.get_by_test_id("source").fill(f'name "{IMAGE}"\n# {EVIL}\nrule do p = 1, {IMAGE}')
    table.get_by_test_id("text-findings").locator("li").first.wait_for()
    table.get_by_test_id("tab-changes").click()
    table.get_by_test_id("tab-table").click()
    second.get_by_test_id("bring-back").click()
    second.get_by_test_id("unsaved").wait_for(state="detached")


@pytest.mark.browser
@pytest.mark.slow
def test_names_of_runs_and_campaigns_do_not_run_in_a_browser(browser, tmp_path, monkeypatch):
    """What the other pages list may come from anybody's disk."""
    monkeypatch.chdir(tmp_path)
    name = "<img src=x onerror=top.ran=1>"
    scenario = load_scenario("paper").with_changes(name=IMAGE, duration=10.0)
    run = EvolutionRun.create(
        RunConfig(scenario, Settings(population=4, generations=2, evaluations=1)),
        tmp_path / "runs" / name,
    )
    run.run()
    run.close()
    Campaign.at(tmp_path / "runs" / f"{name}-campaign", runs=1, generations=1, evaluations=2)
    for broken in ("run.db", "campaign.yaml"):
        (tmp_path / "runs" / f"{name}-{broken}").mkdir()
        (tmp_path / "runs" / f"{name}-{broken}" / broken).write_text(EVIL)
    dashboard = open_dashboard(scenario, evil_rules(), "127.0.0.1", 0)
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    context = browser.new_context(viewport={"width": 700, "height": 1500})
    try:
        pages = [context.new_page() for _ in range(2)]
        for page_, kind in zip(pages, ("evolution", "experiments"), strict=True):
            page_.set_default_timeout(60_000)
            page_.goto(f"{dashboard.address}/{kind}/{kind}.html")
        evolution, experiments = pages
        evolution.get_by_text(name).first.wait_for(state="attached")
        experiments.get_by_text(f"{name}-campaign").first.wait_for(state="attached")
        (tmp_path / f"{name}.yaml").write_text(format_yaml(evil_rules()))
        experiments.locator("input[type=file]").set_input_files(tmp_path / f"{name}.yaml")
        experiments.get_by_text(f"file {name}.yaml").first.wait_for(state="attached")
        for page_ in pages:
            assert page_.evaluate("window.ran") is None
            assert page_.locator("img[src=x], [onerror], [onload]").count() == 0
    finally:
        context.close()
        dashboard.stop()
        loop.join(60)
        dashboard.close()
