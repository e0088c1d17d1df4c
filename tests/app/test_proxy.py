"""The dashboard behind a proxy: below a path, over https, under another name."""

import http.client
import json
import shutil
import ssl
import subprocess
import threading
from contextlib import closing

import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from geswarm.app.dashboard import open_dashboard
from geswarm.app.server.access import parse_name
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.proxy import Proxy

PATIENCE = 60_000  # ms: the renderer works in software, on a small machine
PATHS = ["", "/proxy/8080", "/user/jane.doe/rules-of-mine", "/rules"]
PAGES = ["rules", "evolution", "experiments"]


@pytest.fixture(scope="module")
def allowed():
    """A proxy that does not pass on the name under which it is asked, which is allowed."""
    with Proxy() as proxy:
        yield proxy


@pytest.fixture(scope="module")
def dashboard(allowed):
    """A running dashboard whose swarm stands still."""
    name = parse_name(f"127.0.0.1:{allowed.port}")
    dashboard = open_dashboard(
        load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0, names=[name]
    )
    allowed.target = dashboard.server.get_port()
    allowed.host = f"127.0.0.1:{allowed.target}"
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    yield dashboard
    dashboard.stop()
    loop.join(20)
    dashboard.close()


@pytest.fixture
def refused(dashboard):
    """As `allowed`, under a name that is not."""
    port = dashboard.server.get_port()
    with Proxy(port, host=f"127.0.0.1:{port}") as proxy:
        yield proxy


