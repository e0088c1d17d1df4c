"""The rule table page and the session (see app/protocol/rules.py)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec

from geswarm.rules import FORMATS, EditError, RuleSetError, parse_text, simplify

from ..protocol import rule_requests as asked
from ..protocol.base import Request
from ..protocol.rules import RuleFinding, RulesMessage, TextFindingsMessage
from ..server.channel import Client
from ..state.document import StaleError
from ..state.insight import Insight
from ..state.journal import Unsaved
from ..state.keys import COMMANDS
from ..state.session import Session
from ..state.states import DrawnMachine
from ..state.verdict import Answer
from ..state.worth import WorthAnswer
from . import rule_messages
from .page import Page
from .people import People, change_words, one_line

LIVE_SECONDS = 0.1

_CHANGES = (
    asked.ChangeRequest,
    asked.LoadPreset,
    asked.LoadText,
    asked.BringBack,
)
_SUFFIXES = {"yaml": "yaml", "text": "rules", "json": "json"}


class RulePage(Page):
    """Carries out what pages ask for and keeps all of them up to date."""

    def __init__(self, session: Session) -> None:
        super().__init__(session, "rules", watched=False)
        self._shown_rules: tuple[int, Insight | None] = (0, None)
        self._since_live = 0.0
        self._shown_answer: Answer | None = None
        self._shown_worth: WorthAnswer | None = None
        self._shown_machine: DrawnMachine | None = None
        self._shown_left = session.journal.left
        self._shown_scenario = session.loaded
        self._shown_problem = ""
        self._people = People()
        self._carry_out: dict[type[Request], Callable[[Client, Any], None]] = {
            asked.MakeEdit: lambda _, message: session.edit(message.edit),
            asked.Undo: lambda *_: session.undo(),
            asked.Redo: lambda *_: session.redo(),
            asked.LoadPreset: lambda _, message: session.load_preset(message.name),
            asked.LoadText: lambda _, message: session.load_text(message.text, message.name),
            asked.Save: self._save,
            asked.SetText: lambda _, message: session.set_text(message.text),
            asked.CheckText: self._check_text,
            asked.Simplify: self._simplify,
            asked.TakeSimplified: self._take_simplified,
            asked.PressKey: lambda _, message: COMMANDS[message.key](session),
            asked.WorthStart: lambda *_: session.weigh_pieces(),
            asked.WorthCancel: lambda *_: session.worth.forget(session.document.version),
            asked.BeCalled: self._name,
            asked.BringBack: lambda _, message: session.bring_back(self._left(message)),
            asked.Discard: lambda _, message: session.journal.settle(
                self._left(message), session.document.unsaved
            ),
        }

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        session, broadcast = self.session, self.channel.broadcast
        if session.loaded is not self._shown_scenario:
            self._shown_scenario = session.loaded
            broadcast(rule_messages.vocabulary_message(session.scenario))
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
            broadcast(
                rule_messages.live_message(session.world.state, session.vocabulary), live=True
            )
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
        send(client, rule_messages.vocabulary_message(session.scenario))
        send(client, self._rules())
        send(client, rule_messages.live_message(session.world.state, session.vocabulary), live=True)
        send(client, rule_messages.verdict_message(session.verdict.answer), live=True)
        if session.worth.answer is not None:
            send(client, rule_messages.worth_message(session.worth.answer), live=True)
        if session.machine.drawn is not None:
            send(client, rule_messages.states_message(session.machine.drawn), live=True)
        send(client, rule_messages.unsaved_message(session.journal.left))
        if self._shown_problem:
            send(client, rule_messages.journal_message(self._shown_problem))
        self.channel.welcome(client)

    def _receive(self, client: Client, message: Request) -> None:
        try:
            message = self._caught_up(message)
        except StaleError:
            assert isinstance(message, asked.ChangeRequest)
            self.channel.send(client, self._rules())
            self.channel.send(client, rule_messages.stale_message(message.version))
        else:
            self._do(client, message)

    def _caught_up(self, message: Request) -> Request:
        """A message, as it is meant now if it was sent for an earlier version of the rules.

        Raises:
            StaleError: It must not be carried out: somebody else has changed what it is about.
        """
        document = self.session.document
        if (
            not isinstance(message, asked.ChangeRequest)
            or isinstance(message, asked.TakeSimplified)  # says so by itself
            or message.version == document.version
        ):
            return message
        if isinstance(message, asked.MakeEdit):
            edit = document.caught_up(message.edit, message.version)
            return msgspec.structs.replace(message, edit=edit)
        raise StaleError

    def _do(self, client: Client, message: Request) -> None:
        document = self.session.document
        version, before = document.version, document.rule_set
        try:
            self._carry_out[type(message)](client, message)
        except (EditError, RuleSetError) as error:
            super()._refuse(client, str(error))
        if document.version != version:
            words = change_words(message, before, document.rule_set)
            self._people.tell_others(self.channel, client, words)
        elif isinstance(message, _CHANGES):
            self.channel.send(client, self._rules())  # the page waits for an answer

    def _refuse(self, client: Client, why: str) -> None:
        super()._refuse(client, why)
        self.channel.send(client, self._rules())  # the page may wait for an answer

    def _rules(self) -> RulesMessage:
        return rule_messages.rules_message(
            self.session.document, self.session.insight.insight, self.session.vocabulary
        )

    def _save(self, client: Client, message: asked.Save) -> None:
        rule_set = self.session.document.rule_set
        text = FORMATS[message.format](rule_set)
        suffix = _SUFFIXES[message.format]
        self.channel.send(client, rule_messages.file_message(rule_set, text, suffix))
        self.session.saved()

    def _name(self, client: Client, message: asked.BeCalled) -> None:
        client.name = one_line(message.name) or f"Browser {client.number}"

    def _left(self, message: asked.FileRequest) -> Unsaved:
        """The rules of a killed dashboard that a message is about."""
        try:
            return self.session.journal.find(message.file)
        except KeyError:
            raise EditError("these rules have been brought back or discarded already") from None

    def _check_text(self, client: Client, message: asked.CheckText) -> None:
        findings: tuple[RuleFinding, ...] = ()
        try:
            parse_text(message.text, vocabulary=self.session.vocabulary)
        except RuleSetError as error:
            findings = rule_messages.placed(error.findings)
        self.channel.send(client, TextFindingsMessage(findings))

    def _simplify(self, client: Client, _: asked.Simplify) -> None:
        simplification = simplify(self.session.document.rule_set, self.session.vocabulary)
        version = self.session.document.version
        self.channel.send(client, rule_messages.simplified_message(version, simplification))

    def _take_simplified(self, _client: Client, message: asked.TakeSimplified) -> None:
        if message.version != self.session.document.version:
            raise EditError("the rules have changed meanwhile: simplify them again")
        self.session.simplify()
