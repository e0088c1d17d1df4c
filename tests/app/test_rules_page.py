"""The rule table page in a real browser: reading and editing, as a user does it."""

import pytest

from geswarm.rules import Rule, load_preset
from tests.app.rules_browser import (
    changes,
    choose,
    expect,
    page_fixture,
    precondition,
    sees_edit,
    server_fixture,
    sets,
    term,
)

__all__ = ["page_fixture", "server_fixture"]
pytestmark = [pytest.mark.browser, pytest.mark.slow]


def elements(page, rule, part):
    """The chips of a part as they read, without the buttons' icons."""
    return page.get_by_test_id(f"rule-{rule}-{part}").locator(".chip").all()


def reading(page, rule, part):
    texts = []
    for chip in elements(page, rule, part):
        p = chip.locator(".p-input")
        value = f"p = {p.input_value()} " if p.count() else ""
        texts.append(
            value + " ".join(filter(None, chip.locator(".word, .truth").all_inner_texts()))
        )
    return texts


def test_evo8_reads_as_in_the_paper(page, server):
    evo8 = load_preset("evo8")
    expect(page.get_by_test_id("name")).to_have_value("EVO 8")
    expect(page.get_by_test_id("origin")).to_have_text("preset EVO 8")
    for number, rule in enumerate(evo8.rules, start=1):
        expect(page.get_by_test_id(f"rule-{number}-comment")).to_have_value(rule.comment)
    expect(page.get_by_test_id("rule-1-preconditions")).to_contain_text("ε always")
    assert reading(page, 1, "behaviours") == ["PHOTOTAXIS"]
    assert reading(page, 1, "actions") == ["p = 0.05 RANDOM_WALK"]
    assert reading(page, 2, "preconditions") == ["ON_NEST true"]
    assert reading(page, 2, "behaviours") == ["RANDOM_WALK", "ANTI-PHOTOTAXIS"]
    assert reading(page, 2, "actions") == ["p = 1 PHOTOTAXIS", "p = 1 DROP_OBJECT true"]
    assert reading(page, 4, "actions") == ["p = 1 PHOTOTAXIS", "p = 0.001 ANTI-PHOTOTAXIS"]
    assert server.received == []


def test_the_hand_coded_rules_show_an_empty_behaviour_list(page, server):
    server.show(load_preset("hand-coded"))
    expect(page.get_by_test_id("rule-1-behaviours")).to_contain_text("ε any behaviour")


def test_the_four_rules_fit_beside_the_arena(page, server):
    server.live(1.0, [0, 0, 0, 0])
    expect(page.get_by_test_id("live")).to_be_visible()
    box = page.get_by_test_id("rule-4").bounding_box()
    assert box["y"] + box["height"] <= 620
    for width in (1280, 560, 420):
        page.set_viewport_size({"width": width, "height": 660})
        assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize(("typed", "p"), [("0.2", 0.2), (".3", 0.3), ("0,4", 0.4), ("5 %", 0.05)])
def test_a_typed_probability_is_committed_by_enter(page, server, typed, p):
    field = page.get_by_test_id("rule-3-action-1-p")
    field.fill(typed)
    field.press("Enter")
    element = changes(p, "ANTI-PHOTOTAXIS")
    sees_edit(
        page, server, {"do": "set", "rule": 2, "part": "actions", "at": 0, "element": element}
    )
    assert server.received[0]["version"] == 1
    field.blur()
    expect(field).to_have_value(str(p))
    assert len(server.edits) == 1


def test_leaving_the_field_commits_and_escape_reverts(page, server):
    field = page.get_by_test_id("rule-1-action-1-p")
    field.fill("0.5")
    field.press("Escape")
    expect(field).to_have_value("0.05")
    assert server.edits == []
    field.fill("0.5")
    page.get_by_test_id("name").click()
    expect(page.get_by_test_id("undo")).to_be_enabled()
    assert server.document.rule_set.rules[0].actions[0].p == 0.5


def test_probabilities_are_chosen_from_the_vocabulary(page, server):
    field = page.get_by_test_id("rule-1-action-1-p")
    field.click()
    expect(page.get_by_test_id("p-choices")).to_contain_text("20 control steps, 2 s")
    page.get_by_test_id("p-choice-0.001").click()
    expect(field).to_have_value("0.001")
    expect(field).to_be_focused()
    sees_edit(page, server, page_set(0, "actions", 0, changes(0.001, "RANDOM_WALK")))
    field.press("ArrowUp")
    expect(field).to_have_value("0.005")
    field.press("Enter")
    expect(page.get_by_test_id("p-choices")).to_be_hidden()
    sees_edit(page, server, page_set(0, "actions", 0, changes(0.005, "RANDOM_WALK")))


