"""The rule table page in a real browser: files, lost connections, findings and live figures."""

import pytest

from geswarm.exports import EXPORTS
from geswarm.rules import Rule, RuleSet, load_preset, parse_yaml
from tests.app.rules_browser import (
    choose,
    expect,
    page_fixture,
    precondition,
    sees_edit,
    server_fixture,
)

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]


def test_a_preset_and_a_file_are_loaded(page, server):
    choose(page, "load", "hand-coded")
    expect(page.get_by_test_id("name")).to_have_value("Hand-coded")
    text = "schema: 1\nname: Mine\nrules:\n- comment: go\n  do:\n  - p = 1, PHOTOTAXIS\n"
    file = {"name": "mine.yaml", "mimeType": "text/yaml", "buffer": text.encode()}
    page.get_by_test_id("file").set_input_files(file)
    expect(page.get_by_test_id("name")).to_have_value("Mine")
    expect(page.get_by_test_id("rule-2")).to_have_count(0)


@pytest.mark.parametrize("form", ["yaml", "text", "json"])
def test_every_form_that_carries_rules_is_loaded(page, server, form):
    """The file dialog offers it, too."""
    suffix = {"text": ".rules"}.get(form, f".{form}")
    chooser = page.get_by_test_id("file")
    assert suffix in chooser.get_attribute("accept").split(",")
    text = EXPORTS[form](load_preset("evolved"))
    file = {"name": f"mine{suffix}", "mimeType": "text/plain", "buffer": text.encode()}
    chooser.set_input_files(file)
    expect(page.get_by_test_id("name")).to_have_value("Evolved")
    assert server.document.rule_set.rules == load_preset("evolved").rules


def test_a_failed_load_shows_every_reason_until_dismissed(page, server):
    text = "schema: 1\nrules:\n- do:\n  - p = 1, PHOTOTAXI\n- do:\n  - p = 1, <img src=x>\n"
    file = {"name": "bad.yaml", "mimeType": "text/yaml", "buffer": text.encode()}
    page.get_by_test_id("file").set_input_files(file)
    notice = page.get_by_test_id("notice-error")
    expect(notice).to_contain_text("PHOTOTAXIS?")
    expect(notice).to_contain_text("<img src=x>")
    expect(page.get_by_test_id("name")).to_have_value("EVO 8")
    page.get_by_test_id("dismiss").click()
    expect(notice).to_have_count(0)


def test_a_file_that_is_too_long_is_refused_on_the_spot(page, server):
    file = {"name": "big.yaml", "mimeType": "text/yaml", "buffer": b"#" * 200_001}
    page.get_by_test_id("file").set_input_files(file)
    expect(page.get_by_test_id("notice-error")).to_contain_text("big.yaml")
    assert server.received == []


def load(page, name, data):
    page.get_by_test_id("load").click()
    with page.expect_file_chooser() as chooser:
        page.get_by_test_id("choice-file").click()
    chooser.value.set_files({"name": name, "mimeType": "text/plain", "buffer": data})


NAMED = 'name "Förder"\nrule do p = 0.1, PHOTOTAXIS\n'


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (NAMED.encode("latin-1"), "not UTF-8 at byte 7."),
        (b"\xef\xbb\xbf" + NAMED.encode("latin-1"), "not UTF-8 at byte 10."),
        (b"# \xef\xbf\xbd \xe2\x82", "not UTF-8 at byte 6."),
        (NAMED.encode("utf-16"), "UTF-16, expected UTF-8."),
        (NAMED.encode("utf-16-be"), "UTF-16, expected UTF-8."),
    ],
)
def test_a_file_that_is_not_utf_8_is_refused(page, server, data, reason):
    load(page, "notepad.rules", data)
    expect(page.get_by_test_id("notice-error")).to_have_text(f"notepad.rules: {reason}")
    assert server.received == []


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_a_file_of_any_editor_is_loaded(page, server, mark, line_end):
    load(page, "notepad.rules", (mark + NAMED.replace("\n", line_end)).encode())
    expect(page.get_by_test_id("name")).to_have_value("Förder")
    expect(page.get_by_test_id("rule-2")).to_have_count(0)


def test_a_misspelt_key_is_refused(page, server):
    load(page, "mine.json", b'{"rules": [{"precondition": [], "actions": []}]}')
    expect(page.get_by_test_id("notice-error")).to_contain_text("did you mean preconditions?")
    expect(page.get_by_test_id("name")).to_have_value("EVO 8")


def test_saving_downloads_the_rules(page, server):
    with page.expect_download() as event:
        page.get_by_test_id("save").click()
    assert event.value.suggested_filename == "evo8.yaml"
    with open(event.value.path(), encoding="utf-8") as file:  # noqa: PTH123
        assert parse_yaml(file.read()) == load_preset("evo8")


def test_typing_is_not_lost_when_messages_arrive(page, server):
    comment = page.get_by_test_id("rule-2-comment")
    comment.fill("half a sen")
    comment.press("ArrowLeft")
    server.change({"do": "set_enabled", "rule": 1, "enabled": False})
    server.change({"do": "remove_rule", "rule": 0})
    server.live(1.0, [1, 2, 3])
    expect(page.get_by_test_id("rule-3")).to_be_visible()
    expect(page.get_by_test_id("rule-4")).to_have_count(0)
    typed = page.get_by_test_id("rule-1-comment")
    expect(typed).to_be_focused()
    page.keyboard.insert_text("te")
    expect(typed).to_have_value("half a seten")
    typed.press("Enter")
    sees_edit(page, server, {"do": "set_comment", "rule": 0, "comment": "half a seten"})


