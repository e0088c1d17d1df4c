import contextlib
import http.client
import json
import socket
import threading
import time

import pytest
import viser
import websockets.sync.client
from websockets.asyncio.server import serve

from geswarm.app.protocol.base import FrameTime, NoticeMessage, Request
from geswarm.app.protocol.reading import MAX_MESSAGE_BYTES, Reader
from geswarm.app.server import channel as channel_module
from geswarm.app.server import gate
from geswarm.app.server.access import Access
from geswarm.app.server.channel import Channel
from geswarm.app.server.gate import ServerError, open_server

VISER_PROTOCOL = f"viser-v{viser.__version__}"
UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
}
VISER_SOCKET = ("/", {**UPGRADE, "Sec-WebSocket-Protocol": VISER_PROTOCOL})
RULES_SOCKET = ("/rules/socket", UPGRADE)
REQUESTS = {
    "viser page": ("/", {}),
    "rules page": ("/rules/page.html", {}),
    "viser socket": VISER_SOCKET,
    "rules socket": RULES_SOCKET,
}


@pytest.fixture(autouse=True)
def static(tmp_path, monkeypatch):
    folder = tmp_path / "static" / "rules"
    folder.mkdir(parents=True)
    (folder / "page.html").write_text("<!doctype html><title>ä</title>", encoding="utf-8")
    (folder / "page.js").write_text("1;")
    (folder / "private.py").write_text("secret")
    (folder / "folder.js").mkdir()
    for outside in (folder.parent, folder.parent / "common", folder.parent / "pictures"):
        outside.mkdir(exist_ok=True)
        (outside / "outside.js").write_text("shared")
    monkeypatch.setattr(gate, "static_folder", lambda: folder.parent)


def get(server, path, headers=(), host=None):
    """Status, headers and body of one GET, exactly as written (no normalised path)."""
    port = server.get_port()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    with contextlib.closing(connection):
        connection.putrequest("GET", path, skip_host=True, skip_accept_encoding=True)
        for name, value in {"Host": host or f"127.0.0.1:{port}", **dict(headers)}.items():
            connection.putheader(name, value)
        connection.endheaders()
        response = connection.getresponse()
        body = b"" if response.status == 101 else response.read()
        return response.status, response.headers, body


def connect(server, **options):
    address = f"ws://127.0.0.1:{server.get_port()}/rules/socket"
    return websockets.sync.client.connect(address, compression=None, open_timeout=20, **options)


def receive(socket):
    return json.loads(socket.recv(timeout=20))


def wait_until(condition):
    deadline = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < deadline, "waited 20 s in vain"
        time.sleep(0.01)


# Pages


def test_static_file(server):
    status, headers, body = get(server, "/rules/page.html?version=2")
    assert (status, body.decode()) == (200, "<!doctype html><title>ä</title>")
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Cache-Control"] == "no-store"
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'self'" in policy
    assert "unsafe" not in policy
    assert f"ws://127.0.0.1:{server.get_port()}" in policy


def test_script_has_the_type_that_nosniff_asks_for(server):
    assert get(server, "/rules/page.js")[1]["Content-Type"].startswith("text/javascript")


def test_what_all_pages_share_is_served(server):
    assert get(server, "/common/outside.js")[2] == b"shared"


def test_other_folders_are_not(server):
    assert get(server, "/pictures/outside.js")[2] != b"shared"


@pytest.mark.parametrize(
    "path",
    [
        "/rules/missing.js",
        "/rules/private.py",
        "/rules/folder.js",
        "/rules/../outside.js",
        "/rules/..%2foutside.js",
        "/rules/%2e%2e/outside.js",
        "/rules/..\\outside.js",
        "/rules//etc/passwd",
        "/rules/page.html%00.js",
        "/rules/socket",
    ],
)
def test_nothing_else_is_served(server, path):
    status, _, body = get(server, path)
    assert (status, body) == (404, b"not found\n")


def test_page_of_viser_is_served_and_cannot_be_framed_elsewhere(server):
    status, headers, body = get(server, "/")
    assert status == 200
    assert b"<html" in body
    assert headers["Content-Security-Policy"] == "frame-ancestors 'self'"


# Who is let in


@pytest.mark.parametrize("kind", REQUESTS)
def test_own_requests_are_let_in(server, kind):
    path, headers = REQUESTS[kind]
    own = {**headers, "Origin": f"http://127.0.0.1:{server.get_port()}"}
    status, answer, _ = get(server, path, own)
    assert status == (101 if "Upgrade" in headers else 200)
    assert answer["Sec-WebSocket-Protocol"] == headers.get("Sec-WebSocket-Protocol")


