"""JSON messages between app and rule-table pages, over websockets on viser's event loop."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import time
from collections.abc import Callable
from itertools import count
from typing import Any, TypeAlias

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

Message: TypeAlias = dict[str, Any]

MAX_MESSAGE_BYTES = 256 * 1024
FRAME_TIME = "frame_time"
"""Type of the message with which pages tell how fast their browser draws, every few seconds."""

_SILENCE = 6.0  # s for which a page may say nothing
_LONGEST_FRAME = 3600.0
MAX_WAITING = 256
"""Messages that may wait for one page. One further behind is cut off: it connects again by itself
and is then sent everything afresh."""

logger = logging.getLogger(__name__)


class MessageError(ValueError):
    """A message that cannot be read; the text is meant for the page that sent it."""


class Client:
    """One connected page.

    Attributes:
        number: Counts from 1 over the life of the channel.
        name: What the others are told who this is.
        welcome: Whether broadcasts go to it; see `Channel.welcome`.
        frame: Seconds per frame of its browser, and when it told; None if it is not looked at.
    """

    def __init__(self, number: int, connection: ServerConnection) -> None:
        self.number = number
        self.name = f"Browser {number}"
        self.welcome = False
        self.frame: tuple[float, float] | None = None
        self._connection = connection
        self._waiting: dict[object, str] = {}
        self._filled = asyncio.Event()

    def put(self, slot: object, text: str) -> None:
        """Queue `text`, in place of an unsent message of the same slot; event loop only."""
        self._waiting.pop(slot, None)
        if len(self._waiting) < MAX_WAITING:
            self._waiting[slot] = text
            self._filled.set()
        else:
            self._connection.transport.abort()

    async def deliver(self) -> None:
        """Send what is queued until the connection ends."""
        with contextlib.suppress(ConnectionClosed):
            while True:
                await self._filled.wait()
                self._filled.clear()
                while self._waiting:
                    await self._connection.send(self._waiting.pop(next(iter(self._waiting))))


class Channel:
    """All connected pages.

    Callbacks run on viser's event loop: they must do nothing but post a command.

    Attributes:
        on_message: Called with the sender and every JSON object that arrives.
        on_connect: Called when a page connects, before its first message.
    """

    def __init__(
        self,
        on_message: Callable[[Client, Message], None],
        on_connect: Callable[[Client], None] | None = None,
    ) -> None:
        self.on_message = on_message
        self.on_connect = on_connect
        self._clients: dict[int, Client] = {}
        self._numbers = count(1)
        self._loop: asyncio.AbstractEventLoop | None = None

    @property
    def clients(self) -> tuple[Client, ...]:
        """The pages connected now."""
        return tuple(self._clients.values())

    def slowest_frame(self) -> float | None:
        """Seconds per frame of the slowest browser that is looked at; None if there is none.

        One that has fallen silent is taken to be busy with a frame.
        """
        now = time.monotonic()
        told = [client.frame for client in self.clients if client.frame is not None]
        return max((max(frame, now - when - _SILENCE) for frame, when in told), default=None)

    def send(self, client: Client, message: Message, *, live: bool = False) -> None:
        """Queue a message for one page; from any thread.

        Args:
            client: A page; one that has gone is ignored.
            message: JSON object.
            live: Only the newest matters: an unsent live message of the same `type` is replaced.
        """
        self._post((client,), message, live)

    def welcome(self, client: Client) -> None:
        """From now on broadcasts go to this page too: it has been told how things stand."""
        client.welcome = True

    def broadcast(self, message: Message, *, live: bool = False) -> None:
        """Queue a message for every page made welcome; from any thread. Arguments as in `send`."""
        if clients := tuple(client for client in self.clients if client.welcome):
            self._post(clients, message, live)

    def _post(self, clients: tuple[Client, ...], message: Message, live: bool) -> None:
        if self._loop is None:
            return
        text = json.dumps(message, allow_nan=False, separators=(",", ":"))
        slot = ("live", message.get("type")) if live else object()

        def put() -> None:
            for client in clients:
                client.put(slot, text)

        with contextlib.suppress(RuntimeError):  # the server has stopped
            self._loop.call_soon_threadsafe(put)

    async def serve(self, connection: ServerConnection) -> None:
        """Handle one websocket until it closes."""
        self._loop = asyncio.get_running_loop()
        client = Client(next(self._numbers), connection)
        self._clients[client.number] = client
        delivery = asyncio.create_task(client.deliver())
        try:
            if self.on_connect is not None:
                self._call(client, self.on_connect, client)
            async for raw in connection:
                try:
                    message = parse_message(raw)
                except MessageError as error:
                    self.send(client, _error(str(error)))
                else:
                    if message.get("type") == FRAME_TIME:
                        client.frame = frame_told(message)
                    else:
                        self._call(client, self.on_message, client, message)
        except ConnectionClosed:
            pass
        finally:
            del self._clients[client.number]
            delivery.cancel()

    def _call(self, client: Client, callback: Callable[..., None], *arguments: object) -> None:
        """Call back; a fault of ours is logged and must not end the page's connection."""
        try:
            callback(*arguments)
        except Exception:
            logger.exception("a message of a rule-table page could not be handled")
            self.send(client, _error("this failed inside the app; its terminal shows why"))


def frame_told(message: Message) -> tuple[float, float] | None:
    """What a page says of the frames of its browser, as `Client.frame` holds it."""
    told = message.get("milliseconds")
    if isinstance(told, bool) or not isinstance(told, int | float):
        return None
    return min(max(told / 1000.0, 0.0), _LONGEST_FRAME), time.monotonic()


def parse_message(raw: str | bytes) -> Message:
    """The JSON object in a websocket message.

    Raises:
        MessageError: Too long, not text, not JSON, not an object, or with numbers or characters
            that JSON text in UTF-8 cannot hold.
    """
    size = len(raw if isinstance(raw, bytes) else raw.encode())
    if size > MAX_MESSAGE_BYTES:
        raise MessageError(f"message of {size} bytes; expected at most {MAX_MESSAGE_BYTES}")
    if isinstance(raw, bytes):
        raise MessageError("expected a text message with a JSON object, got a binary message")
    try:
        message = json.loads(raw)
        json.dumps(message, allow_nan=False, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise MessageError(f"expected a JSON object; this is not readable: {error}") from error
    if not isinstance(message, dict):
        raise MessageError(f"expected a JSON object, got {raw[:40]}")
    return message


def _error(text: str) -> Message:
    return {"type": "notice", "level": "error", "text": text}
