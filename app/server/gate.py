"""Everything on one port: viser's page and websocket, and our own pages beside them.

viser starts its server with `websockets.asyncio.server.serve`. That one call is wrapped while a
`viser.ViserServer` is constructed: every request is checked, paths below `/<page>/` and `/common/`
are ours, and all others go on to viser, whose page is served with our name and script in it. A path
that a proxy has put before these makes no difference.
"""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import io
import logging
import re
import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path
from typing import Any, TypeAlias, cast
from urllib.parse import parse_qs, unquote

import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from ..protocol.reading import MAX_MESSAGE_BYTES
from .access import Access
from .channel import Channel
from .guide import FOLDER as GUIDE
from .guide import guide_page
from .listening import ServerError, free_port
from .responses import CONTENT_TYPES, PROTECTION, plain, refused, response
from .viewer_page import served
from .viser_messages import is_expected

COMMON = "common"
"""The folder of static/ that all pages share."""

_ADMITTED = f"/{COMMON}/admitted"
"""Where a page asks whether websockets of its origin are let in, and if not, why."""

_VIEWER = re.compile(r".*/(index\.html|[^./]*)", re.DOTALL)
"""Paths of viser's page: they end in a slash, or in the name of a folder of a proxy's."""

_MADE_TYPES = {
    ".html": CONTENT_TYPES[".html"],
    ".csv": "text/csv; charset=utf-8",
    ".json": "application/json",
}

MAX_FRAME_BYTES = 4 * MAX_MESSAGE_BYTES
"""Of a websocket message: one that is longer is not read, and ends the connection. What is a little
too long for a page is read and answered."""

_ALONE = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
"""Policy of made files: no access to anything, not to the dashboard that serves and shows them."""

_MAX_TOLD = 20
"""Refusals of which the terminal tells; strangers can think of any number of names."""

_construction = threading.Lock()
_logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class MadeFile:
    """A file that the app makes when it is asked for.

    Attributes:
        suffix: Of its kind: .html, .csv or .json.
        body: Its content.
    """

    suffix: str
    body: bytes


MadeFiles: TypeAlias = Callable[[str], "MadeFile | None"]
"""The file of a name, or None if there is none; called on a thread of its own."""


class _Server(viser.ViserServer):
    """viser's server without its public share tunnel, which any client could ask for."""

    def request_share_url(self, verbose: bool = True) -> str | None:  # noqa: ARG002
        return None

    def stop(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):  # viser says that it has stopped
            super().stop()


class _NoTracebacks(logging.Filter):
    """What strangers send is no fault of ours: of what fails then, one line is enough."""

    def filter(self, record: logging.LogRecord) -> bool:
        if record.getMessage() == "opening handshake failed":  # a scan of ports, or HEAD
            return False
        if record.exc_info:
            record.msg, record.args = f"{record.getMessage()}: {record.exc_info[1]!r}", ()
            record.exc_info = None
        return True


_logger.addFilter(_NoTracebacks())


