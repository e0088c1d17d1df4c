"""Several people at one rule table: edits in order, too late or not, and who is told what."""

import json
import threading
import time

import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.app.panels.people import MAX_NAME, change_words, one_line
from geswarm.app.panels.rule_page import RulePage
from geswarm.app.protocol.edits import RemoveRule
from geswarm.app.protocol.rule_requests import LoadPreset, MakeEdit
from geswarm.app.server.channel import Client
from geswarm.app.state.document import RuleDocument
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import apply_edit, load_preset
from geswarm.sim import load_scenario
from tests.app.wire import as_read, typed

EVO8 = load_preset("evo8")
MOVE = {"do": "move_rule", "rule": 2, "to": 0}
R3_OFF = {"do": "set_enabled", "rule": 2, "enabled": False}


class Room:
    """Stands in for the channel: two people, and what each of them is sent."""

    def __init__(self):
        self.clients = (Client(1, None), Client(2, None))
        self.sent = {client: [] for client in self.clients}

    def send(self, client, message, *, live=False):
        self.sent[client].append(as_read(message))

    def welcome(self, client):
        client.welcome = True

    def broadcast(self, message, *, live=False):
        for client in self.clients:
            self.send(client, message)

    def of(self, client, kind):
        return [message for message in self.sent[client] if message["type"] == kind]


@pytest.fixture
def page():
    session = Session(
        load_scenario("paper").with_changes(duration=50.0), EVO8, EvolutionThread(workers=1)
    )
    page = RulePage(session)
    hear, greet = page.channel.hear, page.channel.on_connect
    page.channel = Room()
    page.one, page.two = page.channel.clients
    page.say = lambda who, **message: (hear(who, json.dumps(message)), session.frame(0.0, 1.0))
    for client in page.channel.clients:
        greet(client)
    session.frame(0.0, 1.0)
    yield page
    session.close()


def enabled(page):
    return [rule.enabled for rule in page.session.document.rule_set.rules]


def test_an_edit_finds_its_rule_where_somebody_else_has_moved_it(page):
    page.say(page.one, type="edit", version=1, edit=MOVE)
    page.say(page.two, type="edit", version=1, edit=R3_OFF)
    page.say(page.two, type="edit", version=1, edit={"do": "remove_rule", "rule": 0})
    page.say(page.one, type="edit", version=3, edit={"do": "add_rule", "at": 4, "rule": EMPTY})
    rules = page.session.document.rule_set.rules
    assert [rule.comment for rule in rules] == [EVO8.rules[i].comment for i in (2, 1, 3)] + [""]
    assert enabled(page) == [False, True, True, True]
    assert not page.channel.of(page.two, "stale")
    words = [message["what"] for message in page.channel.of(page.one, "changed")]
    assert words == ["switched R1 off", "removed R2"]


@pytest.mark.parametrize("first", [{"do": "remove_rule", "rule": 2}, {**R3_OFF, "rule": 2}])
def test_an_edit_of_a_rule_that_is_no_longer_the_same_is_refused(page, first):
    page.say(page.one, type="edit", version=1, edit=first)
    left = page.session.document.rule_set
    page.say(page.two, type="edit", version=1, edit={"do": "remove_rule", "rule": 2})
    assert page.session.document.rule_set == left
    rules, stale = page.channel.sent[page.two][-2:]  # the rules first
    assert (rules["type"], rules["version"]) == ("rules", 2)
    assert (stale["type"], stale["version"]) == ("stale", 1)
    assert not page.channel.of(page.one, "stale")


@pytest.mark.parametrize("version", [0, -5, 3, 10**9])
def test_an_edit_for_no_known_version_is_refused(page, version):
    page.say(page.one, type="edit", version=1, edit=MOVE)
    page.say(page.two, type="edit", version=version, edit=R3_OFF)
    assert enabled(page) == [True] * 4
    assert len(page.channel.of(page.two, "stale")) == 1


@pytest.mark.parametrize("version", [None, "1", 0.5])
def test_an_edit_for_nothing_like_a_version_is_refused(page, version):
    page.say(page.one, type="edit", version=version, edit=R3_OFF)
    assert enabled(page) == [True] * 4
    assert (
        "edit.version: expected a whole number, got "
        in page.channel.of(page.one, "notice")[-1]["text"]
    )
    assert page.channel.sent[page.one][-1]["type"] == "rules"  # the page waits for an answer


