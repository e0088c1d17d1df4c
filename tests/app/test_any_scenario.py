"""The dashboard in the words of another scenario than foraging: a real browser, mouse and keys."""

import re
import threading

import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.app.state.references import first_rules
from geswarm.rules import find_rule_set, parse_yaml
from geswarm.sim import load_scenario, vocabulary_of
from geswarm.sim.arena.geometry import corners
from tests.app.test_dashboard import PATIENCE, wait_until

sync_api = pytest.importorskip("playwright.sync_api")
expect = sync_api.expect
pytestmark = [pytest.mark.browser, pytest.mark.slow]

AAC = load_scenario("aac")
BY_HAND = first_rules(AAC)
ARGUMENT = "rule-2-precondition-1-k"


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    """A dashboard with the swarm of aac at rest."""
    monkeypatch.chdir(tmp_path)
    expect.set_options(timeout=PATIENCE)
    dashboard = open_dashboard(AAC, BY_HAND, "127.0.0.1", 0)
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()
    assert not loop.is_alive()


@pytest.fixture
def session(dashboard):
    return dashboard.session


@pytest.fixture
def open_page(dashboard, browser):
    """Opens pages of the dashboard; nothing in them may complain."""
    context = browser.new_context(viewport={"width": 1500, "height": 900}, accept_downloads=True)
    context.set_default_timeout(PATIENCE)
    complaints = []
    context.on("weberror", lambda error: complaints.append(str(error.error)))

    def open_page(path=""):
        page = context.new_page()
        page.goto(dashboard.address + path)
        return page

    yield open_page
    context.close()
    assert complaints == []


@pytest.fixture
def table(open_page):
    """The page Rules by itself, in the width that it has beside the arena."""
    page = open_page("/rules/rules.html")
    page.set_viewport_size({"width": 600, "height": 830})
    page.get_by_test_id("rule-5").wait_for()
    return page


def conditions(session, rule):
    return [str(each) for each in session.document.rule_set.rules[rule].preconditions]


def test_twenty_robots_in_the_dodecagon_and_another_scenario_and_back(
    dashboard, session, open_page
):
    page = open_page()
    page.wait_for_selector("canvas")
    rules = page.frame_locator("iframe[title='Rule table']")
    expect(rules.get_by_test_id("name")).to_have_value("AAC by hand")
    wait_until(lambda: dashboard.stage.arena.handles.robots is not None)
    assert len(dashboard.stage.arena.handles.robots.bodies.batched_positions) == 20
    assert len(corners(session.scenario.arena.outline)) == 12
    page.get_by_text("aac · 20 robots").wait_for()
    rules.get_by_test_id(ARGUMENT).click()
    rules.get_by_test_id("choice-5").click()
    wait_until(lambda: conditions(session, 1) == ["IS_CLOSE_TO(5) == false"])

    choose_scenario(page, "paper")
    expect(rules.get_by_test_id("name")).to_have_value("EVO 8")
    expect(rules.get_by_test_id("rule-2-preconditions")).to_contain_text("ON_NEST")
    expect(rules.locator(".unit")).to_have_text("objects")
    wait_until(lambda: len(dashboard.stage.arena.handles.robots.bodies.batched_positions) == 4)

    page.get_by_role("button", name=re.compile("Back to .* of the run before")).click()
    expect(rules.get_by_test_id(ARGUMENT)).to_have_text("5")
    expect(rules.locator(".unit")).to_have_text("robot-steps")
    assert session.scenario == AAC
    choose_scenario(page, "paper")
    expect(rules.get_by_test_id("name")).to_have_value("EVO 8")
    choose_scenario(page, "aac")
    expect(rules.get_by_test_id("name")).to_have_value("AAC by hand")
    expect(rules.get_by_test_id(ARGUMENT)).to_have_text("3")


def choose_scenario(page, name):
    page.get_by_label("Scenario", exact=True).first.click()
    page.get_by_role("option", name=name, exact=True).click()


def test_a_rule_is_built_from_the_palette(table, session):
    table.get_by_test_id("add-rule").click()
    table.get_by_test_id("rule-6-add-precondition").click()
    expect(table.get_by_test_id("menu")).to_contain_text("with at least 3 robots near")
    table.get_by_test_id("choice-IS_CLOSE_TO-true").click()
    table.get_by_test_id("rule-6-precondition-1-k").click()
    table.get_by_test_id("choice-2").click()
    table.get_by_test_id("rule-6-add-action").click()
    expect(table.get_by_test_id("menu")).to_contain_text("start going to other robots (gain 3)")
    table.get_by_test_id("choice-STOP").click()
    wait_until(lambda: session.world.rule_set.rules[-1].actions)
    (action,) = session.world.rule_set.rules[-1].actions
    assert (conditions(session, -1), str(action)) == (["IS_CLOSE_TO(2) == true"], "p = 1, STOP")
    expect(table.get_by_test_id("rule-6-english")).to_have_text(re.compile("close to at least 2"))


