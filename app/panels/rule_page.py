"""The rule table page and the session, talking JSON (see static/rules/protocol.js)."""

from __future__ import annotations

from collections.abc import Callable

from geswarm.rules import FORMATS, EditError, RuleSetError, parse_text, simplify

from ..server.channel import Channel, Client, Message
from ..state.insight import Insight
from ..state.keys import COMMANDS
from ..state.session import Session
from ..state.verdict import Answer
from ..state.worth import WorthAnswer
from . import rule_messages

LIVE_SECONDS = 0.1
MAX_TEXT = 200_000

_CHANGES = frozenset(
    ("edit", "undo", "redo", "load_preset", "load_text", "set_text", "take_simplified")
)
_SUFFIXES = {"yaml": "yaml", "text": "rules"}


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
        self._since_live += elapsed
        if self._since_live >= LIVE_SECONDS:
            self._since_live = 0.0
            broadcast(rule_messages.live_message(session.world.state), live=True)

    def _greet(self, client: Client) -> None:
        session, send = self.session, self.channel.send
        send(client, rule_messages.vocabulary_message())
        send(client, self._rules())
        send(client, rule_messages.live_message(session.world.state), live=True)
        send(client, rule_messages.verdict_message(session.verdict.answer), live=True)
        if session.worth.answer is not None:
            send(client, rule_messages.worth_message(session.worth.answer), live=True)
        self.channel.welcome(client)

    def _receive(self, client: Client, message: Message) -> None:
        kind, version = str(message.get("type")), self.session.document.version
        try:
            if kind not in self._carry_out:
                raise EditError(f"unknown message {kind!r}")
            self._carry_out[kind](client, message)
        except (EditError, RuleSetError) as error:
            self.channel.send(client, rule_messages.notice_message(str(error)))
        if kind in _CHANGES and self.session.document.version == version:
            self.channel.send(client, self._rules())  # the page waits for an answer

    def _rules(self) -> Message:
        return rule_messages.rules_message(self.session.document, self.session.insight.insight)

    def _edit(self, _client: Client, message: Message) -> None:
        edit = message.get("edit")
        if not isinstance(edit, dict):
            raise EditError(f"expected an edit, got {edit!r}")
        self.session.edit(edit)

    def _press(self, _client: Client, message: Message) -> None:
        """A key of the arena that was pressed over the table."""
        key = _text(message, "key")
        if key not in COMMANDS:
            raise EditError(f"unknown key {key!r}; expected one of {', '.join(COMMANDS)}")
        COMMANDS[key](self.session)

    def _save(self, client: Client, message: Message) -> None:
        form = _text(message, "format")
        if form not in FORMATS:
            raise EditError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
        rule_set = self.session.document.rule_set
        text = FORMATS[form](rule_set)
        self.channel.send(client, rule_messages.file_message(rule_set, text, _SUFFIXES[form]))

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