def test_markup_is_shown_as_text(page, server):
    nasty = "<script>document.title='x'</script><b onclick=1>bold</b>"
    comment = page.get_by_test_id("rule-1-comment")
    comment.fill(nasty)
    comment.press("Enter")
    expect(page.get_by_test_id("undo")).to_be_enabled()
    server.show(RuleSet((Rule(comment=nasty, behaviours=(nasty,)),), name=nasty))
    expect(page.get_by_test_id("name")).to_have_value(nasty)
    expect(comment).to_have_value(nasty)
    expect(page.get_by_test_id("rule-1-behaviour-1")).to_have_text(nasty)
    server.push({"type": "notice", "level": "error", "text": nasty})
    expect(page.get_by_test_id("notice-error")).to_have_text(nasty)
    assert page.locator("b[onclick], body script").count() == 0


def test_where_evolved_rules_come_from_is_shown(page, server):
    message = server.rules()
    origin = {"preset": None, "run": "runs/7", "generation": 30, "fitness": 143.333}
    message["rule_set"] = {**message["rule_set"], "origin": origin}
    server.push(message)
    expect(page.get_by_test_id("origin")).to_have_text("run runs/7 · generation 30 · fitness 143.3")


def test_findings_are_shown_at_their_element(page, server):
    element = precondition("ON_NEST", False)
    edit = {"do": "add", "rule": 1, "part": "preconditions", "at": 1, "element": element}
    server.change(edit)
    expect(page.get_by_test_id("rule-2")).to_contain_text("contradicts precondition 1")
    expect(page.get_by_test_id("rule-2-precondition-2")).to_have_class(
        "chip precondition has-warning"
    )
    server.change({"do": "remove", "rule": 1, "part": "preconditions", "at": 1})
    expect(page.get_by_test_id("rule-2")).not_to_contain_text("contradicts")
    server.show(RuleSet())
    expect(page.get_by_text("robots only walk")).to_be_visible()


def test_findings_do_not_flicker_while_new_ones_are_awaited(page, server):
    message = server.rules()
    rules = message["rule_set"]["rules"]
    places = [(1, "of rule 1"), (2, "of rule 2"), (None, "of all")]
    found = [
        {"rule": rule, "element": "", "message": text, "severity": "warning"}
        for rule, text in places
    ]
    server.push({**message, "findings": found, "simpler": 2})
    expect(page.get_by_test_id("rule-2")).to_contain_text("of rule 2")
    swapped = {**message["rule_set"], "rules": [rules[1], rules[0], *rules[2:]]}
    later = {**message, "rule_set": swapped, "findings": [], "version": 2}
    del later["simpler"]
    server.push(later)
    expect(page.get_by_test_id("rule-1")).to_contain_text("of rule 2")
    expect(page.get_by_test_id("rule-2")).to_contain_text("of rule 1")
    expect(page.get_by_text("of all")).to_be_visible()
    expect(page.get_by_test_id("simplify")).to_have_text("Simplify (−2)")
    server.push({**later, "simpler": 0})
    expect(page.get_by_test_id("rule-1")).not_to_contain_text("of rule 2")
    expect(page.get_by_text("of all")).to_have_count(0)
    expect(page.get_by_test_id("simplify")).to_be_hidden()


def test_rules_that_fire_glow_and_rates_are_per_robot_and_minute(page, server):
    server.live(0.0, [0, 0, 0, 0])
    server.live(15.0, [0, 4, 40, 600])
    expect(page.locator(".fired")).to_have_count(3)
    expect(page.get_by_test_id("rule-2-rate")).to_have_text("4.0/min")
    expect(page.get_by_test_id("rule-4-rate")).to_have_text("600/min")
    expect(page.get_by_test_id("rule-1-rate")).to_have_text("0.0/min")
    expect(page.get_by_test_id("rule-1")).to_have_class("rule")
    expect(page.get_by_test_id("live-PHOTOTAXIS")).to_have_text("2")
    expect(page.get_by_test_id("time")).to_have_text("15.0 s")
    server.live(15.1, [0, 4, 41, 604])
    expect(page.get_by_test_id("rule-2")).to_have_class("rule")
    # Then the swarm is paused: no more messages.
    expect(page.get_by_test_id("rule-4")).to_have_class("rule")
    expect(page.get_by_test_id("rule-4-rate")).to_have_text("600/min")


def test_rates_forget_what_lies_before_a_reset_and_over_a_minute_back(page, server):
    server.live(100.0, [1000, 0, 0, 0])
    for second in range(101, 201):
        server.live(float(second), [1000 + 4 * (second - 100), 0, 0, 0])
    expect(page.get_by_test_id("rule-1-rate")).to_have_text("60/min")
    server.live(0.0, [0, 0, 0, 0])
    expect(page.get_by_test_id("rule-1-rate")).to_have_text("")
    server.live(30.0, [2, 0, 0, 0])
    expect(page.get_by_test_id("rule-1-rate")).to_have_text("1.0/min")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_theme_can_be_forced(browser, server, theme):
    other = {"light": "dark", "dark": "light"}[theme]
    page = browser.new_page(color_scheme=other)
    page.goto(f"{server.address}?theme={theme}")
    expect(page.get_by_test_id("rule-1")).to_be_visible()
    red = page.evaluate("getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0]")
    assert (int(red) > 128) == (theme == "light")
    page.close()


def test_until_the_rules_come_nothing_can_be_clicked(browser, server):
    page = browser.new_context().new_page()
    page.route_web_socket("**", lambda socket: None)  # a server that says nothing
    page.goto(server.address)
    expect(page.locator("body")).to_have_class("waiting")
    expect(page.get_by_test_id("add-rule")).to_be_hidden()
    expect(page.get_by_test_id("name")).to_be_hidden()
    page.context.close()
