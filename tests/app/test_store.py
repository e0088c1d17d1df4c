"""The pages in a browser that blocks or forgets what they would remember."""

import json

import pytest

from tests.app.conftest import CHROMIUM_FLAGS
from tests.app.rules_browser import expect, server_fixture, tells

__all__ = ["server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]

INSTEAD = """
    for (const name of ["localStorage", "sessionStorage"]) {
      Object.defineProperty(window, name, %s);
    }
"""
THROWS = INSTEAD % '{ get() { throw new DOMException("blocked", "SecurityError"); } }'
MISSING = INSTEAD % "{ value: null }"
FULL = """
    Storage.prototype.setItem = () => { throw new DOMException("full", "QuotaExceededError"); };
"""
TWO = [{"name": "Person 1", "you": True}, {"name": "Person 2", "you": False}]


@pytest.fixture(params=[THROWS, MISSING, FULL], ids=["throws", "missing", "full"])
def page(request, browser, server):
    """The rule table in a browser that keeps nothing; no script on it may fail."""
    context = browser.new_context()
    context.add_init_script(request.param)
    page, errors = context.new_page(), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(server.address)
    yield page
    context.close()
    assert not errors


def works(page, server):
    """Tabs, the sentences and the name do what they do, until the page is loaded again."""
    expect(page.get_by_test_id("rule-4")).to_be_visible()
    page.get_by_test_id("in-words").click()
    expect(page.get_by_test_id("in-words")).to_have_attribute("aria-pressed", "true")
    page.get_by_test_id("tab-changes").click()
    expect(page.get_by_test_id("tab-changes")).to_have_attribute("aria-selected", "true")
    server.push({"type": "people", "people": TWO})
    page.get_by_test_id("people").click()
    page.keyboard.type("Ada")
    page.keyboard.press("Tab")
    tells(page, server, {"type": "name", "name": "Ada"})
    page.keyboard.press("Escape")
    page.get_by_test_id("people").click()
    expect(page.get_by_test_id("person-name")).to_have_value("Ada")


def test_the_rule_table_works_where_nothing_can_be_stored(page, server):
    works(page, server)
    page.reload()
    expect(page.get_by_test_id("rule-4")).to_be_visible()
    expect(page.get_by_test_id("tab-table")).to_have_attribute("aria-selected", "true")
    expect(page.get_by_test_id("in-words")).to_have_attribute("aria-pressed", "false")


@pytest.mark.parametrize("blocked", [False, True], ids=["kept", "all site data blocked"])
def test_what_the_browser_keeps_is_there_again(browser, chromium, server, tmp_path, blocked):
    (tmp_path / "Default").mkdir()
    settings = {"default_content_setting_values": {"cookies": 2 if blocked else 1}}
    (tmp_path / "Default" / "Preferences").write_text(json.dumps({"profile": settings}))
    context = browser.browser_type.launch_persistent_context(
        tmp_path, executable_path=chromium, args=list(CHROMIUM_FLAGS)
    )
    page = context.new_page()
    page.goto(server.address)
    works(page, server)
    page.reload()
    selected = "false" if blocked else "true"
    expect(page.get_by_test_id("rule-4")).to_be_attached()
    expect(page.get_by_test_id("tab-changes")).to_have_attribute("aria-selected", selected)
    expect(page.get_by_test_id("in-words")).to_have_attribute("aria-pressed", selected)
    context.close()
