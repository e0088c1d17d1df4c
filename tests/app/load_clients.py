"""Ten people at one rule table, and pages that never read: `load_clients.py ADDRESS SECONDS`.

Each edits, takes back, plays and pauses every second or so. Prints one JSON object: the seconds
that each edit took until the rules with it came back, and how many had to be made again because
somebody else was faster.
"""

import asyncio
import json
import random
import sys
import time

import viser
from websockets.asyncio.client import connect

PEOPLE = 10
PAUSE = 1.0  # s, mean, between two edits of one person


class Person:
    """A page of the rule table, as far as the server can tell."""

    def __init__(self, number):
        self.random = random.Random(number)
        self.rules = None
        self.changed = asyncio.Event()
        self.stale = self.answered = False
        self.latencies, self.retries, self.live = [], 0, 0

    async def listen(self, socket):
        async for text in socket:
            message = json.loads(text)
            if message["type"] == "rules":
                self.rules = message
            elif message["type"] == "stale":
                self.stale = True
            elif message["type"] == "text_findings":
                self.answered = True
            elif message["type"] == "notice":
                raise AssertionError(message["text"])
            self.live += message["type"] == "live"
            self.changed.set()

    async def act(self, socket, until):
        while self.rules is None:
            await self.answer()
        while time.monotonic() < until:
            await asyncio.sleep(self.random.expovariate(1 / PAUSE))
            if self.random.random() < 0.1:
                key = self.random.choice("PPOXF")
                await socket.send(json.dumps({"type": "key", "key": key}))
            await self.edit(socket)

    async def edit(self, socket):
        start = time.monotonic()
        while True:
            version = self.rules["version"]
            self.stale = self.answered = False
            await socket.send(json.dumps({**self.some_change(), "version": version}))
            await socket.send('{"type": "check_text", "text": ""}')  # answered after the edit
            while not self.answered or self.rules["version"] == version:
                await self.answer()
            if not self.stale:
                break
            self.retries += 1
        self.latencies.append(time.monotonic() - start)

    async def answer(self):
        self.changed.clear()
        await asyncio.wait_for(self.changed.wait(), 60)

    def some_change(self):
        if self.rules["can_undo"] and self.random.random() < 0.2:
            return {"type": "undo"}
        rules = self.rules["rule_set"]["rules"]
        rule = self.random.randrange(len(rules))
        p = round(self.random.random(), 6)
        choices = [
            {"do": "set_enabled", "rule": rule, "enabled": not rules[rule]["enabled"]},
            {"do": "set_comment", "rule": rule, "comment": f"explained with {p}"},
            {"do": "set_name", "name": f"Rules {p}"},
        ]
        if actions := rules[rule]["actions"]:
            change = {"part": "actions", "at": 0, "element": {**actions[0], "p": p}}
            choices += 3 * [{"do": "set", "rule": rule, **change}]
        return {"type": "edit", "edit": self.random.choice(choices)}


async def never_read(address, path):
    """A page that connects and then hangs."""
    host, port = address.removeprefix("http://").split(":")
    reader, writer = await asyncio.open_connection(host, int(port), limit=1)
    writer.write(
        f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\n"
        f"Connection: Upgrade\r\nSec-WebSocket-Protocol: viser-v{viser.__version__}\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
    )
    await writer.drain()
    return reader, writer


async def run(address, seconds):
    stuck = [await never_read(address, path) for path in ("/", "/rules/socket")]
    until = time.monotonic() + seconds
    people = [Person(number) for number in range(PEOPLE)]

    async def take_part(person):
        at = address.replace("http", "ws") + "/rules/socket"
        async with connect(at, max_size=None, open_timeout=60) as socket:
            listening = asyncio.create_task(person.listen(socket))
            await person.act(socket, until)
            listening.cancel()

    await asyncio.gather(*map(take_part, people))
    for _, writer in stuck:
        writer.transport.abort()
    return {
        "latencies": sorted(second for person in people for second in person.latencies),
        "retries": sum(person.retries for person in people),
        "live": [person.live for person in people],
    }


if __name__ == "__main__":
    print(json.dumps(asyncio.run(run(sys.argv[1], float(sys.argv[2])))))
