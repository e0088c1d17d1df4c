"""The rule table page in a real browser: sentences, text, differences, simplifying, printing."""

import pytest

from geswarm.rules import RuleSet, format_text, load_preset, parse_text
from tests.app.rules_browser import (
    changes,
    expect,
    page_fixture,
    precondition,
    sees_edit,
    server_fixture,
    tells,
)
from tests.app.rules_server import RulesServer

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]


def open_text(page):
    page.get_by_test_id("tab-text").click()
    return page.get_by_test_id("source")


def test_rules_are_shown_in_words_when_asked(page, server):
    expect(page.get_by_test_id("rule-2-english")).to_be_hidden()
    page.get_by_test_id("in-words").click()
    expect(page.get_by_test_id("rule-2-english")).to_have_text("Sentence of rule 2.")
    page.get_by_test_id("in-words").click()
    expect(page.get_by_test_id("rule-2-english")).to_be_hidden()


def test_paper_shows_the_table_in_black_on_white_without_controls(page, server):
    server.verdict([100, 101])
    server.worth([(0, "rule", None, -40.0, -43.0, -37.0)])
    expect(page.get_by_test_id("rule-1-worth")).to_be_visible()
    open_text(page)
    page.emulate_media(media="print", color_scheme="dark")
    expect(page.get_by_test_id("rule-4-actions")).to_be_visible()
    for hidden in ("verdict", "tab-text", "source", "save", "rule-1-worth", "rule-1-enabled"):
        expect(page.get_by_test_id(hidden)).to_be_hidden()
    expect(page.locator("#table button:visible:not(.word, .truth)")).to_have_count(0)
    style = page.evaluate(
        """() => {
            const { color, fontFamily } = getComputedStyle(document.querySelector(".word"));
            return [color, fontFamily, getComputedStyle(document.body).backgroundColor];
        }"""
    )
    assert style[0] == "rgb(0, 0, 0)"
    assert "serif" in style[1]
    assert style[2] == "rgb(255, 255, 255)"


def test_errors_are_shown_at_their_line_while_typing(page, server):
    source = open_text(page)
    assert source.input_value() == format_text(load_preset("evo8"))
    expect(page.get_by_test_id("apply-text")).to_be_disabled()
    source.fill("rule\n  if ON_NESTT == true\n  do p = 1, <b>PHOTOTAXIS</b>\n")
    findings = page.get_by_test_id("text-findings")
    expect(findings).to_contain_text("did you mean ON_NEST?")
    expect(page.get_by_test_id("text-state")).to_have_text("2 errors")
    expect(page.locator(".lines li")).to_have_count(4)
    expect(page.locator(".lines li.error")).to_have_count(2)
    expect(page.locator(".lines li").nth(1)).to_have_class("error")
    assert page.locator(".lines b, .findings b").count() == 0
    expect(page.get_by_test_id("apply-text")).to_be_disabled()
    findings.get_by_role("button", name="line 2").click()
    assert page.evaluate("getSelection().toString()") == "  if ON_NESTT == true"
    source.press("Control+Enter")
    source.fill("rule\n  if ON_NEST == true\n  do p = 1, PHOTOTAXIS\n")
    expect(page.get_by_test_id("text-state")).to_have_text("not applied yet")
    expect(page.get_by_test_id("apply-text")).to_be_enabled()
    assert {message["type"] for message in server.received} == {"check_text"}


def test_the_text_is_applied_and_comes_back_in_its_usual_form(page, server):
    source = open_text(page)
    text = 'name "Mine" rule while RANDOM_WALK do p=.5, PHOTOTAXIS'
    source.fill(text)
    source.press("Control+Enter")
    tells(page, server, {"type": "set_text", "text": text, "version": 1})
    expect(source).to_have_value(format_text(parse_text(text)))
    expect(page.get_by_test_id("apply-text")).to_be_disabled()
    expect(page.get_by_test_id("changed-meanwhile")).to_be_hidden()
    page.get_by_test_id("undo").click()
    expect(source).to_have_value(format_text(load_preset("evo8")))


