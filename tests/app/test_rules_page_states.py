"""The States tab of the rule table page in a real browser."""

import pytest

from geswarm.rules import Rule, RuleSet, load_preset, parse_text
from tests.app.rules_browser import expect, page_fixture, server_fixture
from tests.exports.test_exports import CROWDED

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]

EVO8 = load_preset("evo8")
TRANSITIONS = 13
NOTHING = [0] * TRANSITIONS


@pytest.fixture(name="states")
def states_fixture(page, server):
    """The page with the tab open."""
    server.states()
    page.get_by_test_id("tab-states").click()
    expect(page.get_by_test_id("machine").locator("svg")).to_be_visible()
    return page


def taken(*which):
    return [int(at in which) for at in range(TRANSITIONS)]


def test_states_fill_with_robots_and_transitions_light_up(states, server):
    server.activity(1.0, [1, 0, 3], NOTHING)
    expect(states.get_by_test_id("state-0")).to_contain_text("1 robot")
    expect(states.get_by_test_id("state-2")).to_contain_text("3 robots")
    expect(states.get_by_test_id("state-2")).to_have_attribute(
        "aria-label", "RANDOM_WALK: 3 robots"
    )
    expect(states.get_by_test_id("machine-details")).to_contain_text("3 of 4 robots")
    fill = states.get_by_test_id("state-2").locator(".fill")
    assert fill.evaluate("node => node.style.transform") == "scaleX(0.75)"
    expect(states.locator(".machine .arrow.taken")).to_have_count(0)
    server.activity(1.1, [2, 0, 2], taken(6))
    expect(states.locator(".machine .arrow.taken")).to_have_attribute("data-testid", "arrow-1-0")
    expect(states.locator(".transition.taken")).to_have_attribute("data-testid", "transition-6")
    server.activity(1.2, [2, 0, 2], taken(6))
    expect(states.locator("#states .taken")).to_have_count(0)


def test_robots_left_in_no_state_are_told_of(states, server):
    server.activity(1.0, [1, 0, 1], NOTHING)
    expect(states.get_by_text("2 of 4 robots in none of these states")).to_be_visible()
    server.activity(1.1, [2, 1, 1], NOTHING)
    expect(states.locator(".elsewhere")).to_be_hidden()


def test_a_transition_leads_to_the_rules_behind_it(states, server):
    states.get_by_test_id("transition-2").click()
    expect(states.get_by_test_id("machine-title")).to_have_text("PHOTOTAXIS→ANTI-PHOTOTAXIS")
    row = states.get_by_test_id("way-2")
    expect(row).to_have_class("way chosen")
    expect(row).to_contain_text("when ON_NEST and HAS_OBJECT")
    expect(row).to_contain_text("p = 0.095855, 1 s")
    expect(states.locator(".rule.behind")).to_have_count(2)
    states.get_by_test_id("tab-table").click()
    expect(states.get_by_test_id("rule-4")).to_have_class("rule behind")
    expect(states.get_by_test_id("rule-3")).to_be_in_viewport()
    note = states.get_by_test_id("behind-note")
    expect(note).to_have_text("Behind PHOTOTAXIS → ANTI-PHOTOTAXIS, ON_NEST and HAS_OBJECT")
    note.get_by_role("button").click()
    expect(states.locator(".rule.behind")).to_have_count(0)
    expect(note).to_be_hidden()


def test_a_rule_of_a_transition_is_opened_in_the_table(states, server):
    states.get_by_test_id("transition-3").press("Enter")
    expect(states.get_by_test_id("way-3")).to_contain_text("drop the object")
    states.get_by_test_id("way-3-rule-4").click()
    expect(states.get_by_test_id("rule-4-enabled")).to_be_focused()
    expect(states.get_by_test_id("rule-4")).to_be_in_viewport()
    expect(states.locator(".rule.behind")).to_have_count(4)


def test_a_state_tells_what_it_means_and_what_leads_away(states, server):
    details = states.get_by_test_id("machine-details")
    expect(details).to_contain_text("walking at random. Robots start here.")
    states.get_by_test_id("state-0").press(" ")
    expect(details).to_contain_text("Robots in it are going to the light.")
    expect(details.get_by_role("listitem")).to_have_count(6)
    server.activity(0.0, [4, 0, 0], NOTHING)
    server.activity(30.0, [4, 0, 0], taken(4))
    expect(states.get_by_test_id("way-4")).to_contain_text("0.5/min")


def test_new_rules_are_drawn_and_what_was_looked_at_stays(states, server):
    states.get_by_test_id("transition-9").click()
    title = states.get_by_test_id("machine-title")
    expect(title).to_have_text("RANDOM_WALK→PHOTOTAXIS")
    server.show(load_preset("hand-coded"))
    server.states()
    expect(states.locator(".transition")).to_have_count(7)
    expect(title).to_have_text("RANDOM_WALK→PHOTOTAXIS")
    server.show(parse_text("rule while RANDOM_WALK do p = 0.1, ANTI-PHOTOTAXIS"))
    server.states()
    expect(title).to_have_text("RANDOM_WALK")
    server.show(RuleSet())
    server.states()
    expect(states.get_by_test_id("machine-details")).to_contain_text("Nothing leads away.")


def test_the_labels_stay_at_the_arrows_when_a_probability_is_changed(states, server):
    def places():
        states.get_by_test_id("tab-states").click()
        boxes = states.locator(".machine :is(.state .body, .paper)").all()
        return [[box.get_attribute(name) for name in ("x", "y", "width")] for box in boxes]

    def change(testid, p):
        states.get_by_test_id("tab-table").click()
        states.get_by_test_id(testid).dblclick()
        states.keyboard.type(p)
        states.keyboard.press("Enter")
        expect(states.get_by_test_id(testid)).not_to_have_attribute("data-draft", "")
        server.states()

    before = places()
    change("rule-1-action-1-p", "0.123")
    expect(states.get_by_test_id("transition-4")).to_contain_text("p = 0.123")
    assert places() == before
    change("rule-2-action-1-p", "0.05")
    expect(states.locator(".transition")).to_have_count(14)


def test_many_transitions_are_told_at_their_arrows(states, server):
    server.show(CROWDED)
    server.states()
    expect(states.locator(".state")).to_have_count(6)
    expect(states.locator(".transition")).to_have_count(0)
    arrow = states.locator(".machine .arrow").first
    arrow.press("Enter")
    expect(arrow).to_have_class("arrow chosen")
    count = len((arrow.get_attribute("data-transitions")).split())
    expect(states.get_by_test_id("machine-details").get_by_role("listitem")).to_have_count(count)


def test_markup_in_names_and_comments_stays_out_of_the_picture(states, server):
    nasty = "</title><script>document.title = 'x'</script><a href='javascript:0'>"
    server.show(RuleSet((Rule(comment=nasty, actions=EVO8.rules[0].actions),), name=nasty))
    server.states()
    expect(states.locator(".state")).to_have_count(1)
    assert states.locator("#states script, #states a").count() == 0
    assert states.title() != "x"


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_text_stands_out_from_its_ground(browser, server, theme):
    page = browser.new_page()
    page.goto(f"{server.address}?theme={theme}")
    expect(page.get_by_test_id("rule-1")).to_be_visible()
    server.states()
    page.get_by_test_id("tab-states").click()
    text = page.get_by_test_id("state-0").locator("text").first
    red = text.evaluate("node => Number(getComputedStyle(node).fill.match(/\\d+/)[0])")
    assert (red > 128) == (theme == "dark")
    page.close()
