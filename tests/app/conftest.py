"""Browser fixtures, shared by all browser tests; and a server behind the gate."""

import os
import shutil

import pytest

from geswarm.app.protocol.pages import reader_of
from geswarm.app.server.access import Access
from geswarm.app.server.channel import Channel
from geswarm.app.server.gate import open_server

CHROMIUM_NAMES = ("chromium", "chromium-browser", "google-chrome")
CHROMIUM_FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
VIEWPORT = {"width": 1200, "height": 800}
FEW_FRAMES = """{
  const ask = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => window.setTimeout(() => ask(draw), 80);
  window.cancelAnimationFrame = (asked) => window.clearTimeout(asked);
}"""
"""Pages draw ten times a second: without a graphics card each frame costs what others need."""


@pytest.fixture(scope="session", autouse=True)
def _no_journal_at_home(tmp_path_factory):
    """Dashboards of tests leave nothing where the user's own look for it."""
    os.environ["XDG_STATE_HOME"] = str(tmp_path_factory.mktemp("state"))


@pytest.fixture(scope="session")
def chromium():
    """Path of a Chromium; skips without one, or fails if GESWARM_REQUIRE_BROWSER=1."""
    path = os.environ.get("GESWARM_CHROMIUM") or next(
        filter(None, map(shutil.which, CHROMIUM_NAMES)), None
    )
    if path is not None and shutil.which(path):
        return path
    reason = f"no Chromium: {path or ', '.join(CHROMIUM_NAMES)} not found; set GESWARM_CHROMIUM"
    if os.environ.get("GESWARM_REQUIRE_BROWSER") == "1":
        pytest.fail(reason, pytrace=False)
    pytest.skip(reason)


# Not longer than a module: while Playwright runs, asyncio.run cannot be used in this process.
@pytest.fixture(scope="module")
def browser(chromium):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(CHROMIUM_FLAGS))
        new_context = browser.new_context

        def drawing_seldom(**options):
            context = new_context(**options)
            context.add_init_script(FEW_FRAMES)
            return context

        browser.new_context = drawing_seldom
        browser.new_page = lambda **options: drawing_seldom(**options).new_page()
        yield browser
        browser.close()


@pytest.fixture
def page(browser):
    """An empty page; the test fails if a script on it does."""
    context = browser.new_context(viewport=VIEWPORT)
    page = context.new_page()
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    context.close()
    assert not errors


@pytest.fixture
def channel():
    return Channel(
        reader_of("rules", watched=False),
        on_message=lambda client, message: None,
        on_refused=lambda client, why: None,
        on_connect=lambda client: None,
    )


@pytest.fixture
def server(channel):
    """viser behind the gate on a free port of the loopback address."""
    server = open_server(Access("127.0.0.1"), 0, {"rules": channel}, "test")
    yield server
    server.stop()