class Gate:
    """What stands between the port and viser."""

    def __init__(
        self,
        access: Access,
        pages: Mapping[str, Channel],
        static: Path,
        made: Mapping[str, MadeFiles],
    ) -> None:
        self.access = access
        self.made = {f"/{page}/files/": files for page, files in made.items()}
        self.sockets = {f"/{page}/socket": channel for page, channel in pages.items()}
        self.folders = [static / name for name in (COMMON, GUIDE, *pages)]
        names = "|".join(re.escape(folder.name) for folder in self.folders)
        self.ours = re.compile(rf".*(/(?:{names})/.+)", re.DOTALL)
        self.told: set[str] = set()
        self.widgets: Mapping[str, Any] = {}
        self.open = False
        self.used = False
        self.mismatch: str | None = None

    def wrap(self, serve: Callable[..., Any]) -> Callable[..., Any]:
        """`serve` with our checks, pages and websockets before those of the caller."""

        def guarded(handler: Any, *args: Any, **kwargs: Any) -> Any:
            self.used = True
            viser_process = kwargs.get("process_request")
            if not (callable(handler) and callable(viser_process)):
                # Raising here would leave viser's constructor waiting; the gate stays shut.
                self.mismatch = f"serve({handler!r}, *{args}, {', '.join(sorted(kwargs))})"
            kwargs["process_request"] = self._process(viser_process)
            kwargs |= {"max_size": MAX_FRAME_BYTES, "logger": _logger}
            return serve(self._route(handler), *args, **kwargs)

        return guarded

    def _route(self, viser_handler: Any) -> Callable[[ServerConnection], Any]:
        async def handler(connection: ServerConnection) -> None:
            channel = self.sockets.get(self._path(connection.request))
            if channel is not None:
                await channel.serve(connection)
            else:
                self._screen(connection)
                await viser_handler(connection)

        return handler

    def _screen(self, connection: ServerConnection) -> None:
        """Have viser receive only what it may be told."""
        receive = connection.recv

        async def recv() -> str | bytes:
            while not is_expected(raw := await receive(), self.widgets):
                pass
            return raw

        connection.recv = recv  # type: ignore[method-assign,assignment]

    def _process(self, viser_process: Any) -> Callable[[ServerConnection, Request], Any]:
        async def process(connection: ServerConnection, request: Request) -> Response | None:
            if not self.open:
                return plain(HTTPStatus.SERVICE_UNAVAILABLE, "the app is starting")
            port, path = connection.local_address[1], self._path(request)
            if path == _ADMITTED:
                request = _from_its_page(request)
            refusal = self.access.refusal(request, port)
            if refusal is not None:
                self._tell(request, port)
                return refused(request, refusal)
            answer = await self._made(path) or self._static(path, request)
            if answer is None and path not in self.sockets:
                answer = await _viser_answer(viser_process, connection, request, path)
            if answer is not None:
                cookie = self.access.cookie(request, port)
                for name, value in {**PROTECTION, **cookie}.items():
                    answer.headers.setdefault(name, value)
            return answer

        return process

    def _path(self, request: Request | None) -> str:
        """What a request is for, without the path of a proxy before it."""
        path = unquote(request.path.partition("?")[0]) if request is not None else ""
        ours, viewer = self.ours.fullmatch(path), _VIEWER.fullmatch(path)
        if ours is not None:
            return ours[1]
        return "/" if viewer is not None else path

    def _tell(self, request: Request, port: int) -> None:
        """Say in the terminal who was refused for where it came from, once."""
        stranger = self.access.stranger(request, port)
        if stranger is not None and stranger not in self.told and len(self.told) < _MAX_TOLD:
            self.told.add(stranger)
            _logger.warning("Refused: %s", stranger)

    async def _made(self, path: str) -> Response | None:
        """Answer to a request for a file that a page makes; None if it is something else."""
        for prefix, files in self.made.items():
            if path.startswith(prefix):
                file = await asyncio.to_thread(files, path.removeprefix(prefix))
                if file is None:
                    return plain(HTTPStatus.NOT_FOUND, "not found")
                policy = {"Content-Security-Policy": _ALONE}
                return response(HTTPStatus.OK, _MADE_TYPES[file.suffix], file.body, policy)
        return None

    def _static(self, path: str, request: Request) -> Response | None:
        """Answer to a request for a file of ours; None for a websocket, or if it is viser's."""
        if path in self.sockets and _is_websocket(request):
            return None
        if path == _ADMITTED:
            return plain(HTTPStatus.OK, "admitted")
        for folder in self.folders:
            if path.startswith(f"/{folder.name}/"):
                return static_response(folder, path, request.headers["Host"])
        return None


async def _viser_answer(
    viser_process: Any, connection: ServerConnection, request: Request, path: str
) -> Response | None:
    """Viser's answer; None for its websocket."""
    answer = viser_process(connection, Request(path, _without(request, "Accept-Encoding")))
    answer = await answer if inspect.isawaitable(answer) else answer
    if path != "/" or answer is None or answer.status_code != HTTPStatus.OK:
        return cast("Response | None", answer)
    page, packed = served(answer.body)
    if "gzip" in ",".join(request.headers.get_all("Accept-Encoding")):
        return response(HTTPStatus.OK, CONTENT_TYPES[".html"], packed, {"Content-Encoding": "gzip"})
    return response(HTTPStatus.OK, CONTENT_TYPES[".html"], page, {})


