"""A small server for the rule table page: the real edits on a rule set, and no swarm."""

import asyncio
import json
import threading
from http import HTTPStatus
from pathlib import Path

import websockets.asyncio.server
from websockets.datastructures import Headers
from websockets.http11 import Response

import geswarm
from geswarm.app.document import RuleDocument
from geswarm.rules import (
    FORAGING,
    EditError,
    RuleSetError,
    apply_edit,
    check,
    format_yaml,
    load_preset,
    read_rule_set,
)
from geswarm.rules.as_json import rule_set_to_json

STATIC = Path(geswarm.__file__).resolve().parent.parent / "static"
POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src *"
TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
}
COLOURS = ("#faa60a", "#1f63de", "#22b278")


class RulesServer:
    """Serves static/ and one rule set; `received` records what pages send.

    Attributes:
        answering: While False, messages are recorded but neither applied nor answered.
    """

    def __init__(self, port=0):
        self.document = RuleDocument(load_preset("evo8"))
        self.received = []
        self.answering = True
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
        self.document.edit(edit)
        self.push(self.rules())

    def show(self, rule_set):
        """Another page loads a rule set."""
        self.document.replace(rule_set)
        self.push(self.rules())

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

    def rules(self):
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
                self.push({"type": "notice", "level": "error", "text": f"stale {version}"})
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
            case {"type": "load_text", "name": name, "text": text}:
                try:
                    self.document.replace(read_rule_set(text, name))
                except RuleSetError as error:
                    self.push({"type": "notice", "level": "error", "text": str(error)})
            case {"type": "save"}:
                text = format_yaml(self.document.rule_set)
                self.push({"type": "file", "name": "evo8.yaml", "text": text})
                return
        self.push(self.rules())


def vocabulary():
    return {
        "type": "vocabulary",
        "preconditions": [
            {"name": entry.name, "holds": entry.holds, "fails": entry.fails}
            for entry in FORAGING.preconditions
        ],
        "behaviours": [
            {"name": entry.name, "doing": entry.doing, "colour": colour}
            for entry, colour in zip(FORAGING.behaviours, COLOURS, strict=True)
        ],
        "internal_states": [
            {"name": entry.name, "on": entry.on, "off": entry.off}
            for entry in FORAGING.internal_states
        ],
        "probabilities": list(FORAGING.probabilities),
        "presets": [
            {"name": "evo8", "title": "EVO 8"},
            {"name": "hand-coded", "title": "Hand-coded"},
        ],
    }


def _page(_connection, request):
    path = request.path.partition("?")[0]
    if path == "/rules/socket":
        return None
    file = STATIC / path.removeprefix("/rules/")
    if not (path.startswith("/rules/") and file.suffix in TYPES and file.is_file()):
        return Response(HTTPStatus.NOT_FOUND, "Not Found", Headers(), b"")
    headers = Headers()
    headers["Content-Type"] = TYPES[file.suffix]
    headers["Content-Security-Policy"] = POLICY
    body = file.read_bytes()
    headers["Content-Length"] = str(len(body))
    headers["Connection"] = "close"
    return Response(HTTPStatus.OK, "OK", headers, body)