@pytest.mark.parametrize("kind", REQUESTS)
def test_foreign_host_is_refused(server, kind):
    path, headers = REQUESTS[kind]
    status, _, body = get(server, path, headers, host=f"evil.example:{server.get_port()}")
    assert status == 403
    assert b"does not answer to evil.example" in body
    assert body.count(b"\n") == 1


@pytest.mark.parametrize("kind", REQUESTS)
@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:1", "null"])
def test_foreign_origin_is_refused(server, kind, origin):
    path, headers = REQUESTS[kind]
    assert get(server, path, {**headers, "Origin": origin})[0] == 403


def test_no_client_can_open_a_share_tunnel(server, monkeypatch):
    monkeypatch.setattr("viser._viser.ViserTunnel", None)  # would fail if called
    assert server.request_share_url() is None


# Messages


class Note(Request, frozen=True):
    p: float = 0.0
    text: str = ""


def told(text):
    """What a page reads of a notice."""
    return {"type": "notice", "level": "info", "text": text}


@pytest.fixture
def arrived():
    return []


@pytest.fixture
def channel(arrived):
    channel = Channel(
        Reader({"note": Note, "frame_time": FrameTime}),
        on_message=lambda client, message: arrived.append((client.number, message)),
        on_refused=lambda client, why: channel.send(client, NoticeMessage("error", why)),
        on_connect=lambda client: channel.welcome(client),
    )
    return channel


def welcome(channel):
    """How many pages hear broadcasts."""
    return sum(client.welcome for client in channel.clients)


def test_messages_go_both_ways(server, channel, arrived):
    with connect(server) as one, connect(server) as two:
        one.send('{"type": "note", "p": 0.5}')
        wait_until(lambda: arrived and welcome(channel) == 2)
        number, message = arrived[0]
        assert message == Note(0.5)
        sender = next(client for client in channel.clients if client.number == number)
        channel.send(sender, NoticeMessage("info", "ä"))
        channel.broadcast(NoticeMessage("info", "all"))
        assert [receive(one), receive(one)] == [told("ä"), told("all")]
        assert receive(two) == told("all")
    wait_until(lambda: not channel.clients)
    channel.send(sender, NoticeMessage("info", "late"))
    channel.broadcast(NoticeMessage("info", "late"))


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        ("{", "not readable"),
        ("[1]", "expected a JSON object, got [1]"),
        ('{"type": "note", "p": NaN}', "not readable"),
        ('{"type": "note", "p": 1e999}', "note.p: number out of range"),
        ('{"type": "note", "text": "\\ud800"}', "not readable"),
        ("[" * 100_000, "expected a JSON object: Expected `object`, got `array`"),
        ("{}", "unknown message None; expected one of note"),
        ('{"type": "dance"}', "unknown message 'dance'; expected one of note"),
        ('{"type": "note", "q": 1}', "note: unknown field 'q'; expected p or text"),
        ('{"type": "note", "p": "x"}', "note.p: expected a number, got 'x'"),
        (b"\x00", "binary"),
        (json.dumps({"text": "x" * MAX_MESSAGE_BYTES}), f"at most {MAX_MESSAGE_BYTES}"),
    ],
    ids=lambda value: str(value)[:30],
)
def test_bad_message_is_answered_and_the_next_one_read(server, arrived, bad, why):
    with connect(server) as page:
        page.send(bad)
        answer = receive(page)
        assert (answer["type"], answer["level"]) == ("notice", "error")
        assert why in answer["text"]
        assert "Traceback" not in answer["text"]
        page.send('{"type": "note"}')
        wait_until(lambda: arrived)
        assert [message for _, message in arrived] == [Note()]


def test_longest_message_is_read(server, arrived):
    rest = len('{"type": "note", "text": ""}')
    message = {"type": "note", "text": "x" * (MAX_MESSAGE_BYTES - rest)}
    with connect(server) as page:
        page.send(json.dumps(message))
        wait_until(lambda: arrived)


def test_fault_of_the_app_is_logged_and_told(server, channel, caplog):
    def fail(client, message):
        raise ZeroDivisionError

    channel.on_message = fail
    with connect(server) as page:
        for _ in range(2):
            page.send('{"type": "note"}')
            assert "failed inside the app" in receive(page)["text"]
    assert "ZeroDivisionError" in caplog.text