def test_equal_rules_are_told_apart_by_their_places():
    document = RuleDocument(EVO8)
    document.edit(typed({"do": "duplicate_rule", "rule": 0}))
    document.edit(typed({"do": "add_rule", "at": 0, "rule": EMPTY}))
    late = [document.caught_up(RemoveRule(at), 2).rule for at in range(5)]
    assert late == [1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    "message",
    [{"type": "undo"}, {"type": "redo"}, {"type": "set_text", "text": "rule do p = 1, PHOTOTAXIS"}],
)
def test_nothing_is_done_to_rules_that_were_not_seen(page, message):
    page.say(page.one, type="edit", version=1, edit=MOVE)
    page.say(page.one, type="undo", version=2)
    page.say(page.two, **message, version=1)
    page.say(page.two, **message)
    assert page.session.document.version == 3
    assert len(page.channel.of(page.two, "stale")) == 1
    refusal = page.channel.of(page.two, "notice")[-1]["text"]
    assert "expected the field version" in refusal


def test_the_others_are_told_who_did_what(page):
    page.say(page.one, type="name", name="  Ada\n\tL. ")
    page.say(page.one, type="edit", version=1, edit=R3_OFF)
    page.say(page.two, type="undo", version=2)
    assert page.channel.of(page.two, "changed") == [
        {"type": "changed", "who": "Ada L.", "what": "switched R3 off"}
    ]
    assert page.channel.of(page.one, "changed") == [
        {"type": "changed", "who": "Browser 2", "what": "took the last change back"}
    ]


def test_nobody_is_told_of_what_was_not_done(page):
    page.say(page.one, type="edit", version=1, edit={**R3_OFF, "rule": 9})
    page.say(page.one, type="undo", version=1)
    page.say(page.one, type="save", format="yaml")
    assert not page.channel.of(page.two, "changed")


def test_everybody_knows_who_is_there(page):
    page.sync(0.0)
    assert page.channel.of(page.two, "people")[-1]["people"] == [
        {"name": "Browser 1", "you": False},
        {"name": "Browser 2", "you": True},
    ]
    page.say(page.one, type="name", name="<b>Ada</b>")
    page.say(page.two, type="name", name="")
    page.sync(0.0)
    page.sync(0.0)
    assert len(page.channel.of(page.two, "people")) == 2
    assert page.channel.of(page.two, "people")[-1]["people"][0]["name"] == "<b>Ada</b>"
    page.channel.clients = (page.two,)
    page.sync(0.0)
    assert len(page.channel.of(page.two, "people")[-1]["people"]) == 1


def test_names_are_short_and_on_one_line():
    assert one_line("a\u202e\x00b\nc") == "a b c"
    assert len(one_line("x" * 1000)) == MAX_NAME
    assert one_line(" \n ") == ""


EMPTY = {"comment": "", "enabled": True, "preconditions": [], "behaviours": [], "actions": []}
ELEMENT = {"p": 0.5, "behaviour": "RANDOM_WALK"}
IN_R1 = {"rule": 0, "part": "actions", "at": 0}


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        ({"do": "set_name", "name": "Mine"}, "called the rules Mine"),
        ({"do": "set_name", "name": ""}, "took the name away"),
        ({"do": "add_rule", "at": 4, "rule": EMPTY}, "added a rule at R5"),
        ({"do": "duplicate_rule", "rule": 1}, "added a rule at R2"),
        ({"do": "paste_rules", "at": 1, "text": "rule rule"}, "added 2 rules at R2"),
        ({"do": "remove_rule", "rule": 3}, "removed R4"),
        (MOVE, "moved R3 to R1"),
        (R3_OFF, "switched R3 off"),
        ({"do": "set_comment", "rule": 0, "comment": "x"}, "explained R1"),
        ({"do": "set", **IN_R1, "element": ELEMENT}, "changed R1: p = 0.5, RANDOM_WALK"),
        ({"do": "add", **IN_R1, "element": ELEMENT}, "added to R1: p = 0.5, RANDOM_WALK"),
        ({"do": "remove", **IN_R1}, "removed from R1: p = 0.05, RANDOM_WALK"),
        (
            {"do": "set", "rule": 1, "part": "behaviours", "at": 0, "element": "PHOTOTAXIS"},
            "changed R2: PHOTOTAXIS",
        ),
        (
            {"do": "remove", "rule": 1, "part": "preconditions", "at": 0},
            "removed from R2: ON_NEST == true",
        ),
    ],
)
def test_every_edit_has_its_words(edit, words):
    after = apply_edit(EVO8, edit)
    assert change_words(MakeEdit(typed(edit), version=1), EVO8, after) == words