def test_typed_text_is_not_lost_when_the_rules_change(page, server):
    source = open_text(page)
    source.fill("# half a sen")
    server.change({"do": "remove_rule", "rule": 0})
    expect(page.get_by_test_id("changed-meanwhile")).to_be_visible()
    page.keyboard.insert_text("tence")
    expect(source).to_have_value("# half a sentence")
    page.get_by_test_id("tab-table").click()
    expect(page.get_by_test_id("tab-text")).to_contain_text("edited")
    page.get_by_test_id("tab-text").click()
    expect(source).to_have_value("# half a sentence")
    page.get_by_test_id("revert-text").click()
    expect(source).to_have_value(format_text(server.document.rule_set))
    expect(page.get_by_test_id("changed-meanwhile")).to_be_hidden()
    expect(page.get_by_test_id("tab-text")).not_to_contain_text("edited")


def test_line_numbers_stand_beside_their_lines(page, server):
    source = open_text(page)
    source.fill("# " + "a long line that must be wrapped " * 8 + "\nrule")
    lines = page.locator(".lines li")
    expect(lines).to_have_count(2)
    heights = [line.bounding_box()["height"] for line in lines.all()]
    assert heights[0] > 2 * heights[1]
    editor = source.evaluate("node => node.scrollHeight - node.clientHeight")
    assert editor == 0  # the text area is as high as its mirror


def place_of(page, line, column):
    """Where a character is seen, whose places are those of what can be clicked."""
    return page.evaluate(
        """([line, column]) => {
            const shown = document.querySelectorAll(".lines li")[line - 1];
            const texts = document.createTreeWalker(shown, NodeFilter.SHOW_TEXT);
            let text = texts.nextNode();
            for (; column >= text.length; text = texts.nextNode()) column -= text.length;
            const range = new Range();
            range.setStart(text, column);
            range.setEnd(text, column + 1);
            const { left, top, width, height } = range.getBoundingClientRect();
            return [left + 0.1 * width, top + height / 2];
        }""",
        [line, column],
    )


def selected(page):
    return page.evaluate("getSelection().toString()")


@pytest.mark.parametrize("zoom", [1, 1.5])
def test_the_mouse_works_everywhere_in_the_text(page, server, zoom):
    """On lines below one that is wrapped, marked, and beyond what is in view."""
    page.evaluate("zoom => document.documentElement.style.setProperty('zoom', zoom)", zoom)
    source = open_text(page)
    long = "# " + "a long line that must be wrapped " * 8
    lines = [long, "rule", "  if ON_NESTT == true", "  do p = 1, PHOTOTAXIS", *["# more"] * 60]
    source.click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("\n".join(lines))
    expect(page.locator(".lines li.error")).to_have_count(1)

    page.mouse.wheel(0, 10_000)
    expect(page.locator(".lines li").nth(63)).to_be_in_viewport()
    page.mouse.click(*place_of(page, 60, 4))
    page.keyboard.type("!")
    assert source.input_value().split("\n")[59] == "# mo!re"
    expect(page.locator(".lines li").nth(59)).to_contain_text("!")
    page.mouse.wheel(0, -10_000)
    expect(page.locator(".lines li").first).to_be_in_viewport()
    page.mouse.dblclick(*place_of(page, 4, 14))
    assert selected(page).strip() == "PHOTOTAXIS"
    page.mouse.dblclick(*place_of(page, 3, 6))
    page.keyboard.type("ON_NEST")
    expect(page.locator(".lines li.error")).to_have_count(0)
    page.mouse.move(*place_of(page, 2, 0))
    page.mouse.down()
    page.mouse.move(*place_of(page, 4, 5), steps=5)
    page.mouse.up()
    assert selected(page) == "rule\n  if ON_NEST == true\n  do "
    expect(source).to_be_focused()
    assert {message["type"] for message in server.received} == {"check_text"}