def page_set(rule, part, at, element):
    return {"do": "set", "rule": rule, "part": part, "at": at, "element": element}


def test_the_slider_commits_once_when_it_is_let_go(page, server):
    field = page.get_by_test_id("rule-1-action-1-p")
    field.click()
    box = page.get_by_test_id("p-slider").bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + box["width"] / 2, middle)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 3, middle, steps=4)
    assert server.edits == []
    page.mouse.move(box["x"] + box["width"] - 1, middle, steps=4)
    expect(field).to_have_value("1")
    page.mouse.up()
    sees_edit(page, server, page_set(0, "actions", 0, changes(1, "RANDOM_WALK")))
    assert len(server.edits) == 1
    expect(page.get_by_test_id("p-choices")).to_be_visible()
    page.get_by_test_id("name").click()
    expect(page.get_by_test_id("p-choices")).to_be_hidden()


def test_a_precondition_is_toggled_renamed_and_removed(page, server):
    page.get_by_test_id("rule-2-precondition-1-value").click()
    sees_edit(page, server, page_set(1, "preconditions", 0, precondition("ON_NEST", False)))
    expect(page.get_by_test_id("rule-2-precondition-1-value")).to_have_text("false")
    choose(page, "rule-2-precondition-1-name", "HAS_OBJECT")
    sees_edit(page, server, page_set(1, "preconditions", 0, precondition("HAS_OBJECT", False)))
    page.get_by_test_id("rule-2-precondition-1-remove").click()
    sees_edit(page, server, {"do": "remove", "rule": 1, "part": "preconditions", "at": 0})
    expect(page.get_by_test_id("rule-2-preconditions")).to_contain_text("ε always")


def test_only_what_is_not_there_is_offered(page, server):
    page.get_by_test_id("rule-4-add-precondition").click()
    offered = page.get_by_test_id("menu").locator(".menu-label")
    expect(offered).to_have_text(["ON_SOURCE == true", "ON_SOURCE == false"])
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    element = precondition("ON_SOURCE", False)
    edit = {"do": "add", "rule": 3, "part": "preconditions", "at": 2, "element": element}
    sees_edit(page, server, edit)
    expect(page.get_by_test_id("rule-4-add-precondition")).to_be_hidden()


def test_behaviours_are_added_changed_and_removed(page, server):
    choose(page, "rule-1-add-behaviour", "RANDOM_WALK")
    edit = {"do": "add", "rule": 0, "part": "behaviours", "at": 1, "element": term("RANDOM_WALK")}
    sees_edit(page, server, edit)
    choose(page, "rule-1-behaviour-1-name", "ANTI-PHOTOTAXIS")
    sees_edit(page, server, page_set(0, "behaviours", 0, term("ANTI-PHOTOTAXIS")))
    page.get_by_test_id("rule-1-behaviour-1-remove").click()
    sees_edit(page, server, {"do": "remove", "rule": 0, "part": "behaviours", "at": 0})
    expect(page.get_by_test_id("rule-1-behaviour-1")).to_contain_text("RANDOM_WALK")


def test_actions_are_added_and_changed_between_their_two_kinds(page, server):
    choose(page, "rule-3-add-action", "WANT_OBJECT-false")
    element = sets(1, "WANT_OBJECT", False)
    edit = {"do": "add", "rule": 2, "part": "actions", "at": 1, "element": element}
    sees_edit(page, server, edit)
    expect(page.get_by_test_id("rule-3-action-2-p")).to_be_focused()
    page.get_by_test_id("rule-3-action-2-value").click()
    sees_edit(page, server, page_set(2, "actions", 1, {**element, "value": True}))
    choose(page, "rule-3-action-2-target", "WANT_OBJECT-true")  # what it is already: no edit
    choose(page, "rule-3-action-2-target", "PHOTOTAXIS")
    sees_edit(page, server, page_set(2, "actions", 1, changes(1, "PHOTOTAXIS")))
    choose(page, "rule-3-action-2-target", "DROP_OBJECT-true")
    element = sets(1, "DROP_OBJECT", True)
    sees_edit(page, server, page_set(2, "actions", 1, element))
    assert len(server.edits) == 4