def test_a_loaded_rule_set_is_called_by_its_name():
    assert change_words(LoadPreset("hand-coded"), EVO8, load_preset("hand-coded")) == (
        "loaded Hand-coded"
    )


@pytest.fixture
def dashboard():
    dashboard = open_dashboard(
        load_scenario("paper").with_changes(duration=100.0), EVO8, "127.0.0.1", 0
    )
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()


def wait_until(condition, page, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        page.wait_for_timeout(20)


def open_table(browser, dashboard):
    page = browser.new_context(viewport={"width": 600, "height": 800}).new_page()
    page.goto(f"{dashboard.address}/rules/rules.html")
    page.get_by_test_id("rule-4").wait_for()
    return page


def held_up(dashboard, *acts):
    """Let several people act before the loop sees any of it."""
    arrived, go_on = threading.Event(), threading.Event()
    dashboard.session.post(lambda _: (arrived.set(), go_on.wait(30)))
    assert arrived.wait(30)
    for act in acts:
        act()
    time.sleep(0.3)
    go_on.set()


def p_of(dashboard, comment):
    """The first probability of the rule with a comment; None if there is no such rule."""
    rules = dashboard.session.document.rule_set.rules
    return next((rule.actions[0].p for rule in rules if rule.comment == comment), None)


@pytest.mark.browser
@pytest.mark.slow
def test_two_people_at_once(dashboard, browser):
    ada, ben = open_table(browser, dashboard), open_table(browser, dashboard)

    # They see one another.
    ada.get_by_test_id("people").click()
    ada.get_by_test_id("person-name").fill("Ada <b>")
    ada.keyboard.press("Enter")
    ada.keyboard.press("Escape")
    wait_until(lambda: "Ada <b>" in ben.get_by_test_id("people").get_attribute("title"), ben)
    assert ben.get_by_test_id("people").inner_text() == "2 here"

    # An edit is seen by the other, with a name, and not by who made it.
    ada.get_by_test_id("rule-1-enabled").click()
    ben.get_by_text("switched R1 off").wait_for()
    assert ben.get_by_test_id("others").inner_text() == "Ada <b> switched R1 off"
    assert ada.get_by_test_id("others").is_hidden()

    # Ada moves R3 up while Ben changes its p: Ben's edit follows the rule.
    comment = EVO8.rules[2].comment

    def ben_changes_r3():
        ben.get_by_test_id("rule-3-action-1-p").fill("0.5")
        ben.keyboard.press("Enter")

    held_up(dashboard, ada.get_by_test_id("rule-3-up").click, ben_changes_r3)
    wait_until(lambda: p_of(dashboard, comment) == 0.5, ben)
    assert [rule.comment for rule in dashboard.session.document.rule_set.rules][1] == comment
    assert ben.get_by_test_id("notice-error").count() == 0
    others = [rule for rule in dashboard.session.document.rule_set.rules if rule.comment != comment]
    assert [rule.actions for rule in others] == [EVO8.rules[i].actions for i in (0, 1, 3)]

    # Ada removes R4 while Ben switches it off: Ben is told, and no other rule is switched off.
    before = dashboard.session.document.rule_set.rules
    held_up(
        dashboard,
        ada.get_by_test_id("rule-4-delete").click,
        ben.get_by_test_id("rule-4-enabled").click,
    )
    ben.get_by_text("do it again").wait_for()
    assert dashboard.session.document.rule_set.rules == before[:3]

    # Ada edits while Ben applies a text: nothing is lost, the text is a draft again.
    ben.get_by_test_id("tab-text").click()
    ben.get_by_test_id("source").fill("rule do p = 1, PHOTOTAXIS")
    held_up(
        dashboard,
        ada.get_by_test_id("rule-2-delete").click,
        ben.get_by_test_id("apply-text").click,
    )
    ben.get_by_test_id("changed-meanwhile").wait_for()
    assert ben.get_by_test_id("source").input_value() == "rule do p = 1, PHOTOTAXIS"
    assert len(dashboard.session.document.rule_set.rules) == 2
    ben.get_by_test_id("apply-text").click()
    wait_until(lambda: len(dashboard.session.document.rule_set.rules) == 1, ben)
    ada.context.close()
    ben.context.close()