def test_page_is_greeted(server, channel):
    channel.on_connect = lambda client: channel.send(client, NoticeMessage("info", "hello"))
    with connect(server) as page:
        assert receive(page) == told("hello")


def test_newer_live_message_replaces_an_unsent_one(server, channel):
    with connect(server) as page:
        wait_until(lambda: welcome(channel) == 1)
        entered, released = threading.Event(), threading.Event()

        def hold():
            entered.set()
            released.wait(20)

        server.get_event_loop().call_soon_threadsafe(hold)
        assert entered.wait(20)
        for number in range(100):
            channel.broadcast(NoticeMessage("info", str(number)), live=True)
        channel.broadcast(NoticeMessage("info", "last"))
        released.set()
        assert [receive(page), receive(page)] == [told("99"), told("last")]


def test_stuck_page_is_cut_off_and_slows_no_other(server, channel, monkeypatch):
    monkeypatch.setattr(channel_module, "MAX_WAITING", 8)
    with socket.create_connection(("127.0.0.1", server.get_port())) as stuck:
        lines = {"Host": f"127.0.0.1:{server.get_port()}", **UPGRADE}
        request = "".join(f"{name}: {value}\r\n" for name, value in lines.items())
        stuck.sendall(f"GET /rules/socket HTTP/1.1\r\n{request}\r\n".encode())
        wait_until(lambda: channel.clients)
        with connect(server) as page:
            wait_until(lambda: welcome(channel) == 2)
            sent = 0
            while len(channel.clients) == 2:
                assert sent < 500
                text = f"{sent} {'x' * 200_000}"
                channel.broadcast(NoticeMessage("info", text))
                assert receive(page)["text"] == text
                sent += 1


# Opening


def test_busy_port_becomes_the_next_and_is_told(server, channel):
    port = server.get_port()
    second = open_server(Access("127.0.0.1"), port, {"rules": channel}, "second")
    try:
        assert second.get_port() > port
        assert get(second, "/")[0] == 200
    finally:
        second.stop()


def test_localhost_is_the_loopback_address(channel):
    server = open_server(Access("localhost"), 0, {"rules": channel}, "test")
    try:
        assert get(server, "/", host=f"localhost:{server.get_port()}")[0] == 200
    finally:
        server.stop()


@pytest.mark.parametrize(
    ("host", "port", "message"),
    [
        ("127.0.0.1", 65536, "port: expected 0 to 65535, got 65536"),
        ("127.0.0.1", -1, "got -1"),
        ("no.such.host.invalid", 0, "cannot listen on 'no.such.host.invalid'"),
        ("192.0.2.1", 0, "cannot listen on '192.0.2.1'"),
    ],
)
def test_impossible_address_is_an_error_and_no_endless_wait(channel, host, port, message):
    with pytest.raises(ServerError, match=message):
        open_server(Access(host), port, {"rules": channel}, "test")


def test_wrapped_call_is_restored(server):
    assert websockets.asyncio.server.serve is serve


def test_viser_that_does_not_call_serve_is_told(channel, monkeypatch):
    monkeypatch.setattr(gate, "_wrapped_serve", lambda gate: contextlib.nullcontext())
    with pytest.raises(ServerError, match=r"viser .*serve was not called"):
        open_server(Access("127.0.0.1"), 0, {"rules": channel}, "test")


def test_viser_that_calls_serve_differently_is_told(channel, monkeypatch):
    class Different(viser.infra.WebsockServer):
        def __init__(self, **options):
            super().__init__(**{**options, "http_server_root": None})

    monkeypatch.setattr(viser.infra, "WebsockServer", Different)
    with pytest.raises(ServerError, match=r"viser .* could not be checked: serve\("):
        open_server(Access("127.0.0.1"), 0, {"rules": channel}, "test")


@pytest.mark.parametrize("sent", [b"HEAD / HTTP/1.1\r\nHost: x\r\n\r\n", b"\0\1\n\n", b""])
def test_who_does_not_speak_http_is_not_told_of(server, sent, caplog):
    with socket.create_connection(("127.0.0.1", server.get_port()), timeout=20) as stranger:
        stranger.sendall(sent)
        stranger.shutdown(socket.SHUT_WR)
        while stranger.recv(4096):
            pass
    assert get(server, "/rules/page.html")[0] == 200
    assert not [record for record in caplog.records if record.levelname == "ERROR"]