def _is_websocket(request: Request) -> bool:
    return request.headers.get_all("Upgrade") == ["websocket"]


def _from_its_page(request: Request) -> Request:
    """A question as the page's websocket would ask it: fetching, pages do not tell their origin."""
    headers = _without(request, "Origin")
    origin = parse_qs(request.path.partition("?")[2]).get("origin", [""])[0]
    headers["Origin"] = origin if origin.isascii() and origin.isprintable() else "null"
    return Request(request.path, headers)


def _without(request: Request, name: str) -> Headers:
    kept = request.headers.raw_items()
    return Headers([(key, value) for key, value in kept if key.lower() != name.lower()])


def open_server(
    access: Access,
    port: int,
    pages: Mapping[str, Channel],
    label: str,
    made: Mapping[str, MadeFiles] | None = None,
) -> viser.ViserServer:
    """Start viser behind the gate.

    Args:
        access: Address to listen on, and who is let in.
        port: Port to listen on, 0 for any free one; if it is busy, the next free one:
            `get_port()` of the result tells which.
        pages: Our own pages: the name of a folder of static/, served as `/<name>/`, and what
            handles the websocket `/<name>/socket`.
        label: Title of the control panel.
        made: Of pages that make files, served as `/<name>/files/...`: what makes them.

    Raises:
        ServerError: The address cannot be listened on, or this version of viser starts its server
            in a way that the gate does not know.
    """
    # Else two sockets, and any machine without IPv6 would fail on one.
    host = "127.0.0.1" if access.host == "localhost" else access.host
    port = free_port(host, port)
    gate = Gate(access, pages, static_folder(), made or {})
    with _construction, _wrapped_serve(gate), contextlib.redirect_stdout(io.StringIO()):
        # viser's banner is kept quiet: the app prints the address itself.
        server = _Server(host=host, port=port, label=label, verbose=False)
    if not gate.used or gate.mismatch:
        server.stop()
        raise ServerError(
            f"viser {viser.__version__} starts its server in a way unknown to geswarm, so that "
            "requests could not be checked: "
            f"{gate.mismatch or 'websockets.asyncio.server.serve was not called'}; "
            "install a version of viser that geswarm allows"
        )
    gate.widgets = server.gui._gui_input_handle_from_uuid
    gate.open = True
    return server


@contextlib.contextmanager
def _wrapped_serve(gate: Gate) -> Iterator[None]:
    original = websockets.asyncio.server.serve
    websockets.asyncio.server.serve = gate.wrap(original)  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # type: ignore[misc]


def static_folder() -> Path:
    """The folder of our pages: in the installed package, or beside app/ in a checkout."""
    here = Path(__file__).resolve().parents[1]
    for folder in (here / "static", here.parent / "static"):
        if folder.is_dir():
            return folder
    raise ServerError(f"the folder static/ is missing beside {here}; reinstall geswarm")


def static_response(folder: Path, path: str, host: str) -> Response:
    """A file of `folder`, whose name the path begins with; only the names in it are known.

    Args:
        folder: Flat folder; files with a suffix in CONTENT_TYPES are served, and nothing else but
            the pages of the guide.
        path: Decoded path of the request, `/<folder>/<file>`.
        host: `host:port` that the page may open websockets to.
    """
    name = path.removeprefix(f"/{folder.name}/")
    page = guide_page(folder, name.removesuffix(".html")) if folder.name == GUIDE else None
    known = {entry.name: entry for entry in folder.glob("*") if entry.suffix in CONTENT_TYPES}
    entry = known.get(name)
    if page is not None:
        suffix, body = ".html", page.encode()
    elif entry is not None and entry.is_file():
        suffix, body = entry.suffix, entry.read_bytes()
    else:
        return plain(HTTPStatus.NOT_FOUND, "not found")
    policy = (
        f"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        f"font-src 'self'; frame-src 'self'; connect-src 'self' ws://{host} wss://{host}; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )
    return response(
        HTTPStatus.OK,
        CONTENT_TYPES[suffix],
        body,
        {"Content-Security-Policy": policy},
    )