def test_rules_are_added_duplicated_moved_switched_off_and_deleted(page, server):
    page.get_by_test_id("rule-2-duplicate").click()
    sees_edit(page, server, {"do": "duplicate_rule", "rule": 1})
    expect(page.get_by_test_id("rule-5")).to_be_visible()
    page.get_by_test_id("rule-5-up").click()
    sees_edit(page, server, {"do": "move_rule", "rule": 4, "to": 3})
    expect(page.get_by_test_id("rule-4-up")).to_be_focused()
    page.get_by_test_id("rule-1-enabled").click()
    sees_edit(page, server, {"do": "set_enabled", "rule": 0, "enabled": False})
    expect(page.get_by_test_id("rule-1-enabled")).to_have_attribute("aria-checked", "false")
    page.get_by_test_id("rule-3-delete").click()
    sees_edit(page, server, {"do": "remove_rule", "rule": 2})
    expect(page.get_by_test_id("rule-5")).to_have_count(0)
    page.get_by_test_id("add-rule").click()
    expect(page.get_by_test_id("rule-5-comment")).to_be_focused()
    assert server.document.rule_set.rules[4] == Rule()
    expect(page.get_by_test_id("rule-5")).to_contain_text("this rule does nothing")


def test_quick_clicks_hit_what_they_were_aimed_at(page, server):
    """Edits made before the answer to the first one arrive in order, at the right rule."""
    page.evaluate(
        """() => {
            const click = (id) => document.querySelector(`[data-testid=${id}]`).click();
            click("rule-1-delete"); click("rule-3-enabled"); click("rule-1-duplicate");
            click("rule-4-up"); click("rule-4-up");
        }"""
    )
    before = load_preset("evo8").rules
    expect(page.get_by_test_id("rule-1-comment")).to_have_value(before[3].comment)
    after = server.document.rule_set.rules
    assert [rule.comment for rule in after] == [before[i].comment for i in (3, 1, 2)]
    assert [rule.enabled for rule in after] == [True, True, False]


def test_undo_and_redo_by_button_and_key(page, server):
    expect(page.get_by_test_id("undo")).to_be_disabled()
    page.get_by_test_id("rule-2-precondition-1-value").click()
    expect(page.get_by_test_id("rule-2-precondition-1-value")).to_have_text("false")
    page.get_by_test_id("undo").click()
    expect(page.get_by_test_id("rule-2-precondition-1-value")).to_have_text("true")
    page.keyboard.press("Control+Shift+z")
    expect(page.get_by_test_id("rule-2-precondition-1-value")).to_have_text("false")
    page.keyboard.press("Control+z")
    expect(page.get_by_test_id("redo")).to_be_enabled()
    assert [message["type"] for message in server.received] == ["edit", "undo", "redo", "undo"]


def test_keys_work_on_the_rule_that_has_the_focus(page, server):
    page.get_by_test_id("rule-3-enabled").focus()
    page.keyboard.press("Alt+ArrowUp")
    sees_edit(page, server, {"do": "move_rule", "rule": 2, "to": 1})
    expect(page.get_by_test_id("rule-2-enabled")).to_be_focused()
    page.keyboard.press("Control+d")
    sees_edit(page, server, {"do": "duplicate_rule", "rule": 1})
    expect(page.get_by_test_id("rule-5")).to_be_visible()
    page.get_by_test_id("rule-4-precondition-1-value").focus()
    page.keyboard.press("Delete")
    sees_edit(page, server, {"do": "remove", "rule": 3, "part": "preconditions", "at": 0})


def test_a_rule_is_dragged_by_its_number(page, server):
    page.get_by_test_id("rule-4-handle").hover()
    page.mouse.down()
    target = page.get_by_test_id("rule-2").bounding_box()
    page.mouse.move(target["x"] + 30, target["y"] + 10, steps=6)
    page.mouse.up()
    sees_edit(page, server, {"do": "move_rule", "rule": 3, "to": 1})
    moved = load_preset("evo8").rules[3].comment
    expect(page.get_by_test_id("rule-2-comment")).to_have_value(moved)


def test_the_name_is_edited_in_place(page, server):
    name = page.get_by_test_id("name")
    name.fill("  My  rules ")
    name.press("Enter")
    sees_edit(page, server, {"do": "set_name", "name": "My rules"})
    expect(name).to_have_value("My rules")


def test_every_control_has_a_name(page, server):
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll(":is(button, input, textarea):not([hidden])")]
            .filter((node) => !node.getAttribute("aria-label") && !node.textContent.trim())
            .map((node) => node.outerHTML)"""
    )
    assert unnamed == []
    ids = page.evaluate(
        "[...document.querySelectorAll('[data-testid]')].map((n) => n.dataset.testid)"
    )
    assert len(ids) == len(set(ids))
