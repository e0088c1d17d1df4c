"""viser's page as we serve it: its name and icon, and what it says where it cannot be shown."""

import gzip
import threading
from pathlib import Path

import pytest
import viser

from geswarm.app.dashboard import open_dashboard
from geswarm.app.server.viewer_page import named, served
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

PATIENCE = 60_000  # ms: the renderer works in software, on a small machine
PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
NO_WEBGL = """
    const made = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...how) {
      return kind.startsWith("webgl") ? null : made.call(this, kind, ...how);
    };
"""


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


def test_every_mark_in_the_page_of_this_viser_is_found():
    page = PAGE.read_text(encoding="utf-8")
    plain, packed = served(PAGE.read_bytes())
    assert gzip.decompress(packed) == plain
    text = plain.decode()
    assert text.count("<title>GESwarm</title>") == text.count("<title>") == 1
    assert text.count('href="common/icon.svg"') == text.count('rel="icon"') == 1
    assert "Viser</title>" not in text
    ours = text.index("/** Runs at the head of viser's page")
    assert text.index("<meta charset") < ours < text.index("<script data-p=")
    assert len(plain) > len(page)


def test_a_page_keeps_all_else_when_it_is_named():
    page = PAGE.read_text(encoding="utf-8")
    body = page.index("<script data-p=")
    assert named(page, "icon.svg").endswith(page[body:])


@pytest.mark.browser
@pytest.mark.slow
def test_without_webgl_the_pages_that_need_none_are_offered(dashboard, browser):
    context = browser.new_context()
    context.add_init_script(NO_WEBGL)
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(dashboard.link)
    page.get_by_role("heading", name="The arena needs WebGL").wait_for()
    assert page.title() == "GESwarm"
    links = page.get_by_role("main").get_by_role("link")
    assert [link.evaluate("link => link.href") for link in links.all()] == dashboard.page_links
    links.first.click()
    page.get_by_test_id("rule-4").wait_for()
    context.close()


@pytest.mark.browser
@pytest.mark.slow
def test_with_webgl_nothing_is_said_and_the_tab_bears_our_name(dashboard, page):
    page.set_default_timeout(PATIENCE)
    page.goto(dashboard.link)
    page.frame_locator("iframe[title='Rule table']").get_by_test_id("rule-4").wait_for()
    assert page.title() == "GESwarm"
    icon = page.evaluate("document.querySelector('link[rel=icon]').href")
    assert page.request.get(icon).text().startswith("<svg")
    assert page.locator(".geswarm-instead").count() == 0


@pytest.mark.browser
@pytest.mark.slow
def test_a_token_without_cookies_is_explained(dashboard, browser):
    context = browser.new_context()
    context.add_init_script("Object.defineProperty(navigator, 'cookieEnabled', {value: false})")
    page = context.new_page()
    page.goto(dashboard.link)
    page.get_by_role("heading", name="GESwarm needs a cookie here").wait_for(timeout=PATIENCE)
    context.close()
