"""Every door of the dashboard: pages, files and websockets, with and without the token."""

import http.client
import threading
import time
from contextlib import closing
from urllib.parse import urlsplit

import pytest
import viser

from geswarm.app.dashboard import open_dashboard
from geswarm.app.server.gate import CONTENT_TYPES, static_folder
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
}
FILES = [
    f"/{file.parent.name}/{file.name}"
    for file in sorted(static_folder().glob("*/*"))
    if file.suffix in CONTENT_TYPES and file.parent.name != "pictures"
]
PAGES = sorted({path.rpartition("/")[0] for path in FILES if path.endswith(".html")})
DOORS = [
    ("/", {}),
    ("/", {**UPGRADE, "Sec-WebSocket-Protocol": f"viser-v{viser.__version__}"}),
    *((path, {}) for path in FILES),
    *((f"{page}/socket", UPGRADE) for page in PAGES),
]
NAMES = [f"{'socket ' if headers else ''}{path}" for path, headers in DOORS]
at_every_door = pytest.mark.parametrize(("path", "headers"), DOORS, ids=NAMES)


@pytest.fixture(scope="module")
def dashboard():
    """A running dashboard that demands a token."""
    dashboard = open_dashboard(
        load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0, private=True
    )
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()


def ask(dashboard, path, headers):
    """Status, headers and text of one answer."""
    at = urlsplit(dashboard.address)
    with closing(http.client.HTTPConnection(at.hostname, at.port, timeout=20)) as connection:
        connection.request("GET", path, headers=headers)
        response = connection.getresponse()
        text = "" if response.status == 101 else response.read().decode(errors="replace")
        return response.status, response.headers, text


def cookie(dashboard):
    kept = ask(dashboard, f"/?token={dashboard.access.token}", {})[1]["Set-Cookie"]
    return {"Cookie": kept.partition(";")[0]}


def success(headers):
    return 101 if headers else 200


@at_every_door
def test_nobody_comes_in_without_the_token(dashboard, path, headers):
    for attempt in (path, f"{path}?token=wrong", f"{path}?{dashboard.access.token}"):
        status, answer, text = ask(dashboard, attempt, headers)
        assert status == 403
        assert text == "expected the token; open the whole address that geswarm-ui printed\n"
        assert answer["Set-Cookie"] is None


@at_every_door
def test_the_token_opens_by_address_and_by_cookie(dashboard, path, headers):
    by_address = ask(dashboard, f"{path}?token={dashboard.access.token}", headers)
    by_cookie = ask(dashboard, path, {**headers, **cookie(dashboard)})
    assert by_address[0] == by_cookie[0] == success(headers)


@at_every_door
def test_strangers_are_refused_though_they_bring_the_token(dashboard, path, headers):
    at, known = urlsplit(dashboard.address), {**headers, **cookie(dashboard)}
    own = {**known, "Origin": dashboard.address}
    assert ask(dashboard, path, own)[0] == success(headers)
    for stranger in (
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": f"http://localhost:{at.port}"},
        {"Host": f"evil.example:{at.port}"},  # a name that was rebound to this machine
        {"Host": f"evil.example:{at.port}", "Origin": f"http://evil.example:{at.port}"},
    ):
        assert ask(dashboard, path, {**known, **stranger})[0] == 403


def test_what_pages_make_on_demand_needs_the_token_too(dashboard):
    path = "/experiments/files/comparison.csv"
    assert ask(dashboard, path, {})[0] == 403
    assert ask(dashboard, path, cookie(dashboard))[0] != 403


@at_every_door
def test_every_answer_protects_its_reader(dashboard, path, headers):
    if headers:
        return
    answer = ask(dashboard, path, cookie(dashboard))[1]
    assert answer["X-Content-Type-Options"] == "nosniff"
    assert answer["Referrer-Policy"] == "no-referrer"
    policy = answer["Content-Security-Policy"]
    assert "frame-ancestors 'self'" in policy
    if path != "/":
        assert "default-src 'none'" in policy
        assert "script-src 'self'" in policy
        assert "unsafe" not in policy


def test_only_the_link_shows_the_token(dashboard):
    token = dashboard.access.token
    assert dashboard.link == f"{dashboard.address}/?token={token}"
    assert token not in dashboard.address
    assert token not in ask(dashboard, f"/?token={token}", {})[2]


@pytest.mark.browser
@pytest.mark.slow
def test_a_browser_needs_the_token_once(dashboard, browser):
    context = browser.new_context(viewport={"width": 1400, "height": 800})
    page = context.new_page()
    assert page.goto(dashboard.address).status == 403
    assert "expected the token" in page.inner_text("body")
    page.goto(dashboard.link)
    name = page.frame_locator("iframe[title='Rule table']").get_by_test_id("name")
    name.wait_for(timeout=60_000)
    page.wait_for_function("document.querySelector('canvas') !== null")
    deadline = time.monotonic() + 60
    while name.input_value() != "EVO 8":
        assert time.monotonic() < deadline
        page.wait_for_timeout(50)
    assert context.cookies()[0]["httpOnly"]
    assert page.evaluate("document.cookie") == ""
    assert page.goto(dashboard.address).status == 200
    context.close()
