"""The experiments page in a real browser, with real runs behind it."""

import json
import re
import threading
from pathlib import Path

import pytest

from geswarm.analysis.reproduction import Campaign
from geswarm.app.panels.experiments_page import ExperimentsPage
from geswarm.app.server.access import Access
from geswarm.app.server.gate import open_server
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.experiments_campaign import finished_campaign

sync_api = pytest.importorskip("playwright.sync_api")
expect = sync_api.expect
pytestmark = pytest.mark.browser

FRAME = 0.02


class Served:
    """A session with the experiments page on a free port, without arena and panels."""

    def __init__(self):
        scenario = load_scenario("paper").with_changes(duration=100.0)
        self.session = Session(scenario, load_preset("evo8"), EvolutionThread(workers=1))
        self.page = ExperimentsPage(self.session)
        pages, made = {"experiments": self.page.channel}, {"experiments": self.page.made_file}
        self.server = open_server(Access("127.0.0.1"), 0, pages, "test", made)
        self.address = f"http://127.0.0.1:{self.server.get_port()}/experiments/experiments.html"
        self._stop = threading.Event()
        self._loop = threading.Thread(target=self._run)
        self._loop.start()

    def _run(self):
        while not self._stop.wait(FRAME):
            self.session.frame(0.0, FRAME)
            self.page.sync(FRAME)

    def close(self):
        self._stop.set()
        self._loop.join(20)
        self.session.close()
        self.server.stop()
        assert not self._loop.is_alive()


@pytest.fixture
def served(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    served = Served()
    yield served
    served.close()


@pytest.fixture
def page(browser, served):
    """The page; nothing in it may complain, a blocked script or style included."""
    context = browser.new_context(viewport={"width": 600, "height": 870})
    context.set_default_timeout(60_000)
    expect.set_options(timeout=60_000)
    complaints = []
    context.on("weberror", lambda error: complaints.append(str(error.error)))
    context.on("console", lambda one: complaints.append(one.text) if one.type == "error" else None)
    page = context.new_page()
    page.goto(served.address)
    expect(page.get_by_test_id("rules-1")).to_be_visible()
    yield page
    context.close()
    assert complaints == []


def test_rule_sets_are_compared_and_saved(page, tmp_path):
    bad = {"name": "bad.yaml", "mimeType": "text/yaml", "buffer": b"rules: ["}
    page.get_by_test_id("file").set_input_files(bad)
    expect(page.get_by_test_id("notice-error")).to_contain_text("bad.yaml")
    page.get_by_test_id("runs").fill("1")
    page.get_by_test_id("runs").press("Tab")
    expect(page.get_by_test_id("runs-error")).to_contain_text("expected a whole number from 2")
    expect(page.get_by_test_id("notice-error")).to_have_count(0)
    expect(page.get_by_test_id("compare-start")).to_be_disabled()
    page.get_by_test_id("runs").fill("4")
    page.get_by_test_id("runs").press("Enter")
    mine = tmp_path / "<b>mine.rules"
    mine.write_text("rule do p = 0.1, RANDOM_WALK")
    page.get_by_test_id("file").set_input_files(mine)
    expect(page.get_by_label("file <b>mine.rules")).to_be_checked()
    page.get_by_label("Hand-coded").uncheck()
    page.get_by_test_id("against").select_option("EVO 8")
    page.get_by_test_id("compare-start").click()
    rows = page.get_by_test_id("boxes-arena").locator(".box-row")
    expect(rows).to_have_count(3)
    expect(rows.locator("circle")).to_have_count(12)
    expect(rows.nth(1)).to_have_class(re.compile("reference"))
    expect(page.get_by_test_id("explanation")).to_contain_text("Mann-Whitney against EVO 8")
    expect(page.get_by_test_id("explanation")).to_contain_text("p Holm < 0.001")
    with page.expect_download() as download:
        page.get_by_test_id("save-json").click()
    document = json.loads(Path(download.value.path()).read_text(encoding="utf-8"))
    names = [result["rules"] for result in document["results"]]
    assert names == ["table", "EVO 8", "file <b>mine.rules"]
    page.reload()
    expect(rows).to_have_count(3)
    expect(page.get_by_test_id("runs")).to_have_value("4")


def test_a_file_that_is_not_utf_8_is_refused(page):
    with page.expect_file_chooser() as chooser:
        page.get_by_test_id("open-file").click()
    data = 'name "Förder" rule do p = 0.1, PHOTOTAXIS'.encode("latin-1")
    chooser.value.set_files({"name": "latin1.rules", "mimeType": "text/plain", "buffer": data})
    expect(page.get_by_test_id("notice-error")).to_have_text("latin1.rules: not UTF-8 at byte 7.")
    expect(page.get_by_label("file latin1.rules")).to_have_count(0)


def test_a_campaign_is_opened_and_its_report_read_in_a_new_tab(page, tmp_path):
    finished_campaign(tmp_path / "runs" / "whole & old")
    page.get_by_test_id("tab-campaigns").click()
    page.get_by_role("button", name="whole & old", exact=True).click()
    claims = page.get_by_test_id("claims").locator("tbody tr")
    expect(claims).to_have_count(14)
    expect(claims.first).to_contain_text("holds")
    expect(page.locator(".chart path.line")).to_have_count(10)
    page.get_by_test_id("figures").locator("summary").click()
    inside = page.frame_locator("[data-testid=report]")
    for figure, number in {"2b": 12, "3a": 9, "3b": 9}.items():
        expect(inside.locator(f"#figure-{figure} .boxlayer path.box")).to_have_count(number)
    with page.context.expect_page() as opened:
        page.get_by_test_id("report-1").click()
    report = opened.value
    expect(report.locator("#figure-2a .scatterlayer .trace")).to_have_count(10)
    assert report.evaluate("window.origin") == "null"
    with page.expect_download() as download:
        page.get_by_test_id("save-report-1").click()
    assert download.value.suggested_filename == "whole & old.html"


def test_a_campaign_is_started_watched_stopped_and_gone_on_with(page, tmp_path):
    page.get_by_test_id("tab-campaigns").click()
    expect(page.get_by_test_id("draft-time")).to_contain_text("takes about")
    for name, value in {"runs": 1, "generations": 5000}.items():
        page.get_by_test_id(f"draft-{name}").fill(str(value))
        page.get_by_test_id(f"draft-{name}").press("Tab")
    page.get_by_test_id("campaign-start").click()
    expect(page.get_by_test_id("status")).to_contain_text("seed 1, generation")
    expect(page.get_by_test_id("parts")).to_contain_text(re.compile(r"[1-9]\d* of 5000"))
    expect(page.locator(".chart path.line")).to_have_count(1)
    page.get_by_test_id("stop").click()
    expect(page.get_by_test_id("status")).to_contain_text("stopped")
    page.reload()
    page.get_by_test_id("tab-campaigns").click()
    page.get_by_test_id("go-on").click()
    expect(page.get_by_test_id("campaign-1")).to_contain_text("running")
    (directory,) = (tmp_path / "runs").iterdir()
    assert Campaign.at(directory).plan.generations == 5000
