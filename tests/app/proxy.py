"""A proxy before the dashboard: it passes requests and websockets on, below a path."""

import asyncio
import threading


class Proxy:
    """Listens on a free port of the loopback address while it is entered.

    Attributes:
        target: Port that requests are passed on to.
        path: What it is reached below, without a slash at its end.
        keeps_path: True if it passes this on, too.
        host: What it passes on as the host; None for what it was asked for.
        context: For https.
    """

    def __init__(self, target=0, path="", keeps_path=False, host=None, context=None):
        self.target, self.path, self.keeps_path = target, path, keeps_path
        self.host, self.context = host, context
        self._loop = asyncio.new_event_loop()
        self._ends = set()
        self._started = threading.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._run(),))

    @property
    def address(self):
        scheme = "https" if self.context else "http"
        return f"{scheme}://127.0.0.1:{self.port}{self.path}"

    def __enter__(self):
        self._thread.start()
        assert self._started.wait(20)
        return self

    def __exit__(self, *_exception):
        self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join(20)
        self._loop.close()

    def drop(self):
        """End all that is under way."""
        self._loop.call_soon_threadsafe(lambda: [end.close() for end in self._ends])

    async def _run(self):
        self._ended = asyncio.Event()
        server = await asyncio.start_server(self._pass, "127.0.0.1", 0, ssl=self.context)
        self.port = server.sockets[0].getsockname()[1]
        self._started.set()
        await self._ended.wait()
        server.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

    async def _pass(self, reader, writer):
        there = None
        try:
            head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")
            from_there, there = await asyncio.open_connection("127.0.0.1", self.target)
            self._ends |= {writer, there}
            there.write(self._rewritten(head).encode("latin-1"))
            await asyncio.gather(_pump(reader, there), _pump(from_there, writer))
        except (OSError, asyncio.IncompleteReadError, asyncio.CancelledError):
            pass
        finally:
            for end in filter(None, (writer, there)):
                self._ends.discard(end)
                end.close()

    def _rewritten(self, head):
        request, *headers = head.split("\r\n")
        method, path, version = request.split(" ")
        if not self.keeps_path:
            path = "/" + path.removeprefix(self.path).removeprefix("/")
        if self.host is not None:
            headers = [
                f"Host: {self.host}" if line.lower().startswith("host:") else line
                for line in headers
            ]
        return "\r\n".join((f"{method} {path} {version}", *headers))


async def _pump(reader, writer):
    while data := await reader.read(65536):
        writer.write(data)
        await writer.drain()
    writer.close()
