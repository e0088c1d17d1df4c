"""The rule table page in a real browser: what is typed goes where it was meant, or is offered."""

import re

import pytest

from geswarm.rules import load_preset
from tests.app.rules_browser import changes, choose, expect, page_fixture, sees_edit, server_fixture
from tests.app.rules_server import RulesServer

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]

EVO8, HAND_CODED = load_preset("evo8"), load_preset("hand-coded")
R2_GONE = {"do": "remove_rule", "rule": 1}


def type_into(page, testid, text):
    """Click behind what is there, and type."""
    page.get_by_test_id(testid).click()
    page.keyboard.press("Control+End")
    page.keyboard.type(text)


def replace_p(page, testid, text):
    page.get_by_test_id(testid).dblclick()
    page.keyboard.type(text)


def others_change(page, server, change, *arguments):
    """Somebody else does something, and the page shows it."""
    getattr(server, change)(*arguments)
    name = server.document.rule_set.name
    expect(page.get_by_test_id("name")).to_have_value(name)
    expect(page.locator("#table .rule")).to_have_count(len(server.document.rule_set.rules))


def keys_sent(server):
    return [message for message in server.received if message["type"] == "key"]


def no_rule_mentions(server, text):
    return not any(text in rule.comment for rule in server.document.rule_set.rules)


@pytest.mark.parametrize("change", [("change", R2_GONE), ("show", HAND_CODED)])
def test_what_is_typed_in_a_rule_that_somebody_else_takes_away_is_kept(page, server, change):
    type_into(page, "rule-2-comment", " half a sen")
    others_change(page, server, *change)
    page.keyboard.type("tence pox r")
    expect(page.get_by_test_id("kept")).to_contain_text("The explanation of R2 is gone")
    kept = page.get_by_test_id("kept-text")
    expect(kept).to_have_value(f"{EVO8.rules[1].comment} half a sentence pox r")
    expect(page.get_by_test_id("apply-kept")).to_be_disabled()
    page.get_by_test_id("rule-1-enabled").click()
    expect(page.get_by_test_id("rule-1-enabled")).to_have_attribute("aria-checked", "false")
    assert no_rule_mentions(server, "half a sen")
    assert keys_sent(server) == []
    page.get_by_test_id("discard-kept").click()
    expect(page.get_by_test_id("kept")).to_have_count(0)


def test_what_was_kept_is_applied_when_its_rule_is_back(page, server):
    type_into(page, "rule-2-comment", " more")
    others_change(page, server, "change", R2_GONE)
    expect(page.get_by_test_id("apply-kept")).to_be_disabled()
    server.document.undo()
    server.push(server.rules())
    page.get_by_test_id("apply-kept").click()
    edit = {"do": "set_comment", "rule": 1, "comment": f"{EVO8.rules[1].comment} more"}
    sees_edit(page, server, edit)
    expect(page.get_by_test_id("kept")).to_have_count(0)


def test_a_number_typed_in_an_action_that_somebody_else_takes_away_is_kept(page, server):
    replace_p(page, "rule-2-action-1-p", "0.2")
    server.change({"do": "remove", "rule": 1, "part": "actions", "at": 0})
    page.keyboard.type("5")
    expect(page.get_by_test_id("kept")).to_contain_text("probability of PHOTOTAXIS in R2")
    expect(page.get_by_test_id("kept-text")).to_have_value("0.25")
    page.get_by_test_id("name").click()
    assert server.document.rule_set.rules[1].actions == EVO8.rules[1].actions[1:]


def test_the_cursor_goes_to_no_neighbour(page, server):
    page.get_by_test_id("rule-2-comment").click()
    others_change(page, server, "change", R2_GONE)
    page.keyboard.type("r")
    expect(page.get_by_test_id("kept-text")).to_be_focused()
    page.get_by_test_id("discard-kept").click()
    page.get_by_test_id("rule-2-enabled").focus()
    others_change(page, server, "change", R2_GONE)
    expect(page.locator("#table :focus")).to_have_count(0)
    assert server.edits == []
    assert keys_sent(server) == []


def test_typing_goes_with_its_rule_when_others_are_moved_and_changed(page, server):
    type_into(page, "rule-2-comment", " and")
    server.change({"do": "move_rule", "rule": 1, "to": 3})
    server.change({"do": "set_enabled", "rule": 3, "enabled": False})
    expect(page.get_by_test_id("rule-4-comment")).to_be_focused()
    page.keyboard.type(" on")
    page.keyboard.press("Enter")
    comment = f"{EVO8.rules[1].comment} and on"
    sees_edit(page, server, {"do": "set_comment", "rule": 3, "comment": comment})
    expect(page.get_by_test_id("kept")).to_have_count(0)


