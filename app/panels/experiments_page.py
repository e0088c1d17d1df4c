"""The experiments page and the session, talking JSON (see static/experiments/protocol.js)."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from geswarm.analysis.reproduction import CampaignError
from geswarm.analysis.reproduction.results import format_samples
from geswarm.rules import RuleSetError

from ..server.channel import Channel, Client, Message
from ..server.gate import MadeFile
from ..state.comparison import ChoiceError
from ..state.session import Session
from . import experiments_messages as messages
from .evolution_messages import notice_message
from .evolution_page import MAX_NAME, WATCHED_SECONDS

REFRESH_SECONDS = 0.5
_REPORT = "report/"


class RequestError(ValueError):
    """A message of a page that cannot be carried out as it is; says why."""


class ExperimentsPage:
    """Carries out what pages ask for and keeps all of them up to date."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.channel = Channel(
            on_message=lambda client, message: session.post(
                lambda _: self._receive(client, message)
            ),
            on_connect=lambda client: session.post(lambda _: self._greet(client)),
        )
        self._watched = 0.0
        self._since_refresh = REFRESH_SECONDS
        self._seen: dict[str, tuple[object, ...]] = {}
        comparison, campaigns = session.comparison, session.campaigns
        self._carry_out: dict[str, Callable[[Message], str | None]] = {
            "watch": self._watch,
            "choose": lambda message: comparison.choose(
                _text(message, "what"), _text(message, "name"), message.get("on") is True
            ),
            "choice": self._choice,
            "file": lambda message: comparison.add_file(
                _text(message, "name"), _text(message, "text", longest=None)
            ),
            "compare": lambda _: comparison.start(session.document.rule_set, session.scenario),
            "cancel": lambda _: comparison.cancel(),
            "size": lambda message: campaigns.set_size(_text(message, "name")),
            "draft": lambda message: campaigns.set_value(_text(message, "name"), _value(message)),
            "start": lambda _: campaigns.start(),
            "stop": lambda _: campaigns.thread.stop(0.0),
            "resume": lambda message: campaigns.resume(_text(message, "name")),
            "open": lambda message: campaigns.open(_text(message, "name")),
        }

    def made_file(self, name: str) -> MadeFile | None:
        """A file to open or to keep; None if there is none of that name. From any thread.

        Args:
            name: `comparison` with .html, .csv or .json, or `report/` and the name of
                a campaign.
        """
        if name.startswith(_REPORT):
            try:
                report = self.session.campaigns.folder.report(name.removeprefix(_REPORT))
                return MadeFile(".html", report.read_bytes())
            except (CampaignError, OSError):
                return None
        progress = self.session.comparison.progress
        if progress is None or not progress.compared.samples:
            return None
        compared, document = progress.compared, progress.document
        make: dict[str, Callable[[], str]] = {
            "comparison.html": compared.page,
            "comparison.csv": lambda: format_samples(compared.samples),
            "comparison.json": lambda: json.dumps(document),
        }
        return MadeFile(Path(name).suffix, make[name]().encode()) if name in make else None

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        if self._watched <= 0.0:
            return
        self._watched -= elapsed
        self._since_refresh += elapsed
        if self._since_refresh >= REFRESH_SECONDS:
            self._since_refresh = 0.0
            self.session.campaigns.refresh()
            self.session.comparison.look_for_runs()
        for kind, (source, build) in self._sources().items():
            if self._seen.get(kind) != source:
                self._seen[kind] = source
                self.channel.broadcast(build(), live=True)

    def _sources(self) -> dict[str, tuple[tuple[object, ...], Callable[[], Message]]]:
        """By type of message: what it is made of, and how."""
        session, comparison = self.session, self.session.comparison
        campaigns, thread = session.campaigns, session.campaigns.thread
        table, arena = session.document.rule_set.name, session.scenario.name
        offered = tuple(comparison.rules_offered())
        return {
            "choice": (
                (comparison.choice, offered, table, arena),
                lambda: messages.choice_message(comparison, table, arena),
            ),
            "compared": (
                (comparison.progress,),
                lambda: messages.compared_message(comparison.progress),
            ),
            "draft": (
                (campaigns.draft, campaigns.rate),
                lambda: messages.draft_message(campaigns),
            ),
            "status": (
                (thread.phase, thread.directory, thread.doing),
                lambda: messages.status_message(campaigns),
            ),
            "campaigns": (
                (campaigns.kept, campaigns.shown),
                lambda: messages.campaigns_message(campaigns),
            ),
            "campaign": (
                (campaigns.look, campaigns.problem),
                lambda: messages.campaign_message(campaigns.look, campaigns.problem),
            ),
        }

    def _greet(self, client: Client) -> None:
        for _, build in self._sources().values():
            self.channel.send(client, build(), live=True)
        self.channel.welcome(client)
        self._watch({})

    def _watch(self, _message: Message) -> None:
        """A page is in view."""
        if self._watched <= 0.0:
            self._since_refresh = REFRESH_SECONDS
        self._watched = WATCHED_SECONDS

    def _receive(self, client: Client, message: Message) -> None:
        kind = str(message.get("type"))
        try:
            if kind not in self._carry_out:
                raise RequestError(f"unknown message {kind!r}")
            told = self._carry_out[kind](message)
        except (RequestError, ChoiceError, CampaignError, RuleSetError) as error:
            self.channel.send(client, notice_message(str(error)))
            for shown in ("choice", "draft"):  # what was typed is not what holds
                self.channel.send(client, self._sources()[shown][1](), live=True)
        else:
            if told:
                self.channel.send(client, notice_message(told, "info"))

    def _choice(self, message: Message) -> None:
        """Another number of runs, seed, or rule set to compare with."""
        name, comparison = _text(message, "name"), self.session.comparison
        if name == "against":
            comparison.change(against=_text(message, "value"))
        elif name == "runs":
            comparison.change(runs=_value(message))
        elif name == "seed":
            comparison.change(seed=_value(message))
        else:
            raise RequestError(f"expected against, runs or seed, got {name!r}")


def _text(message: Message, key: str, longest: int | None = MAX_NAME) -> str:
    text = message.get(key)
    if not isinstance(text, str) or (longest is not None and len(text) > longest):
        raise RequestError(f"{key}: expected a text of at most {MAX_NAME} characters")
    return text


def _value(message: Message) -> int | float | str:
    value = message.get("value")
    if not isinstance(value, int | float | str) or len(str(value)) > MAX_NAME:
        raise RequestError(f"value: expected a number, got {str(value)[:40]}")
    return value
