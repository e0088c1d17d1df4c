"""The messages of `app.protocol` between Python and pages, over websockets on viser's loop."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable
from itertools import count

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from ..protocol.base import FrameTime, Message, NoticeMessage, Request
from ..protocol.reading import MessageError, Reader, encode

_SILENCE = 6.0  # s for which a page may say nothing
_LONGEST_FRAME = 3600.0
MAX_WAITING = 256
"""Messages that may wait for one page. One further behind is cut off: it connects again by itself
and is then sent everything afresh."""

logger = logging.getLogger(__name__)


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
        reader: Of what pages may say.
        on_message: Called with the sender and everything that it says.
        on_refused: Called with the sender and why what it said cannot be read.
        on_connect: Called when a page connects, before its first message.
    """

    def __init__(
        self,
        reader: Reader[Request],
        on_message: Callable[[Client, Request], None],
        on_refused: Callable[[Client, str], None],
        on_connect: Callable[[Client], None],
    ) -> None:
        self.reader = reader
        self.on_message = on_message
        self.on_refused = on_refused
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
            message: What it is told.
            live: Only the newest matters: an unsent live message of the same class is replaced.
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
        text = encode(message)
        slot = type(message) if live else object()

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
            self._call(client, self.on_connect, client)
            async for raw in connection:
                self.hear(client, raw)
        except ConnectionClosed:
            pass
        finally:
            del self._clients[client.number]
            delivery.cancel()

    def hear(self, client: Client, raw: str | bytes) -> None:
        """Take what a page said; on viser's event loop."""
        try:
            message = self.reader.read(raw)
        except MessageError as error:
            self._call(client, self.on_refused, client, str(error))
            return
        if isinstance(message, FrameTime):
            client.frame = frame_told(message)
        else:
            self._call(client, self.on_message, client, message)

    def _call(self, client: Client, callback: Callable[..., None], *arguments: object) -> None:
        """Call back; a fault of ours is logged and must not end the page's connection."""
        try:
            callback(*arguments)
        except Exception:
            logger.exception("a message of a page could not be handled")
            words = "this failed inside the app; its terminal shows why"
            self.send(client, NoticeMessage("error", words))


def frame_told(message: FrameTime) -> tuple[float, float] | None:
    """What a page says of the frames of its browser, as `Client.frame` holds it."""
    if message.milliseconds is None:
        return None
    return min(max(message.milliseconds / 1000.0, 0.0), _LONGEST_FRAME), time.monotonic()
