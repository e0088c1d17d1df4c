"""What a replay tells in words."""

import threading
from types import SimpleNamespace

import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.app.scene.replay import Passage, Setting, file_name, title_of, told
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import Rule, RuleSet, load_preset
from geswarm.sim import load_scenario
from tests.app.wire import typed

from .test_dashboard import PATIENCE, wait_until
from .test_session import HALF_P

PAPER = load_scenario("paper")
PAGE = "<html><head><title>Viser</title></head><body><script>'</body>'</script></body></html>"


@pytest.fixture
def session():
    session = Session(PAPER, load_preset("evo8"), EvolutionThread(workers=1))
    yield session
    session.close()


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    quick = PAPER.with_changes(duration=100.0)
    dashboard = open_dashboard(quick, load_preset("evo8"), "127.0.0.1", 0)
    yield dashboard
    dashboard.close()


def test_a_replay_is_named_after_rules_scenario_and_time(session):
    passages = [Passage(83.0, Setting.of(session))]
    assert title_of(passages) == "EVO 8 in paper from 1:23"
    assert file_name(passages) == "geswarm-evo-8-in-paper-from-1-23.html"
    assert "<title>EVO 8 in paper from 1:23 – GESwarm</title>" in told(PAGE, passages)
    session.compare_with("Hand-coded")
    assert (
        title_of([Passage(0.0, Setting.of(session))]) == "EVO 8 and Hand-coded in paper from 0:00"
    )


def test_names_of_any_kind_make_a_file_name_and_harm_no_page(session):
    session.load(RuleSet((Rule(comment="</pre><script>1</script>"),), name="a/b:\\<i>" + "é" * 300))
    passages = [Passage(0.0, Setting.of(session))]
    assert len(file_name(passages)) < 120
    assert not set(file_name(passages)) & set('/\\:<>"|?* ')
    page = told(PAGE, passages)
    assert "<script>1" not in page
    assert "<i>" not in page
    assert page.endswith("</aside></body></html>")


def test_the_rules_are_told_from_when_they_hold(dashboard):
    session, sent = dashboard.session, []
    client = SimpleNamespace(send_file_download=lambda *file, **_: sent.append(file))
    session.post(lambda _: dashboard.recorder.start(dashboard.server, client))
    dashboard._frame(0.1)
    session._advance(100, budget=60.0)
    session.post(lambda session: (session.play(), session.edit(typed(HALF_P))))
    dashboard._frame(0.2)
    assert session.world.steps > 100
    assert [passage.start for passage in dashboard.recorder.passages] == [0.0, 10.0]
    session.post(lambda session: session.compare_with("Hand-coded"))
    dashboard._frame(0.1)
    dashboard.recorder.stop()
    dashboard.recorder.join()
    ((name, content),) = sent
    page = content.decode()
    assert name == dashboard.recorder.file_name == "geswarm-evo-8-in-paper-from-0-00.html"
    assert page.count("<section>") == 3
    assert "do p = 0.05, RANDOM_WALK" in page
    assert "do p = 0.5, RANDOM_WALK" in page
    assert "these rules: EVO 8" in page


def labels(serializer):
    """Text of each label of a recording, as it is at the end of its first moment."""
    texts = {}
    for time, message in serializer._messages:
        if time == 0.0 and message["type"] == "LabelMessage":
            assert message["props"]["text"]
            texts[message["name"]] = message["props"]["text"]
        elif time == 0.0 and message.get("name") in texts and "text" in message.get("updates", {}):
            texts[message["name"]] = message["updates"]["text"]
    return texts


def test_the_first_moment_of_a_replay_has_its_clock_and_all_labels(dashboard):
    session, recorder = dashboard.session, dashboard.recorder
    session.compare_with("Hand-coded")
    session._advance(1005, budget=60.0)
    dashboard._frame(0.1)
    recorder.start(dashboard.server, None)
    dashboard._frame(0.1)
    world, rival = session.world, session.rival.swarm.world
    assert labels(recorder._serializer) == {
        "/arena/light/label": "light, 100 m north",
        "/rival/light/label": "light, 100 m north",
        "/arena/title": f"these rules: {world.fitness:.0f}",
        "/rival/title": f"Hand-coded: {rival.fitness:.0f}",
        "/caption": "1:40",
    }
    session.compare_with(None)
    session._advance(600, budget=60.0)
    dashboard._frame(0.1)
    assert dashboard.stage._caption.text.startswith("2:40 · ")
    recorder.stop()
    dashboard._frame(0.1)
    assert dashboard.stage._caption is None
    recorder.join()


@pytest.mark.browser
@pytest.mark.slow
def test_a_replay_in_a_browser_has_its_name_and_its_rules(dashboard, browser, tmp_path):
    sent = []
    client = SimpleNamespace(send_file_download=lambda *file, **_: sent.append(file))
    dashboard.session.post(lambda _: dashboard.recorder.start(dashboard.server, client))
    loop = threading.Thread(target=dashboard.run)
    loop.start()
    wait_until(lambda: dashboard.recorder.seconds > 1.0)
    dashboard.session.post(lambda _: dashboard.recorder.stop())
    wait_until(lambda: sent)
    dashboard.stop()
    loop.join(20)
    ((name, content),) = sent
    (tmp_path / name).write_bytes(content)
    page = browser.new_page(viewport={"width": 700, "height": 500})
    page.set_default_timeout(2 * PATIENCE)
    page.goto((tmp_path / name).as_uri())
    page.wait_for_selector("canvas")
    assert page.title() == "EVO 8 in paper from 0:00 – GESwarm"
    rules = page.get_by_text("do p = 0.001, ANTI-PHOTOTAXIS")
    rules.wait_for()
    page.locator("summary").click()
    rules.wait_for(state="hidden")
    page.close()
