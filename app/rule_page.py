"""The rule table page and the session, talking JSON (see static/protocol.js)."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from geswarm.rules import (
    FORAGING,
    FORMATS,
    EditError,
    RuleSetError,
    check,
    load_preset,
    preset_names,
)
from geswarm.rules.as_json import rule_set_to_json

from . import palette
from .channel import Channel, Client, Message
from .session import Session
from .verdict import RUNS, Answer

LIVE_SECONDS = 0.1
MAX_TEXT = 200_000


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
        self._shown_version = 0
        self._since_live = 0.0
        self._shown_answer: Answer | None = None

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        version = self.session.document.version
        if version != self._shown_version:
            self._shown_version = version
            self.channel.broadcast(self._rules())
        if self.session.verdict.answer is not self._shown_answer:
            self._shown_answer = self.session.verdict.answer
            self.channel.broadcast(verdict_message(self._shown_answer), live=True)
        self._since_live += elapsed
        if self._since_live >= LIVE_SECONDS:
            self._since_live = 0.0
            self.channel.broadcast(self._live(), live=True)

    def _greet(self, client: Client) -> None:
        self.channel.send(client, _vocabulary())
        self.channel.send(client, self._rules())
        self.channel.send(client, self._live(), live=True)
        self.channel.send(client, verdict_message(self.session.verdict.answer), live=True)

    def _receive(self, client: Client, message: Message) -> None:
        before = self.session.document.version
        try:
            self._carry_out(client, message)
        except (EditError, RuleSetError) as error:
            self._notice(client, str(error))
        if self.session.document.version == before:  # the page waits for an answer
            self.channel.send(client, self._rules())

    def _carry_out(self, client: Client, message: Message) -> None:
        session, kind = self.session, message.get("type")
        if kind == "edit" and isinstance(message.get("edit"), dict):
            session.edit(message["edit"])
        elif kind == "undo":
            session.undo()
        elif kind == "redo":
            session.redo()
        elif kind == "load_preset":
            session.load_preset(_text(message, "name"))
        elif kind == "load_text":
            session.load_text(_text(message, "text"), _text(message, "name"))
        elif kind == "save":
            self._save(client, _text(message, "format"))
        else:
            raise EditError(f"unknown message {kind!r}")

    def _save(self, client: Client, form: str) -> None:
        if form not in FORMATS:
            raise EditError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
        rule_set = self.session.document.rule_set
        letters = "".join(char if char.isalnum() else "-" for char in rule_set.name.lower())
        stem = "-".join(filter(None, letters.split("-"))) or "rules"
        suffix = {"yaml": "yaml", "text": "rules"}[form]
        text = FORMATS[form](rule_set)
        self.channel.send(client, {"type": "file", "name": f"{stem}.{suffix}", "text": text})

    def _notice(self, client: Client, text: str) -> None:
        self.channel.send(client, {"type": "notice", "level": "error", "text": text})

    def _rules(self) -> Message:
        document = self.session.document
        findings = [
            {
                "rule": finding.place.rule,
                "element": finding.place.element,
                "message": finding.message,
                "severity": finding.severity,
            }
            for finding in check(document.rule_set)
        ]
        return {
            "type": "rules",
            "version": document.version,
            "can_undo": document.can_undo,
            "can_redo": document.can_redo,
            "rule_set": rule_set_to_json(document.rule_set),
            "findings": findings,
        }

    def _live(self) -> Message:
        state = self.session.world.state
        robots = np.bincount(state.behaviour, minlength=len(FORAGING.behaviours))
        return {
            "type": "live",
            "time": state.time,
            "fired": state.rule_counts.tolist(),
            "behaviours": robots.tolist(),
            "robots": len(state.behaviour),
        }


def verdict_message(answer: Answer | None) -> Message:
    """What is known of the verdict, for pages."""
    if answer is None:
        return {"type": "verdict", "version": 0, "busy": True, "samples": [], "comparisons": []}
    return {
        "type": "verdict",
        "version": answer.question.version,
        "scenario": answer.question.scenario.name,
        "runs": RUNS,
        "busy": answer.busy,
        "samples": [
            {"role": sample.role, "name": sample.name, "collected": sample.collected.tolist()}
            for sample in answer.samples
        ],
        "comparisons": [
            {"role": role, **asdict(comparison)}
            for role, comparison in answer.comparisons().items()
        ],
    }


def _text(message: Message, key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str) or len(value) > MAX_TEXT:
        raise EditError(f"{key} must be a text of at most {MAX_TEXT} characters")
    return value


def _vocabulary() -> Message:
    def entry(item: Any, **extra: str) -> dict[str, Any]:
        return {**vars(item), **extra}

    return {
        "type": "vocabulary",
        "preconditions": [entry(item) for item in FORAGING.preconditions],
        "behaviours": [
            entry(item, colour=palette.css(palette.behaviour_colour(code)))
            for code, item in enumerate(FORAGING.behaviours)
        ],
        "internal_states": [entry(item) for item in FORAGING.internal_states],
        "probabilities": list(FORAGING.probabilities),
        "presets": [{"name": name, "title": load_preset(name).name} for name in preset_names()],
    }