def test_below_the_last_line_the_cursor_goes_to_the_end(page, server):
    source = open_text(page)
    source.click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("rule")
    box = source.bounding_box()
    page.get_by_test_id("tab-text").focus()
    page.mouse.click(box["x"] + 200, box["y"] + box["height"] - 20)
    page.keyboard.type(" off")
    expect(source).to_have_value("rule off")


def test_a_text_that_is_not_applied_is_there_again_after_a_reload(page, server):
    open_text(page).click()
    page.keyboard.press("Control+End")
    page.keyboard.type("# not yet appplied")
    text = page.get_by_test_id("source").input_value()
    page.reload()
    source = page.get_by_test_id("source")
    expect(source).to_have_value(text)
    expect(page.get_by_test_id("changed-meanwhile")).to_be_hidden()
    expect(page.get_by_test_id("apply-text")).to_be_enabled()
    server.change({"do": "remove_rule", "rule": 0})
    page.reload()
    expect(source).to_have_value(text)
    expect(page.get_by_test_id("changed-meanwhile")).to_be_visible()
    page.get_by_test_id("revert-text").click()
    page.reload()
    expect(page.get_by_test_id("tab-text")).to_have_text("Text")
    expect(source).to_have_value(format_text(server.document.rule_set))
    assert server.document.version == 2


def test_where_nothing_can_be_kept_the_browser_asks_before_text_is_lost(browser, server):
    page = browser.new_context().new_page()
    page.add_init_script(
        """const set = Storage.prototype.setItem;
        Storage.prototype.setItem = function (name, text) {
            if (text.length > 100) throw new DOMException("full", "QuotaExceededError");
            set.call(this, name, text);
        };"""
    )
    page.goto(server.address)
    open_text(page).click()
    page.keyboard.type("# lost?")
    asked = []
    page.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    page.reload()
    assert asked == ["beforeunload"]
    page.context.close()


def test_errors_in_the_text_go_with_it(page, server):
    source = open_text(page)
    source.click()
    page.keyboard.type("what? ")
    expect(page.get_by_test_id("text-findings")).to_contain_text("what")
    page.get_by_test_id("revert-text").click()
    expect(page.get_by_test_id("text-findings").locator("li")).to_have_count(0)
    expect(page.locator(".lines .error")).to_have_count(0)
    expect(source).to_be_focused()


def test_a_text_mended_while_the_connection_was_lost_is_checked_again(page, server):
    source = open_text(page)
    source.click()
    page.keyboard.press("Control+Home")
    page.keyboard.type("# ?\nwhat")
    expect(page.get_by_test_id("text-findings")).to_contain_text("what")
    server.stop()
    expect(page.get_by_test_id("offline")).to_be_visible()
    page.keyboard.press("Shift+Home")
    page.keyboard.press("Delete")
    with RulesServer(server.port) as again:
        expect(page.get_by_test_id("text-findings").locator("li")).to_have_count(0, timeout=20_000)
        expect(page.get_by_test_id("apply-text")).to_be_enabled()
        assert again.document.version == 1
        page.close()