def test_the_verdict_says_what_another_argument_does_in_robot_steps(table, session):
    expect(table.get_by_test_id("verdict-progress")).to_have_text("50 runs")
    before = table.get_by_test_id("verdict-mean").inner_text()
    table.get_by_test_id(ARGUMENT).focus()
    table.keyboard.press("Enter")
    table.keyboard.press("End")  # 7
    for _ in range(2):
        table.keyboard.press("ArrowUp")
    table.keyboard.press("Enter")
    wait_until(lambda: conditions(session, 1) == ["IS_CLOSE_TO(5) == false"])
    answer = table.get_by_test_id("verdict-answer")
    expect(answer).to_have_text(re.compile(r"[▲▼≈] [+−]\d+ vs before the edit"))
    expect(table.get_by_test_id("verdict-progress")).to_have_text("50 runs")
    expect(table.get_by_test_id("verdict-mean")).not_to_have_text(before)
    expect(table.get_by_test_id("verdict-before-mean")).to_have_text(before)
    expect(table.locator(".unit")).to_have_text("robot-steps")
    expect(answer).to_have_attribute(
        "title",
        re.compile(r"^These rules make [+−]\d+ robot-steps compared with before the edit: 95 %"),
    )


def test_states_worth_and_simplify(table, session):
    table.get_by_test_id("tab-states").click()
    expect(table.get_by_test_id("machine").locator("svg g.state")).to_have_count(3)
    expect(table.get_by_test_id("machine-details")).to_contain_text("20 of 20 robots")
    table.get_by_test_id("tab-table").click()
    table.get_by_test_id("worth-start").click()
    expect(table.get_by_test_id("rule-1-worth")).to_have_class("worth needed")
    expect(table.get_by_test_id("worth-legend")).to_contain_text("(robot-steps)")
    table.get_by_test_id("simplify").click()
    table.get_by_test_id("take-simplified").click()
    wait_until(lambda: session.document.rule_set != BY_HAND)
    assert len(str(session.document.rule_set)) < len(str(BY_HAND))


def test_a_wrong_argument_in_the_text_is_told_with_what_can_be(table):
    table.get_by_test_id("tab-text").click()
    source = table.get_by_test_id("source")
    source.fill(source.input_value().replace("IS_CLOSE_TO(3)", "IS_CLOSE_TO(9)"))
    expect(table.get_by_test_id("text-findings")).to_contain_text(re.compile("IS_CLOSE_TO.*1 to 7"))
    expect(table.get_by_test_id("apply-text")).to_be_disabled()


def test_rules_are_saved_loaded_and_refused_elsewhere(table, session, tmp_path):
    table.get_by_test_id(ARGUMENT).click()
    table.get_by_test_id("choice-5").click()
    expect(table.get_by_test_id(ARGUMENT)).to_have_text("5")
    with table.expect_download() as download:
        table.get_by_test_id("save").click()
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    saved = parse_yaml(path.read_text(encoding="utf-8"), vocabulary=vocabulary_of(AAC))
    assert saved == session.document.rule_set
    table.get_by_test_id("load").click()
    table.get_by_test_id("choice-aac").click()
    expect(table.get_by_test_id(ARGUMENT)).to_have_text("3")
    table.get_by_test_id("file").set_input_files(path)
    expect(table.get_by_test_id(ARGUMENT)).to_have_text("5")

    session.post(lambda session: session.set_scenario(load_scenario("paper")))
    expect(table.get_by_test_id("name")).to_have_value("EVO 8")
    table.get_by_test_id("file").set_input_files(path)
    told = table.get_by_test_id("notice-error")
    for name in ("IS_CLOSE_TO", "ON_BLACK", "STOP"):
        expect(told).to_contain_text(name)
    expect(table.get_by_test_id("name")).to_have_value("EVO 8")


def test_presets_of_the_scenario_are_compared(open_page):
    page = open_page("/experiments/experiments.html")
    expect(page.get_by_label("AAC by hand", exact=True)).to_be_checked()
    expect(page.get_by_label("EVO 8")).to_have_count(0)
    page.get_by_test_id("runs").fill("4")
    page.get_by_test_id("runs").press("Enter")
    page.get_by_test_id("compare-start").click()
    rows = page.get_by_test_id("boxes-arena").locator(".box-row")
    expect(rows).to_have_count(2)
    expect(page.get_by_test_id("compared-title")).to_have_text(
        "on_black (robot-steps), 4 runs each, seed 0"
    )


def test_rules_evolve_by_the_objective_of_the_scenario(open_page, session):
    page = open_page("/evolution/evolution.html")
    for name, value in {"population": 6, "generations": 2, "evaluations": 1}.items():
        field = page.get_by_test_id(f"plan-{name}")
        field.fill(str(value))
        field.press("Enter")
    page.get_by_test_id("start").click()
    expect(page.get_by_test_id("status")).to_contain_text("Generation 2 of 2 · finished")
    expect(page.get_by_test_id("about")).to_contain_text("scenario aac")
    curves = page.get_by_test_id("curves")
    expect(curves).to_contain_text("on_black (robot-steps)")
    expect(curves).to_contain_text("AAC by hand")
    best = find_rule_set(str(session.evolution.directory / "best.yaml"))
    assert best.scenario == "aac"
    page.get_by_test_id("load-best").click()
    wait_until(lambda: session.world.rule_set == best.read(vocabulary_of(AAC)))