def test_the_name_that_is_typed_is_not_given_to_other_rules(page, server):
    type_into(page, "name", " mine")
    others_change(page, server, "show", HAND_CODED)
    expect(page.get_by_test_id("kept-text")).to_have_value("EVO 8 mine")
    page.get_by_test_id("tab-table").click()
    assert server.document.rule_set.name == "Hand-coded"


def test_text_that_comes_too_late_is_a_draft_again(page, server):
    server.answering = False
    type_into(page, "rule-2-comment", " long text")
    page.keyboard.press("Enter")
    comment = f"{EVO8.rules[1].comment} long text"
    sees_edit(page, server, {"do": "set_comment", "rule": 1, "comment": comment})
    server.change({"do": "set_enabled", "rule": 1, "enabled": False})
    server.push({"type": "stale", "version": 1, "text": "too late"})
    expect(page.get_by_test_id("rule-2-comment")).to_have_value(comment)
    server.answering = True
    page.get_by_test_id("rule-2-comment").click()
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("notice-error")).to_have_count(0)
    assert server.document.rule_set.rules[1].comment == comment


@pytest.mark.parametrize("rule_set", [EVO8, HAND_CODED])
def test_edits_made_while_the_server_was_away_are_offered(page, server, rule_set):
    server.stop()
    expect(page.get_by_test_id("offline")).to_be_visible()
    replace_p(page, "rule-1-action-1-p", "0.7")
    type_into(page, "rule-2-comment", " in the dark")
    page.keyboard.press("Enter")
    page.get_by_test_id("rule-1-delete").click()
    there = rule_set is EVO8
    with RulesServer(server.port) as again:
        again.show(rule_set)
        expect(page.get_by_test_id("name")).to_have_value(rule_set.name, timeout=20_000)
        expect(page.get_by_test_id("offline")).to_be_hidden()
        p, comment = page.get_by_test_id("kept").all()
        expect(p).to_contain_text("probability of RANDOM_WALK in R1 was typed while")
        expect(comment.get_by_test_id("kept-text")).to_have_value(re.compile("in the dark$"))
        assert again.document.rule_set == rule_set
        assert again.edits == []
        for kept in (comment, p):
            apply = kept.get_by_test_id("apply-kept")
            expect(apply).to_be_enabled(enabled=there)
            (apply if there else kept.get_by_test_id("discard-kept")).click()
        expect(page.get_by_test_id("kept")).to_have_count(0)
        expect(page.get_by_test_id("rule-1-action-1-p")).to_have_value("0.7" if there else "1")
        assert no_rule_mentions(again, "in the dark") != there
        page.close()


def test_an_edit_whose_answer_was_lost_is_told_and_offered(page, server):
    server.answering = False
    type_into(page, "rule-2-comment", " unanswered")
    page.keyboard.press("Enter")
    comment = f"{EVO8.rules[1].comment} unanswered"
    sees_edit(page, server, {"do": "set_comment", "rule": 1, "comment": comment})
    server.stop()
    with RulesServer(server.port) as again:
        expect(page.get_by_test_id("kept-text")).to_have_value(comment, timeout=20_000)
        expect(page.get_by_test_id("notice-error")).to_contain_text("before the last change")
        expect(page.get_by_test_id("rule-2-comment")).to_have_value(EVO8.rules[1].comment)
        assert again.edits == []
        page.close()


def test_the_connection_is_lost_until_the_rules_are_there(page, server):
    server.stop()
    with RulesServer(server.port, greeting=False) as again:
        again.document.replace(HAND_CODED)
        for _ in range(1000):
            if again.pages:
                break
            page.wait_for_timeout(20)
        again.push({"type": "notice", "level": "info", "text": "not yet"})
        expect(page.get_by_test_id("notice-info")).to_be_visible()
        page.get_by_test_id("rule-1-delete").click()
        expect(page.get_by_test_id("offline")).to_be_visible()
        again.push(again.rules())
        expect(page.get_by_test_id("offline")).to_be_hidden()
        assert again.received == []
        page.close()


@pytest.mark.parametrize("typed", ["1.5", "often", ""])
def test_what_is_no_probability_is_not_left_behind(page, server, typed):
    field = page.get_by_test_id("rule-1-action-1-p")
    field.click()
    page.keyboard.press("Control+a")
    page.keyboard.press("Delete")
    page.keyboard.type(typed)
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("p-choices")).to_contain_text("a number from 0 to 1")
    page.keyboard.press("Tab")
    expect(page.get_by_test_id("p-choices")).to_be_hidden()
    expect(field).to_have_value("0.05")
    said = page.get_by_test_id("rule-1-action-1").get_by_test_id("refusal")
    expect(said).to_contain_text(f"“{typed}” is not taken: p is a number from 0 to 1")
    assert server.edits == []
    choose(page, "load", "hand-coded")
    expect(field).to_have_value("1")
    expect(said).to_have_count(0)
    page.get_by_test_id("undo").click()
    expect(field).to_have_value("0.05")


