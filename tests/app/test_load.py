"""Ten people and a browser at one dashboard: nothing is lost, and memory does not grow.

GESWARM_LOAD_MINUTES is how long (default 1). The figures are printed: pytest -m long -s -k load.
"""

import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from statistics import median

import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

MINUTES = float(os.environ.get("GESWARM_LOAD_MINUTES", "1"))
CLIENTS = Path(__file__).with_name("load_clients.py")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory as Linux tells it"),
]


def memory():
    """Resident memory of this process, MB."""
    status = Path("/proc/self/status").read_text()
    (line,) = [line for line in status.splitlines() if line.startswith("VmRSS")]
    return int(line.split()[1]) / 1024


class Watch:
    """Counts frames and looks at the memory, while a dashboard runs."""

    def __init__(self, dashboard, monkeypatch):
        self.frames, self.samples = [], []
        sync = dashboard.stage.sync
        monkeypatch.setattr(dashboard.stage, "sync", lambda elapsed: self._sync(sync, elapsed))

    def _sync(self, sync, elapsed):
        sync(elapsed)
        now = time.monotonic()
        self.frames.append(now)
        if not self.samples or now - self.samples[-1][0] > 1.0:
            self.samples.append((now, memory()))

    def growth(self):
        """MB per minute in the second half: a line through the samples, by least squares."""
        late = self.samples[len(self.samples) // 2 :]
        times = [(at - late[0][0]) / 60 for at, _ in late]
        mean_time = sum(times) / len(late)
        mean = sum(size for _, size in late) / len(late)
        products = sum(
            (at - mean_time) * (size - mean) for at, (_, size) in zip(times, late, strict=True)
        )
        return products / sum((at - mean_time) ** 2 for at in times)

    def report(self, what, **figures):
        """Print what was measured."""
        spent = self.frames[-1] - self.frames[0]
        gaps = sorted(b - a for a, b in zip(self.frames, self.frames[1:], strict=False))
        figures |= {
            "minutes": spent / 60,
            "frames per second": len(gaps) / spent,
            "frame p95, ms": 1000 * gaps[int(0.95 * len(gaps))],
            "memory at half time, MB": self.samples[len(self.samples) // 2][1],
            "memory at the end, MB": self.samples[-1][1],
            "growth in the second half, MB/min": self.growth(),
        }
        print(f"\n{what}:", ", ".join(f"{name} {value:.4g}" for name, value in figures.items()))


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dashboard = open_dashboard(load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0)
    yield dashboard
    dashboard.stop()
    dashboard.close()


def runs(dashboard):
    dashboard.session.post(lambda session: session.play())
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    return loop


@pytest.mark.browser
def test_ten_people_edit_and_play(dashboard, browser, tmp_path, monkeypatch):
    watch = Watch(dashboard, monkeypatch)
    loop = runs(dashboard)
    page = browser.new_page(viewport={"width": 1400, "height": 800})
    page.set_default_timeout(180_000)  # on a busy machine
    page.goto(dashboard.address)
    page.frame_locator("iframe[title='Rule table']").get_by_test_id("rule-4").wait_for()
    command = [sys.executable, CLIENTS, dashboard.address, str(60 * MINUTES)]
    with (tmp_path / "told.json").open("w") as file:
        clients = subprocess.Popen(command, stdout=file)
        while clients.poll() is None:
            page.wait_for_timeout(1000)
    told = json.loads((tmp_path / "told.json").read_text())
    dashboard.stop()
    loop.join(60)
    latencies = told["latencies"]
    watch.report(
        "Ten people",
        edits=len(latencies),
        retries=told["retries"],
        **{
            "edit median, ms": 1000 * median(latencies),
            "edit p95, ms": 1000 * latencies[int(0.95 * len(latencies))],
            "live messages per second": sum(told["live"]) / len(told["live"]) / 60 / MINUTES,
        },
    )
    page.close()
    assert clients.returncode == 0
    assert dashboard.session.document.version > len(latencies)
    assert min(told["live"]) > 0
    assert watch.growth() < 60 / MINUTES  # MB per minute; a short run is still filling its caches


@pytest.mark.browser
def test_evolution_with_the_dashboard_open(dashboard, browser, monkeypatch):
    watch = Watch(dashboard, monkeypatch)
    loop = runs(dashboard)
    page = browser.new_page(viewport={"width": 1400, "height": 800})
    page.set_default_timeout(180_000)  # on a busy machine
    page.goto(dashboard.address)
    start = page.get_by_role("button", name="Start evolution")
    start.click()
    end = time.monotonic() + 60 * MINUTES
    while time.monotonic() < end:
        page.wait_for_timeout(1000)
        if start.is_visible():  # a run has come to its end: the next one
            start.click()
    dashboard.stop()
    loop.join(60)
    histories = Path("runs").glob("*/history.csv")
    generations = sum(len(history.read_text().splitlines()) - 1 for history in histories)
    watch.report("Evolution", generations=generations)
    page.close()
    assert generations > 0
    assert watch.growth() < 60 / MINUTES
