"""What the rule table page asks for and is told, without a socket."""

import json
import time

import pytest

from geswarm.app.panels.rule_page import RulePage
from geswarm.app.server.channel import Client
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import format_text, load_preset, parse_yaml
from geswarm.sim import load_scenario
from tests.app.wire import as_read

EVO8 = load_preset("evo8")


class Recorder:
    """Stands in for the channel: keeps what would be sent, as pages read it."""

    clients = ()

    def __init__(self):
        self.messages = []

    def send(self, _client, message, *, live=False):
        self.messages.append(as_read(message))

    def welcome(self, client):
        pass

    def broadcast(self, message, *, live=False):
        self.messages.append(as_read(message))

    def of(self, kind):
        return [message for message in self.messages if message["type"] == kind]


@pytest.fixture
def page():
    quick = load_scenario("paper").with_changes(duration=50.0)
    session = Session(quick, EVO8, EvolutionThread(workers=1))
    page = RulePage(session)
    hear, greet = page.channel.hear, page.channel.on_connect
    page.channel = Recorder()
    client = Client(1, None)

    def say(**message):
        if message.get("type") in ("edit", "undo", "redo", "set_text"):
            message = {"version": session.document.version, **message}
        hear(client, json.dumps(message))
        session.frame(0.0, 1.0)

    page.say = say
    page.arrive = lambda: (greet(client), session.frame(0.0, 1.0))
    yield page
    session.close()


def until(page, condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        page.sync(0.1)
        time.sleep(0.01)


def test_a_page_that_arrives_is_told_everything(page):
    until(page, lambda: page.session.machine.drawn)
    page.channel.messages.clear()
    page.arrive()
    kinds = [message["type"] for message in page.channel.messages]
    assert kinds == ["vocabulary", "rules", "live", "verdict", "states", "unsaved"]
    rules = page.channel.of("rules")[0]
    assert rules["rule_set"]["name"] == "EVO 8"
    assert rules["english"][0].startswith("While going to the light")
    assert rules["text"] == format_text(EVO8)
    assert len(rules["rule_texts"]) == 4


def test_an_edit_reaches_all_pages_with_findings_and_verdict(page):
    page.say(type="edit", version=1, edit={"do": "remove", "rule": 0, "part": "actions", "at": 0})
    until(page, lambda: page.channel.of("rules") and page.channel.of("rules")[-1]["findings"])
    rules = page.channel.of("rules")[-1]
    assert rules["version"] == 2
    assert rules["can_undo"]
    assert any("no action" in finding["message"] for finding in rules["findings"])
    assert rules["loaded_text"] == format_text(EVO8)
    until(page, lambda: page.channel.of("verdict") and not page.channel.of("verdict")[-1]["busy"])
    verdict = page.channel.of("verdict")[-1]
    assert verdict["version"] == 2
    assert [sample["role"] for sample in verdict["samples"]] == [
        "current",
        "before",
        "evo8",
        "hand-coded",
    ]
    assert {entry["role"] for entry in verdict["comparisons"]} == {"before", "evo8", "hand-coded"}


def test_text_is_checked_and_taken(page):
    page.say(type="check_text", text="rule do p = 2, PHOTOTAXIS")
    (finding,) = page.channel.of("text_findings")[-1]["findings"]
    assert (finding["line"], finding["rule"]) == (1, 1)
    page.say(type="set_text", text="rule do p = 0.5, PHOTOTAXIS")
    assert page.session.world.rule_set.rules[0].actions[0].p == 0.5
    page.say(type="undo")
    assert page.session.world.rule_set == EVO8


def test_the_shorter_rules_are_shown_and_taken(page):
    page.say(type="simplify")
    (shown,) = page.channel.of("simplified")
    assert shown["removed"]
    page.say(type="take_simplified", version=99)
    assert "meanwhile" in page.channel.of("notice")[-1]["text"]
    assert page.session.document.rule_set == EVO8
    page.say(type="take_simplified", version=shown["version"])
    assert format_text(page.session.document.rule_set) == shown["text"]


def test_pieces_are_weighed_until_the_rules_change(page):
    page.say(type="worth_start")
    until(page, lambda: page.channel.of("worth") and not page.channel.of("worth")[-1]["busy"])
    worth = page.channel.of("worth")[-1]
    assert worth["done"] == worth["total"] == len(worth["pieces"])
    assert set(worth["pieces"][0]) == {
        "rule", "part", "at", "difference", "low", "high", "p_value",
    }  # fmt: skip
    page.say(type="edit", version=1, edit={"do": "remove_rule", "rule": 3})
    until(page, lambda: page.channel.of("worth")[-1]["pieces"] == [])


def test_saved_files_can_be_loaded_again(page):
    page.say(type="save", format="yaml")
    file = page.channel.of("file")[-1]
    assert file["name"] == "evo-8.yaml"
    assert parse_yaml(file["text"]) == EVO8
    page.say(type="load_preset", name="hand-coded")
    page.say(type="load_text", name=file["name"], text=file["text"])
    assert page.session.document.rule_set == EVO8


def test_whether_unsaved_rules_are_kept_is_told_also_to_who_comes_later(page):
    journal = page.session.journal
    journal.problem = "the disk is full"
    page.sync(0.0)
    page.arrive()
    told = [message["text"] for message in page.channel.of("notice")]
    assert len(told) == 2
    assert all(text.endswith("lost: the disk is full") for text in told)
    journal.problem = ""
    page.sync(0.0)
    page.arrive()
    assert [message["text"] for message in page.channel.of("notice")][2:] == [""]
    assert {message["about"] for message in page.channel.of("notice")} == {"journal"}


def test_keys_of_the_arena_work_over_the_table_too(page):
    page.say(type="key", key="P")
    assert page.session.playback.playing
    page.say(type="key", key="X")
    assert (page.session.playback.playing, page.session.world.steps) == (False, 1)


@pytest.mark.parametrize(
    "message",
    [
        {},
        {"type": None},
        {"type": ["edit"]},
        {"type": "dance"},
        {"type": "edit"},
        {"type": "edit", "edit": 5},
        {"type": "load_preset", "name": "evo9"},
        {"type": "load_preset", "name": 5},
        {"type": "load_text", "name": "x.yaml", "text": "rules: ["},
        {"type": "set_text", "text": "rule rule rule do"},
        {"type": "save", "format": "pickle"},
        {"type": "key", "key": "Q"},
        {"type": "check_text", "text": "x" * 300_000},
    ],
)
def test_what_cannot_be_done_is_told_and_changes_nothing(page, message):
    page.say(**message)
    assert page.channel.of("notice")[-1]["level"] == "error"
    assert page.session.document.version == 1