def test_why_a_number_was_refused_is_told_until_the_field_is_used_again(page, server):
    field = page.get_by_test_id("rule-1-action-1-p")
    replace_p(page, "rule-1-action-1-p", "2")
    page.get_by_test_id("rule-3-enabled").hover()
    page.mouse.down()
    page.mouse.move(5, 5)
    page.mouse.up()
    expect(field).to_have_value("0.05")
    expect(page.get_by_test_id("refusal")).to_be_visible()
    field.click()
    expect(page.get_by_test_id("refusal")).to_have_count(0)


def test_a_number_is_mended_with_the_slider(page, server):
    replace_p(page, "rule-1-action-1-p", "7")
    box = page.get_by_test_id("p-slider").bounding_box()
    page.mouse.click(box["x"] + box["width"] - 1, box["y"] + box["height"] / 2)
    expect(page.get_by_test_id("rule-1-action-1-p")).to_have_value("1")
    expect(page.get_by_test_id("refusal")).to_have_count(0)
    element = changes(1, "RANDOM_WALK")
    edit = {"do": "set", "rule": 0, "part": "actions", "at": 0, "element": element}
    sees_edit(page, server, edit)


def test_an_error_goes_when_something_else_is_asked_for(page, server):
    bad = {"name": "bad.yaml", "mimeType": "text/yaml", "buffer": b"rules: ["}
    long = {"name": "long.yaml", "mimeType": "text/yaml", "buffer": b"#" * 200_001}
    error = page.get_by_test_id("notice-error")
    for file in (bad, long):
        page.get_by_test_id("file").set_input_files(file)
        expect(error).to_have_count(1)
        expect(error).to_contain_text(file["name"])
    page.get_by_test_id("rule-1-enabled").click()
    expect(error).to_have_count(0)
    page.get_by_test_id("file").set_input_files(bad)
    choose(page, "load", "hand-coded")  # the error is seen nevertheless, for a while
    expect(error).to_be_visible()
    expect(error).to_have_count(0)


def test_a_text_that_is_refused_stays_typed_and_esc_ends_the_error_too(page, server):
    type_into(page, "rule-1-comment", "")
    page.keyboard.insert_text("x" * 10_000)
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("notice-error")).to_contain_text("at most 10000 characters")
    expect(page.get_by_test_id("rule-1-comment")).to_have_value(re.compile("x{10000}$"))
    page.get_by_test_id("rule-1-comment").click()
    page.keyboard.press("Escape")
    expect(page.get_by_test_id("notice-error")).to_have_count(0)
    expect(page.get_by_test_id("rule-1-comment")).to_have_value(EVO8.rules[0].comment)


def test_what_is_said_of_the_journal_goes_when_it_can_be_written_again(page, server):
    notice = {"type": "notice", "level": "error", "about": "journal"}
    server.push({**notice, "text": "lost: the disk is full"})
    expect(page.get_by_test_id("notice-error")).to_contain_text("the disk is full")
    page.get_by_test_id("rule-1-enabled").click()
    expect(page.get_by_test_id("rule-1-enabled")).to_have_attribute("aria-checked", "false")
    expect(page.get_by_test_id("notice-error")).to_contain_text("the disk is full")
    server.push({**notice, "text": ""})
    expect(page.get_by_test_id("notice-error")).to_have_count(0)


def test_findings_go_with_the_rules_that_they_are_about(page, server):
    message = server.rules()
    found = {"rule": 1, "element": "", "message": "of EVO 8", "severity": "warning"}
    server.push({**message, "findings": [found], "simpler": 1})
    expect(page.get_by_test_id("rule-1")).to_contain_text("of EVO 8")
    server.document.replace(HAND_CODED)
    server.loaded = HAND_CODED
    other = {**server.rules(), "findings": []}
    del other["simpler"]
    server.push(other)
    expect(page.get_by_test_id("name")).to_have_value("Hand-coded")
    expect(page.get_by_test_id("rule-1")).not_to_contain_text("of EVO 8")
    expect(page.get_by_test_id("simplify")).to_be_hidden()


def test_keys_that_are_typed_play_nothing(page, server):
    type_into(page, "name", "pox fr")
    type_into(page, "rule-1-comment", "pox fr")
    type_into(page, "rule-1-action-1-p", "pox fr")
    page.keyboard.press("Escape")
    page.get_by_test_id("rule-1-add-action").click()
    page.keyboard.type("poxfr")
    page.keyboard.press("Escape")
    page.get_by_test_id("tab-text").click()
    page.mouse.click(3, 400)  # beside the text
    page.keyboard.type("pox fr")
    page.get_by_test_id("tab-table").click()
    page.keyboard.press("p")
    for _ in range(200):
        if keys_sent(server):
            break
        page.wait_for_timeout(20)
    assert [message["key"] for message in keys_sent(server)] == ["P"]