def test_changes_from_the_loaded_version_are_shown_and_taken_back(page, server):
    server.change({"do": "move_rule", "rule": 3, "to": 0})
    server.change({"do": "remove_rule", "rule": 1})
    element = changes(0.2, "ANTI-PHOTOTAXIS")
    server.change({"do": "set", "rule": 2, "part": "actions", "at": 0, "element": element})
    added = precondition("HAS_OBJECT", False)
    edit = {"do": "add", "rule": 1, "part": "preconditions", "at": 1, "element": added}
    server.change(edit)
    server.change({"do": "add_rule", "at": 3, "rule": {"comment": "<i>new</i>"}})
    expect(page.get_by_test_id("tab-changes")).to_have_text("Changes5")
    page.get_by_test_id("tab-changes").click()
    expect(page.get_by_test_id("change-4-1")).to_contain_text("moved, was R4")
    expect(page.get_by_test_id("change-1-0").locator("del").first).to_contain_text("The switch")
    expect(page.get_by_test_id("change-2-2").locator(".added")).to_have_text(
        "+ HAS_OBJECT == false"
    )
    changed = page.get_by_test_id("change-3-3").locator(".chip.changed")
    expect(changed.locator("del")).to_have_text("0.1")
    expect(changed.locator("ins")).to_have_text("0.2")
    expect(page.get_by_test_id("change-0-4").locator("ins")).to_have_text("<i>new</i>")
    page.get_by_test_id("back-to-loaded").click()
    expect(page.get_by_test_id("changes-title")).to_have_text("No change since EVO 8 was loaded")
    expect(page.get_by_test_id("back-to-loaded")).to_be_hidden()
    assert server.document.rule_set == load_preset("evo8")
    page.get_by_test_id("undo").click()
    expect(page.get_by_test_id("change-0-4")).to_be_visible()


def test_an_added_rule_does_not_make_the_others_look_moved(page, server):
    server.change({"do": "add_rule", "at": 0, "rule": {"comment": "first"}})
    expect(page.get_by_test_id("tab-changes")).to_have_text("Changes1")
    page.get_by_test_id("tab-changes").click()
    expect(page.locator(".change.same")).to_have_count(4)
    expect(page.locator(".change.moved")).to_have_count(0)


def test_simpler_rules_are_shown_before_they_are_taken(page, server):
    expect(page.get_by_test_id("simplify")).to_be_hidden()
    server.simpler = 3
    server.push(server.rules())
    server.push(server.simplified())  # asked for by another page
    page.get_by_test_id("simplify").click()
    expect(page.get_by_test_id("simplified-removed")).to_have_text("rule 4")
    expect(page.get_by_test_id("simplified-text")).to_contain_text("do p = 0.1, ANTI-PHOTOTAXIS")
    page.get_by_test_id("leave-simplified").click()
    expect(page.get_by_test_id("simplified")).to_be_hidden()
    assert server.document.version == 1
    page.get_by_test_id("simplify").click()
    page.get_by_test_id("take-simplified").click()
    expect(page.get_by_test_id("rule-4")).to_have_count(0)
    expect(page.get_by_test_id("simplify")).to_be_hidden()
    assert server.received[-1] == {"type": "take_simplified", "version": 1}


def test_what_was_simplified_cannot_be_taken_once_the_rules_have_changed(page, server):
    server.simpler = 3
    server.push(server.rules())
    page.get_by_test_id("simplify").click()
    expect(page.get_by_test_id("simplified")).to_be_visible()
    expect(page.get_by_test_id("take-simplified")).to_be_enabled()
    server.change({"do": "remove_rule", "rule": 0})
    expect(page.get_by_test_id("take-simplified")).to_be_disabled()
    expect(page.get_by_test_id("simplified")).to_contain_text("changed meanwhile")


def test_hints_wait_until_they_are_asked_for(page, server):
    server.show(RuleSet(load_preset("evo8").rules[:1]))
    message = server.rules()
    hint = {"rule": 1, "element": "behaviour 1", "message": "has no effect", "severity": "hint"}
    server.push({**message, "findings": [hint]})
    expect(page.get_by_test_id("rule-1-hints")).to_have_text("1")
    expect(page.get_by_test_id("rule-1-behaviour-1")).to_have_class("chip behaviour lit has-hint")
    expect(page.get_by_test_id("rule-1")).not_to_contain_text("has no effect")
    page.get_by_test_id("rule-1-hints").click()
    expect(page.get_by_test_id("rule-1")).to_contain_text("behaviour 1: has no effect")
    page.get_by_test_id("rule-1-duplicate").click()
    sees_edit(page, server, {"do": "duplicate_rule", "rule": 0})
