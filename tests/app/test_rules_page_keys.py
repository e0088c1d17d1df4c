"""The rule table page in a real browser, without a mouse."""

import time

import pytest

from geswarm.rules import load_preset
from tests.app.rules_browser import changes, expect, page_fixture, sees_edit, server_fixture
from tests.app.rules_server import rule_text

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]


def press(page, *keys):
    for key in keys:
        page.keyboard.press(key)


def focused(page, testid):
    expect(page.get_by_test_id(testid)).to_be_focused()


def test_arrow_keys_go_from_cell_to_cell(page, server):
    page.get_by_test_id("tab-table").focus()
    press(page, "ArrowDown")
    focused(page, "rule-1-enabled")
    press(page, "ArrowRight")
    focused(page, "rule-1-comment")
    press(page, "ArrowDown")
    focused(page, "rule-1-add-precondition")
    press(page, "ArrowDown")
    focused(page, "rule-1-behaviour-1-name")
    press(page, "ArrowDown", "Home")
    focused(page, "rule-1-action-1-p")
    press(page, "ArrowRight")
    focused(page, "rule-1-action-1-target")
    press(page, "ArrowLeft", "ArrowDown", "ArrowDown", "Home", "ArrowRight")
    focused(page, "rule-2-precondition-1-value")
    press(page, "Control+End")
    focused(page, "add-rule")
    press(page, "ArrowUp", "End")
    focused(page, "rule-4-add-action")
    press(page, "Control+Home")
    focused(page, "rule-1-enabled")
    assert server.received == []


def test_a_cell_is_edited_with_enter_and_left_with_enter_or_escape(page, server):
    page.get_by_test_id("rule-3-add-action").focus()
    press(page, "Home")
    field = page.get_by_test_id("rule-3-action-1-p")
    expect(page.get_by_test_id("p-choices")).to_be_hidden()
    press(page, "Enter")
    expect(page.get_by_test_id("p-choices")).to_be_visible()
    press(page, "ArrowUp")
    expect(field).to_have_value("1")
    press(page, "Escape")
    expect(field).to_have_value("0.1")
    expect(page.get_by_test_id("p-choices")).to_be_hidden()
    press(page, "Enter", "ArrowUp", "Enter")
    element = changes(1, "ANTI-PHOTOTAXIS")
    edit = {"do": "set", "rule": 2, "part": "actions", "at": 0, "element": element}
    sees_edit(page, server, edit)
    expect(field).to_be_focused()
    press(page, "ArrowRight")
    focused(page, "rule-3-action-1-target")
    press(page, "Enter", "ArrowDown", "ArrowDown", "ArrowUp", "Escape")
    focused(page, "rule-3-action-1-target")
    assert len(server.edits) == 1


def test_typing_into_a_cell_replaces_a_probability_and_extends_a_comment(page, server):
    page.get_by_test_id("rule-1-action-1-target").focus()
    press(page, "ArrowLeft")
    page.keyboard.type("0.3")
    press(page, "Enter")
    element = changes(0.3, "RANDOM_WALK")
    edit = {"do": "set", "rule": 0, "part": "actions", "at": 0, "element": element}
    sees_edit(page, server, edit)
    press(page, "ArrowUp", "ArrowUp", "ArrowUp")
    focused(page, "rule-1-comment")
    before = load_preset("evo8").rules[0].comment
    press(page, "Enter")
    page.keyboard.type("!")
    press(page, "ArrowLeft", "ArrowLeft", "Enter")
    sees_edit(page, server, {"do": "set_comment", "rule": 0, "comment": f"{before}!"})
    focused(page, "rule-1-comment")
    press(page, "Enter")
    page.keyboard.type("?")
    press(page, "Escape", "Escape")
    expect(page.get_by_test_id("rule-1-comment")).not_to_be_focused()
    expect(page.get_by_test_id("rule-1-comment")).to_have_value(f"{before}!")


def test_delete_removes_the_element_and_at_the_heading_the_rule(page, server):
    page.get_by_test_id("rule-2-action-2-target").focus()
    press(page, "Delete")
    sees_edit(page, server, {"do": "remove", "rule": 1, "part": "actions", "at": 1})
    focused(page, "rule-2-add-action")
    press(page, "Home")
    focused(page, "rule-2-action-1-p")
    press(page, "Delete")
    sees_edit(page, server, {"do": "remove", "rule": 1, "part": "actions", "at": 0})
    focused(page, "rule-2-add-action")
    press(page, "Delete")  # nothing there to remove
    page.get_by_test_id("rule-2-enabled").focus()
    press(page, "ArrowRight", "Delete")
    sees_edit(page, server, {"do": "remove_rule", "rule": 1})
    focused(page, "rule-2-comment")
    after = load_preset("evo8").rules[2].comment
    expect(page.get_by_test_id("rule-2-comment")).to_have_value(after)
    press(page, "Control+z")
    expect(page.get_by_test_id("rule-4")).to_be_visible()
    assert len(server.edits) == 3


