"""A small server for the rule table page: the real edits on a rule set, and no swarm."""

import asyncio
import json
import threading
from dataclasses import replace
from http import HTTPStatus
from pathlib import Path

import websockets.asyncio.server
from websockets.datastructures import Headers
from websockets.http11 import Response

import geswarm
from geswarm.app.panels import rule_messages
from geswarm.app.state.document import RuleDocument
from geswarm.app.state.states import DrawnMachine
from geswarm.exports import brief_svg
from geswarm.rules import (
    EditError,
    RuleSet,
    RuleSetError,
    StateMachine,
    apply_edit,
    check,
    format_text,
    format_yaml,
    load_preset,
    parse_text,
    read_rule_set,
)
from geswarm.rules.as_json import rule_set_to_json
from geswarm.sim import load_scenario
from tests.app.wire import as_read, typed

STATIC = Path(geswarm.__file__).resolve().parent.parent / "static"
POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src *"
TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
}


class RulesServer:
    """Serves static/ and one rule set; `received` records what pages send.

    Attributes:
        answering: While False, messages are recorded but neither applied nor answered.
        greeting: While False, pages that come are told nothing.
        simpler: What the page is told could be simplified away; taking it removes the last rule.
    """

    def __init__(self, port=0, greeting=True):
        self.document = RuleDocument(load_preset("evo8"))
        self.loaded = self.document.rule_set
        self.simpler = 0
        self.received = []
        self.answering = True
        self.greeting = greeting
        self.port = port
        self._loop = asyncio.new_event_loop()
        self._clients = set()
        self._started = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        assert self._started.wait(10)
        return self

    def __exit__(self, *_exception):
        self.stop()

    def stop(self):
        if self._loop.is_closed():
            return
        self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}/rules/rules.html"

    @property
    def pages(self):
        """How many are connected."""
        return len(self._clients)

    @property
    def edits(self):
        return [message["edit"] for message in self.received if message["type"] == "edit"]

    def push(self, message):
        """Send a message to all pages, from any thread."""
        text = json.dumps(message)
        self._loop.call_soon_threadsafe(
            websockets.asyncio.server.broadcast, list(self._clients), text
        )

    def change(self, edit):
        """Another page makes an edit."""
        self.document.edit(typed(edit))
        self.push(self.rules())

    def show(self, rule_set):
        """Another page loads a rule set."""
        self.document.replace(rule_set)
        self.loaded = rule_set
        self.push(self.rules())

    def verdict(self, current, busy=False, runs=50, comparisons=(), version=None, **others):
        """Figures of these rules and of others, by role; a comparison is (role, difference, low,
        high, p)."""
        names = {"current": "these rules", "before": "before the edit", "evo8": "EVO 8"}
        samples = {"current": current, **others}
        fields = ("role", "difference", "low", "high", "p_value")
        self.push(
            {
                "type": "verdict",
                "version": self.document.version if version is None else version,
                "scenario": "paper",
                "runs": runs,
                "busy": busy,
                "samples": [
                    {"role": role, "name": names.get(role, role), "fitness": list(fitness)}
                    for role, fitness in samples.items()
                ],
                "comparisons": [dict(zip(fields, row, strict=True)) for row in comparisons],
            }
        )

    def worth(self, pieces, busy=False, total=None):
        """What pieces are worth: (rule, part, at, difference, low, high) each."""
        fields = ("rule", "part", "at", "difference", "low", "high")
        self.push(
            {
                "type": "worth",
                "version": self.document.version,
                "busy": busy,
                "done": len(pieces),
                "total": len(pieces) if total is None else total,
                "pieces": [dict(zip(fields, piece, strict=True)) for piece in pieces],
            }
        )

    def live(self, time, fired, behaviours=(2, 1, 1)):
        self.push(
            {
                "type": "live",
                "time": time,
                "fired": fired,
                "behaviours": behaviours,
                "robots": sum(behaviours),
            }
        )

    def states(self):
        """The state machine of the rules as they are now."""
        machine = StateMachine.of(self.document.rule_set)
        drawn = DrawnMachine(self.document.rule_set, machine, brief_svg(machine))
        self.push(as_read(rule_messages.states_message(drawn)))

    def activity(self, time, robots, taken, swarm=4):
        self.push(
            {"type": "activity", "time": time, "robots": robots, "taken": taken, "swarm": swarm}
        )

    def rules(self):
        rules = self.document.rule_set.rules
        findings = [
            {
                "rule": found.place.rule,
                "element": found.place.element,
                "message": found.message,
                "severity": found.severity,
            }
            for found in check(self.document.rule_set)
        ]
        return {
            "type": "rules",
            "version": self.document.version,
            "can_undo": self.document.can_undo,
            "can_redo": self.document.can_redo,
            "rule_set": rule_set_to_json(self.document.rule_set),
            "findings": findings,
            "english": [f"Sentence of rule {n}." for n, _ in enumerate(rules, start=1)],
            "text": format_text(self.document.rule_set),
            "rule_texts": [rule_text(rule) for rule in rules],
            "loaded": rule_set_to_json(self.loaded),
            "loaded_text": format_text(self.loaded),
            "simpler": self.simpler,
        }

    def _run(self):
        self._loop.run_until_complete(self._serve())
        self._loop.close()

    async def _serve(self):
        self._ended = asyncio.Event()
        serve = websockets.asyncio.server.serve
        async with serve(self._talk, "127.0.0.1", self.port, process_request=_page) as server:
            self.port = server.sockets[0].getsockname()[1]
            self._started.set()
            await self._ended.wait()
            server.close()

    async def _talk(self, connection):
        self._clients.add(connection)
        if self.greeting:
            await connection.send(json.dumps(vocabulary()))
            await connection.send(json.dumps(self.rules()))
        try:
            async for text in connection:
                message = json.loads(text)
                self.received.append(message)
                if self.answering:
                    self._answer(message)
        finally:
            self._clients.discard(connection)

    def _answer(self, message):
        match message:
            case {"type": "edit", "version": version} if version != self.document.version:
                self.push(self.rules())
                self.push({"type": "stale", "version": version, "text": "too late"})
                return
            case {"type": "edit", "edit": {"do": "paste_rules", "at": at, "text": text}}:
                rules = self.document.rule_set.rules
                pasted = parse_text(text).rules
                rules = (*rules[:at], *pasted, *rules[at:])
                self.document.replace(replace(self.document.rule_set, rules=rules))
            case {"type": "edit", "edit": edit}:
                try:
                    self.document.replace(apply_edit(self.document.rule_set, edit))
                except EditError as error:
                    self.push({"type": "notice", "level": "error", "text": str(error)})
            case {"type": "undo"}:
                self.document.undo()
            case {"type": "redo"}:
                self.document.redo()
            case {"type": "load_preset", "name": name}:
                self.document.replace(load_preset(name))
                self.loaded = self.document.rule_set
            case {"type": "load_text", "name": name, "text": text}:
                try:
                    self.document.replace(read_rule_set(text, name))
                except RuleSetError as error:
                    self.push({"type": "notice", "level": "error", "text": str(error)})
            case {"type": "save"}:
                text = format_yaml(self.document.rule_set)
                self.push({"type": "file", "name": "evo8.yaml", "text": text})
                return
            case {"type": "check_text", "text": text}:
                self.push({"type": "text_findings", "findings": text_findings(text)})
                return
            case {"type": "set_text", "text": text}:
                self.document.replace(parse_text(text))
            case {"type": "simplify"}:
                self.push(self.simplified())
                return
            case {"type": "take_simplified"}:
                self.document.replace(self.shorter())
                self.simpler = 0
            case {"type": "worth_start"} | {"type": "worth_cancel"}:
                return
        self.push(self.rules())

    def shorter(self):
        rule_set = self.document.rule_set
        return replace(rule_set, rules=rule_set.rules[:-1])

    def simplified(self):
        return {
            "type": "simplified",
            "version": self.document.version,
            "rule_set": rule_set_to_json(self.shorter()),
            "text": format_text(self.shorter()),
            "removed": [f"rule {len(self.document.rule_set.rules)}"],
        }