@pytest.fixture(scope="module")
def context(tmp_path_factory):
    """A certificate that nobody knows."""
    if shutil.which("openssl") is None:
        pytest.skip("no openssl")
    key, certificate = (tmp_path_factory.mktemp("tls") / name for name in ("key", "certificate"))
    made = f"-x509 -newkey rsa:2048 -nodes -subj /CN=here -keyout {key} -out {certificate}"
    subprocess.run(["openssl", "req", *made.split()], check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(certificate, key)
    return context


def get(proxy, path, headers=None):
    with closing(http.client.HTTPConnection("127.0.0.1", proxy.port, timeout=20)) as connection:
        connection.request("GET", path, headers=headers or {})
        response = connection.getresponse()
        return response.status, response.read().decode()


# Below a path


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("keeps_path", [False, True], ids=["path taken off", "path kept"])
def test_pages_files_and_sockets_are_found_below_any_path(dashboard, path, keeps_path):
    with Proxy(dashboard.server.get_port(), path, keeps_path) as proxy:
        assert "<title>GESwarm</title>" in get(proxy, f"{path}/")[1]
        for page in PAGES:
            assert f"{page.title()}" in get(proxy, f"{path}/{page}/{page}.html")[1]
            with connect(f"ws{proxy.address.removeprefix('http')}/{page}/socket") as socket:
                assert json.loads(socket.recv(timeout=20))["type"]
        assert get(proxy, f"{path}/common/icon.svg")[1].startswith("<svg")
        assert get(proxy, f"{path}/common/no.svg")[0] == 404
        protocol = f"viser-v{viser.__version__}"
        address = proxy.address.replace("http", "ws")
        with connect(f"{address}/", subprotocols=[protocol]) as socket:
            assert socket.recv(timeout=20)


@pytest.mark.parametrize("path", ["//rules/rules.html", "/index.html", "//", "/a//", "/a"])
def test_a_slash_too_many_or_too_few_does_no_harm(dashboard, path):
    with Proxy(dashboard.server.get_port(), keeps_path=True) as proxy:
        assert get(proxy, path)[0] == 200


def opens(page, address):
    """The three pages in the main window, one after the other."""
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    for title, name in (("Rule table", "Rules"), ("Evolution",) * 2, ("Experiments",) * 2):
        tab = page.get_by_role("tab", name=name, exact=True)
        tab.click()
        frame = page.frame_locator(f"iframe[title='{title}']")
        frame.locator("#header .title-bar").first.wait_for()
        frame.get_by_test_id("offline").wait_for(state="hidden")


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("keeps_path", [False, True], ids=["path taken off", "path kept"])
def test_the_main_window_opens_below_a_path_with_and_without_the_slash(dashboard, page, keeps_path):
    path = "/proxy/8080"
    with Proxy(dashboard.server.get_port(), path, keeps_path) as proxy:
        opens(page, proxy.address + ("/" if keeps_path else ""))


@pytest.mark.browser
@pytest.mark.slow
def test_the_main_window_opens_over_https(dashboard, browser, context):
    with Proxy(dashboard.server.get_port(), "/ges", context=context) as proxy:
        strange = browser.new_context(ignore_https_errors=True)
        opens(strange.new_page(), f"{proxy.address}/")
        strange.close()


# Under another name


def test_a_name_that_was_allowed_opens_pages_and_sockets(allowed, dashboard):
    origin = {"Origin": allowed.address}
    assert get(allowed, "/rules/rules.html", origin)[0] == 200
    assert get(allowed, f"/common/admitted?origin={allowed.address}")[0] == 200
    with connect(f"ws://127.0.0.1:{allowed.port}/rules/socket", origin=allowed.address) as socket:
        assert json.loads(socket.recv(timeout=20))["type"] == "vocabulary"


def test_whoever_is_refused_can_ask_why(refused):
    status, why = get(refused, f"/common/admitted?origin={refused.address}")
    assert status == 403
    assert why.endswith(f"start with --allow-host 127.0.0.1:{refused.port}\n")
    with pytest.raises(InvalidStatus):
        connect(f"ws://127.0.0.1:{refused.port}/rules/socket", origin=refused.address)
    for origin in ("null", "", "%0d%0aX:y", "%e2%80%a6", "http://evil.example"):
        assert get(refused, f"/common/admitted?origin={origin}")[0] == 403


def test_a_refused_page_says_what_to_do(refused):
    headers = {"Host": "lab.example.org", "Accept": "text/html,*/*"}
    refused.host = None
    status, text = get(refused, "/", headers)
    assert status == 403
    assert "<h1>" in text
    assert "start with --allow-host lab.example.org<" in text
    status, text = get(refused, "/", {"Host": "lab.example.org"})
    assert (status, text.count("\n")) == (403, 1)


def test_what_a_stranger_sends_is_no_markup(refused):
    headers = {"Origin": "http://<script>", "Accept": "text/html"}
    assert "&lt;script&gt;" in get(refused, "/", headers)[1]


def test_the_terminal_tells_of_each_stranger_once(dashboard, refused, caplog):
    refused.host = None
    for _ in range(3):
        get(refused, "/", {"Host": "stranger.example"})
        get(refused, "/", {"Origin": "http://stranger.example:81"})
    told = [line for line in caplog.messages if "stranger.example" in line]
    assert len(told) == 2
    assert told[0].endswith("start with --allow-host stranger.example")
    assert told[1].endswith("start with --allow-host stranger.example:81")
    for number in range(100):
        get(refused, "/", {"Host": f"{number}.stranger.example"})
    assert len(caplog.messages) < 30


@pytest.mark.browser
@pytest.mark.slow
def test_the_main_window_and_the_pages_say_that_they_are_refused(refused, browser):
    context = browser.new_context()
    page = context.new_page()
    for path in ("/", *(f"/{name}/{name}.html" for name in PAGES)):
        page.goto(refused.address + path)
        told = page.get_by_text(f"Refused: pages of {refused.address} may not use this app")
        told.wait_for(timeout=PATIENCE)
        assert f"start with --allow-host 127.0.0.1:{refused.port}" in told.inner_text()
    context.close()


@pytest.mark.browser
@pytest.mark.slow
def test_a_page_that_is_refused_later_says_so_until_it_is_let_in_again(dashboard, page):
    with Proxy(dashboard.server.get_port()) as proxy:
        page.goto(f"{proxy.address}/rules/rules.html")
        page.get_by_test_id("rule-4").wait_for(timeout=PATIENCE)
        proxy.host = "lab.example.org"
        proxy.drop()
        offline = page.get_by_test_id("offline")
        offline.get_by_text("start with --allow-host lab.example.org").wait_for()
        proxy.host = None
        offline.wait_for(state="hidden")
