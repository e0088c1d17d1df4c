"""The rule table page and the session, talking JSON (see static/rules/protocol.js)."""

from __future__ import annotations

from collections.abc import Callable

from geswarm.rules import FORMATS, EditError, RuleSetError, parse_text, simplify
from geswarm.rules.findings import shown

from ..server.channel import Channel, Client, Message
from ..state.document import StaleError
from ..state.insight import Insight
from ..state.journal import Unsaved
from ..state.keys import COMMANDS
from ..state.session import Session
from ..state.states import DrawnMachine
from ..state.verdict import Answer
from ..state.worth import WorthAnswer
from . import rule_messages
from .people import People, change_words, one_line

LIVE_SECONDS = 0.1
MAX_TEXT = 200_000

_FOR_A_VERSION = frozenset(("edit", "undo", "redo", "set_text"))
_CHANGES = _FOR_A_VERSION | {"load_preset", "load_text", "take_simplified", "bring_back"}
_SUFFIXES = {"yaml": "yaml", "text": "rules", "json": "json"}


class RulePage:
    """Carries out what pages ask for and keeps all of them up to date."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.channel = Channel(
            on_message=lambda client, message: session.post(
                lambda _: self._receive(client, message)
            ),
            on_connect=lambda client: session.post(lambda _: self._greet(client)),
        )
        self._shown_rules: tuple[int, Insight | None] = (0, None)
        self._since_live = 0.0
        self._shown_answer: Answer | None = None
        self._shown_worth: WorthAnswer | None = None
        self._shown_machine: DrawnMachine | None = None
        self._shown_left = session.journal.left
        self._shown_problem = ""
        self._people = People()
        self._carry_out: dict[str, Callable[[Client, Message], None]] = {
            "edit": self._edit,
            "undo": lambda *_: session.undo(),
            "redo": lambda *_: session.redo(),
            "load_preset": lambda _, message: session.load_preset(_text(message, "name")),
            "load_text": lambda _, message: session.load_text(
                _text(message, "text"), _text(message, "name")
            ),
            "save": self._save,
            "set_text": lambda _, message: session.set_text(_text(message, "text")),
            "check_text": self._check_text,
            "simplify": self._simplify,
            "take_simplified": self._take_simplified,
            "key": self._press,
            "worth_start": lambda *_: session.weigh_pieces(),
            "worth_cancel": lambda *_: session.worth.forget(session.document.version),
            "name": self._name,
            "bring_back": lambda _, message: session.bring_back(self._left(message)),
            "discard": lambda _, message: session.journal.settle(
                self._left(message), session.document.unsaved
            ),
        }

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        session, broadcast = self.session, self.channel.broadcast
        shown = (session.document.version, session.insight.insight)
        if shown != self._shown_rules:
            self._shown_rules = shown
            broadcast(self._rules())
        if session.verdict.answer is not self._shown_answer:
            self._shown_answer = session.verdict.answer
            broadcast(rule_messages.verdict_message(self._shown_answer), live=True)
        if session.worth.answer is not self._shown_worth:
            self._shown_worth = session.worth.answer
            if self._shown_worth is not None:
                broadcast(rule_messages.worth_message(self._shown_worth), live=True)
        if session.machine.drawn is not self._shown_machine:
            self._shown_machine = session.machine.drawn
            if self._shown_machine is not None:
                broadcast(rule_messages.states_message(self._shown_machine), live=True)
        self._people.sync(self.channel)
        self._sync_journal()
        self._since_live += elapsed
        if self._since_live >= LIVE_SECONDS:
            self._since_live = 0.0
            broadcast(rule_messages.live_message(session.world.state), live=True)
            if (activity := session.machine.activity(session.world)) is not None:
                broadcast(rule_messages.activity_message(activity, session.world), live=True)

    def _sync_journal(self) -> None:
        journal, broadcast = self.session.journal, self.channel.broadcast
        if journal.left != self._shown_left:
            self._shown_left = journal.left
            broadcast(rule_messages.unsaved_message(journal.left))
        if journal.problem != self._shown_problem:
            self._shown_problem = journal.problem
            broadcast(rule_messages.journal_message(journal.problem))

    def _greet(self, client: Client) -> None:
        session, send = self.session, self.channel.send
        send(client, rule_messages.vocabulary_message())
        send(client, self._rules())
        send(client, rule_messages.live_message(session.world.state), live=True)
        send(client, rule_messages.verdict_message(session.verdict.answer), live=True)
        if session.worth.answer is not None:
            send(client, rule_messages.worth_message(session.worth.answer), live=True)
        if session.machine.drawn is not None:
            send(client, rule_messages.states_message(session.machine.drawn), live=True)
        send(client, rule_messages.unsaved_message(session.journal.left))
        if self._shown_problem:
            send(client, rule_messages.journal_message(self._shown_problem))
        self.channel.welcome(client)

    def _receive(self, client: Client, message: Message) -> None:
        kind = message.get("type")
        if not isinstance(kind, str) or kind not in self._carry_out:
            words = f"unknown message {shown(kind)}"
            self.channel.send(client, rule_messages.notice_message(words))
            return
        try:
            message = self._caught_up(message)
        except StaleError:
            self.channel.send(client, self._rules())
            self.channel.send(client, rule_messages.stale_message(message))
        else:
            self._do(client, kind, message)

    def _caught_up(self, message: Message) -> Message:
        """A message, as it is meant now if it was sent for an earlier version of the rules.

        Raises:
            StaleError: It must not be carried out: somebody else has changed what it is about.
        """
        document, version, edit = self.session.document, message.get("version"), message.get("edit")
        if message["type"] not in _FOR_A_VERSION or version == document.version:
            return message
        if message["type"] == "edit" and isinstance(edit, dict):
            return {**message, "edit": document.caught_up(edit, version)}
        raise StaleError

    def _do(self, client: Client, kind: str, message: Message) -> None:
        document = self.session.document
        version, before = document.version, document.rule_set
        try:
            self._carry_out[kind](client, message)
        except (EditError, RuleSetError) as error:
            self.channel.send(client, rule_messages.notice_message(str(error)))
        if document.version != version:
            words = change_words(message, before, document.rule_set)
            self._people.tell_others(self.channel, client, words)
        elif kind in _CHANGES:
            self.channel.send(client, self._rules())  # the page waits for an answer

    def _rules(self) -> Message:
        return rule_messages.rules_message(self.session.document, self.session.insight.insight)

    def _edit(self, _client: Client, message: Message) -> None:
        edit = message.get("edit")
        if not isinstance(edit, dict):
            raise EditError(f"expected an edit, got {shown(edit)}")
        self.session.edit(edit)

    def _press(self, _client: Client, message: Message) -> None:
        """A key of the arena that was pressed over the table."""
        key = _text(message, "key")
        if key not in COMMANDS:
            raise EditError(f"unknown key {shown(key)}; expected one of {', '.join(COMMANDS)}")
        COMMANDS[key](self.session)

    def _save(self, client: Client, message: Message) -> None:
        form = _text(message, "format")
        if form not in FORMATS:
            raise EditError(f"unknown format {shown(form)}; expected one of {', '.join(FORMATS)}")
        rule_set = self.session.document.rule_set
        text = FORMATS[form](rule_set)
        self.channel.send(client, rule_messages.file_message(rule_set, text, _SUFFIXES[form]))
        self.session.saved()

    def _name(self, client: Client, message: Message) -> None:
        client.name = one_line(_text(message, "name")) or f"Browser {client.number}"

    def _left(self, message: Message) -> Unsaved:
        """The rules of a killed dashboard that a message is about."""
        try:
            return self.session.journal.find(_text(message, "file"))
        except KeyError:
            raise EditError("these rules have been brought back or discarded already") from None

    def _check_text(self, client: Client, message: Message) -> None:
        findings: list[Message] = []
        try:
            parse_text(_text(message, "text"))
        except RuleSetError as error:
            findings = rule_messages.findings_json(error.findings)
        self.channel.send(client, {"type": "text_findings", "findings": findings})

    def _simplify(self, client: Client, _message: Message) -> None:
        simplification = simplify(self.session.document.rule_set)
        version = self.session.document.version
        self.channel.send(client, rule_messages.simplified_message(version, simplification))

    def _take_simplified(self, _client: Client, message: Message) -> None:
        if message.get("version") != self.session.document.version:
            raise EditError("the rules have changed meanwhile: simplify them again")
        self.session.simplify()


def _text(message: Message, key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str) or len(value) > MAX_TEXT:
        raise EditError(f"{key} must be a text of at most {MAX_TEXT} characters")
    return value
