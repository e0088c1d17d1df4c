"""The socket of the rule table and what is uploaded over it, with a real session behind."""

import json
from functools import cache

from hypothesis import strategies as st

from geswarm.app.panels.rule_page import RulePage
from geswarm.app.protocol.base import NoticeMessage
from geswarm.app.state.document import bare_rules
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import FORMATS
from geswarm.rules.as_json import rule_set_to_json
from tests.app.wire import as_read
from tests.robustness import mutations
from tests.robustness.doors import EVO8, PAPER, RULE_SETS, Door, RefusedError, as_utf8, text_inputs

QUICK = PAPER.with_changes(duration=1.0)


class Pages:
    """Stands in for the channel: what is sent must be JSON; remembers what was refused."""

    clients = ()

    def __init__(self):
        self.refusals = []

    def send(self, _client, message, *, live=False):
        as_read(message)
        if isinstance(message, NoticeMessage):
            self.refusals.append(message.text)

    def welcome(self, client):
        pass

    def broadcast(self, message, *, live=False):
        self.send(None, message)


def talk(raw_messages):
    """Messages of a page to a session, as they arrive; one that is refused changes nothing."""
    session = Session(QUICK, EVO8, EvolutionThread(workers=1))
    page = RulePage(session)
    hear, page.channel = page.channel.hear, Pages()
    try:
        for raw in raw_messages:
            known = len(page.channel.refusals)
            before = (session.document.version, session.document.rule_set, session.world.rule_set)
            version = session.document.version  # what the page has been told
            hear("client", raw.replace('"version": 1', f'"version": {version}', 1))
            session.frame(0.0, 0.1)
            page.sync(0.2)
            after = (session.document.version, session.document.rule_set, session.world.rule_set)
            if len(page.channel.refusals) > known:
                assert after == before
            assert bare_rules(session.world.rule_set) == bare_rules(session.document.rule_set)
    finally:
        session.close()
    if page.channel.refusals:
        raise RefusedError("\n".join(page.channel.refusals))


_RULE = rule_set_to_json(EVO8)["rules"][1]
_EDITS = (
    {"do": "set_name", "name": "mine"},
    {"do": "add_rule", "at": 1, "rule": _RULE},
    {"do": "paste_rules", "at": 0, "text": "rule do p = 1, PHOTOTAXIS"},
    {"do": "move_rule", "rule": 0, "to": 2},
    *({"do": do, "rule": 1} for do in ("remove_rule", "duplicate_rule")),
    {"do": "set_enabled", "rule": 0, "enabled": False},
    {"do": "set_comment", "rule": 0, "comment": "why"},
    {"do": "add", "rule": 0, "part": "actions", "at": 0, "element": _RULE["actions"][0]},
    {
        "do": "set",
        "rule": 1,
        "part": "preconditions",
        "at": 0,
        "element": _RULE["preconditions"][0],
    },
    {"do": "remove", "rule": 1, "part": "behaviours", "at": 0},
)
_MESSAGES = (
    *({"type": "edit", "version": 1, "edit": edit} for edit in _EDITS),
    *({"type": kind, "version": 1} for kind in ("undo", "redo", "simplify", "take_simplified")),
    *({"type": kind} for kind in ("worth_start", "worth_cancel")),
    {"type": "load_preset", "name": "hand-coded"},
    *({"type": "save", "format": form} for form in FORMATS),
    *({"type": "key", "key": key} for key in "POXFR"),
    *({"type": kind, "version": 1, "name": "x", "text": "rule do p = 1, PHOTOTAXIS"}
      for kind in ("load_text", "set_text", "check_text")),
)  # fmt: skip


def messages(rng):
    def message():
        example = rng.choice(_MESSAGES)
        if rng.random() < 0.6:
            example = mutations.mutated_value(rng, example)
        text = json.dumps(example, ensure_ascii=rng.random() < 0.5)
        return as_utf8(mutations.mutated_text(rng, (text,)) if rng.random() < 0.1 else text)

    return [message() for _ in range(rng.choice((1, 2, 5)))]


def upload(content):
    """What the page sends for a file that a person picked or dropped."""
    name, text = content
    talk([json.dumps({"type": "load_text", "name": name, "text": text})])


def uploads(rng):
    write = rng.choice(list(FORMATS.values()))
    text = text_inputs(*map(write, RULE_SETS))(rng)
    return rng.choice(("mine.yaml", "mine.rules", "mine.json", "", "../x.yaml", "x" * 500)), text


@cache
def doors():
    """Messages and uploads."""
    keys = ("type", "edit", "text", "name", "key", "version", "format")
    return (
        Door("messages of a page", talk, (RefusedError,), messages,
             st.lists(mutations.json_objects(keys).map(json.dumps), max_size=3)),
        Door("upload", upload, (RefusedError,), uploads,
             st.tuples(st.sampled_from(("a.yaml", "a.rules", "a.json")), st.text(max_size=60))),
    )  # fmt: skip