def rule_text(rule):
    text = format_text(RuleSet((rule,)))
    return text.split("\n", 2)[2]


def text_findings(text):
    try:
        parse_text(text)
    except RuleSetError as error:
        return [
            {
                "line": found.place.line,
                "rule": found.place.rule,
                "element": found.place.element,
                "message": found.message,
                "severity": found.severity,
            }
            for found in error.findings
        ]
    return []


def vocabulary():
    return {
        **as_read(rule_messages.vocabulary_message(load_scenario("paper"))),
        "presets": [
            {"name": "evo8", "title": "EVO 8"},
            {"name": "hand-coded", "title": "Hand-coded"},
        ],
    }


def _page(_connection, request):
    path = request.path.partition("?")[0]
    if path == "/rules/socket":
        return None
    if path == "/common/admitted":
        return Response(HTTPStatus.OK, "OK", Headers({"Content-Length": "0"}), b"")
    file = STATIC / path.removeprefix("/")
    if not (file.parent.parent == STATIC and file.suffix in TYPES and file.is_file()):
        return Response(HTTPStatus.NOT_FOUND, "Not Found", Headers(), b"")
    headers = Headers()
    headers["Content-Type"] = TYPES[file.suffix]
    headers["Content-Security-Policy"] = POLICY
    body = file.read_bytes()
    headers["Content-Length"] = str(len(body))
    headers["Connection"] = "close"
    return Response(HTTPStatus.OK, "OK", headers, body)