def test_the_arrow_keys_still_belong_to_a_menu_and_to_what_is_typed(page, server):
    page.get_by_test_id("rule-1-add-action").focus()
    press(page, "Enter", "ArrowDown", "Enter")
    element = changes(1, "ANTI-PHOTOTAXIS")
    edit = {"do": "add", "rule": 0, "part": "actions", "at": 1, "element": element}
    sees_edit(page, server, edit)
    focused(page, "rule-1-action-2-p")
    comment = page.get_by_test_id("rule-2-comment")
    comment.click()
    press(page, "Control+End", "ArrowLeft", "ArrowUp", "ArrowDown")
    focused(page, "rule-2-comment")


def test_a_late_answer_does_not_take_the_focus_from_where_the_user_has_gone(page, server):
    server.answering = False
    page.get_by_test_id("rule-1-add-action").click()
    page.keyboard.press("Enter")
    element = changes(1, "PHOTOTAXIS")
    edit = {"do": "add", "rule": 0, "part": "actions", "at": 1, "element": element}
    sees_edit(page, server, edit)
    page.get_by_test_id("rule-2-comment").click()
    server.change(edit)
    expect(page.get_by_test_id("rule-1-action-2-p")).to_be_visible()
    focused(page, "rule-2-comment")
    page.get_by_test_id("add-rule").click()
    page.get_by_test_id("rule-3-comment").click()
    empty = {"comment": "", "enabled": True, "preconditions": [], "behaviours": [], "actions": []}
    server.change({"do": "add_rule", "at": 4, "rule": empty})
    expect(page.get_by_test_id("rule-5")).to_be_visible()
    focused(page, "rule-3-comment")


def test_rules_are_copied_and_pasted_also_between_windows(page, server):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_test_id("rule-1-enabled").focus()
    press(page, "ArrowRight", "Control+c")
    expect(page.get_by_test_id("notice-info")).to_have_text("Rule 1 copied.")
    copied = rule_text(load_preset("evo8").rules[0])
    assert page.evaluate("navigator.clipboard.readText()") == copied
    other = page.context.new_page()
    other.goto(server.address)
    other.get_by_test_id("rule-3-enabled").focus()
    press(other, "Control+v")
    sees_edit(other, server, {"do": "paste_rules", "at": 3, "text": copied})
    expect(other.get_by_test_id("rule-5")).to_be_visible()
    rules = load_preset("evo8").rules
    assert server.document.rule_set.rules == (*rules[:3], rules[0], rules[3])
    press(other, "Control+x")
    sees_edit(other, server, {"do": "remove_rule", "rule": 2})
    other.close()


def test_text_is_pasted_as_text_and_what_is_no_rule_not_at_all(page, server):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.evaluate("navigator.clipboard.writeText('just words')")
    page.get_by_test_id("rule-1-enabled").focus()
    press(page, "Control+v")
    expect(page.get_by_test_id("notice-info")).to_contain_text("holds no rule")
    page.evaluate("navigator.clipboard.writeText('rule do p = 1, PHOTOTAXIS')")
    name = page.get_by_test_id("name")
    name.fill("")
    press(page, "Control+v")
    expect(name).to_have_value("rule do p = 1, PHOTOTAXIS")
    assert server.edits == []


def test_the_keys_are_listed(page, server):
    page.get_by_test_id("rule-1-enabled").focus()
    press(page, "?")
    help_keys = page.get_by_test_id("help-keys")
    expect(help_keys).to_contain_text("Duplicate the rule")
    press(page, "Control+d", "Delete", "Escape")
    expect(help_keys).to_be_hidden()
    focused(page, "rule-1-enabled")
    page.get_by_test_id("rule-1-comment").focus()
    page.keyboard.type("?")
    expect(help_keys).to_be_hidden()
    assert server.edits == []
    page.get_by_test_id("help").click()
    expect(help_keys).to_be_visible()


def test_tabs_are_changed_with_the_arrow_keys(page, server):
    page.get_by_test_id("tab-table").focus()
    press(page, "ArrowLeft")
    focused(page, "tab-changes")
    expect(page.get_by_test_id("changes-title")).to_be_visible()
    expect(page.get_by_test_id("rule-1")).to_be_hidden()
    press(page, "ArrowRight")
    focused(page, "tab-table")
    expect(page.get_by_test_id("rule-1")).to_be_visible()


def test_the_keys_that_play_the_arena_are_passed_on(page, server):
    page.get_by_test_id("rule-1-enabled").focus()
    press(page, "p", "o", "x", "f", "r", "q")
    page.get_by_test_id("rule-1-comment").focus()
    page.keyboard.type("pox")
    press(page, "Escape")
    page.get_by_test_id("rule-1-enabled").focus()
    press(page, "Shift+P", "Control+z")  # the undo comes last
    deadline = time.monotonic() + 20
    while not any(message["type"] == "undo" for message in server.received):
        assert time.monotonic() < deadline
        page.wait_for_timeout(10)
    keys = [message["key"] for message in server.received if message["type"] == "key"]
    assert "".join(keys) == "POXFRP"
