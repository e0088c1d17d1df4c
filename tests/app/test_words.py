"""A session in the words of another scenario than foraging, and from one to the other."""

import json
from types import SimpleNamespace

import pytest

from geswarm.app.dashboard import open_dashboard
from geswarm.app.panels.rule_page import RulePage
from geswarm.app.server.channel import Client
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.journal import Journal
from geswarm.app.state.references import first_rules
from geswarm.app.state.session import Session
from geswarm.rules import RuleSetError, load_preset
from geswarm.sim import load_scenario
from tests.app.test_journal import left_by_a_killed_one, wait_until
from tests.app.test_rule_page import Recorder
from tests.app.wire import typed

AAC, PAPER, XOR = map(load_scenario, ("aac", "paper", "xor"))
EVO8, BY_HAND = load_preset("evo8"), first_rules(AAC)
CLOSE_TO_FIVE = {
    "do": "set",
    "rule": 1,
    "part": "preconditions",
    "at": 0,
    "element": {
        "percept": {"name": "IS_CLOSE_TO", "arguments": [5]},
        "value": False,
        "comparison": "==",
    },
}


@pytest.fixture
def session(tmp_path):
    session = Session(AAC, BY_HAND, EvolutionThread(workers=1), journal=Journal(tmp_path))
    yield session
    session.close()


def test_the_run_before_comes_back_with_the_rules_that_it_ran(session):
    session.edit(typed(CLOSE_TO_FIVE))
    session.step()
    edited, state = session.document.rule_set, session.world.state
    session.set_scenario(PAPER)
    assert session.document.rule_set == session.world.rule_set == EVO8
    assert session.runs.plan.findings(session.scenario, session.document.rule_set) == {}
    session.take_back_reset()
    assert session.scenario == AAC
    assert session.document.rule_set == session.world.rule_set == edited
    assert session.world.state.x.tolist() == state.x.tolist()
    session.take_back_reset()  # to one that had not begun
    assert (session.scenario, session.document.rule_set) == (PAPER, EVO8)
    session.take_back_reset()
    session.set_scenario(AAC.with_changes(robots=10))  # the same terms: the rules stay
    assert session.document.rule_set == edited


def test_rules_that_are_known_in_both_scenarios_do_not_follow_into_the_run_before(session):
    session.set_scenario(XOR)
    session.set_text("rule do p = 1, STOP")  # aac knows these words too
    session.take_back_reset()
    assert session.document.rule_set == session.world.rule_set == BY_HAND
    session.frame(0.0, 1.0)
    wait_until(lambda: session.machine.drawn and session.machine.drawn.rule_set == BY_HAND)
    assert session.machine.drawn.machine.space.vocabulary is session.vocabulary


def test_unsaved_rules_in_other_words_are_told_and_stay(tmp_path):
    left_by_a_killed_one(tmp_path, EVO8)
    session = Session(AAC, BY_HAND, EvolutionThread(workers=1), journal=Journal(tmp_path))
    page = RulePage(session)
    hear, page.channel = page.channel.hear, Recorder()
    (unsaved,) = session.journal.left
    hear(Client(1, None), json.dumps({"type": "bring_back", "file": unsaved.path.name}))
    session.frame(0.0, 1.0)
    session.close()
    (notice,) = page.channel.of("notice")
    assert "EVO 8: aac does not offer" in notice["text"]
    assert session.document.rule_set == BY_HAND
    assert session.journal.left == (unsaved,)


def test_unsaved_rules_of_another_scenario_survive_a_kill(tmp_path):
    left_by_a_killed_one(tmp_path, BY_HAND)
    (unsaved,) = Journal(tmp_path).left
    assert unsaved.rule_set == BY_HAND
    session = Session(PAPER, EVO8, EvolutionThread(workers=1), journal=Journal(tmp_path))
    with pytest.raises(RuleSetError, match="paper does not offer IS_CLOSE_TO"):
        session.bring_back(unsaved)
    session.set_scenario(AAC)
    session.bring_back(unsaved)
    assert session.world.rule_set == BY_HAND
    session.close()


def test_a_replay_tells_rules_and_scenario(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dashboard, sent = open_dashboard(AAC, BY_HAND, "127.0.0.1", 0), []
    client = SimpleNamespace(send_file_download=lambda *file, **_: sent.append(file))
    dashboard.session.play()
    dashboard.recorder.start(dashboard.server, client)
    for _ in range(10):
        dashboard._frame(0.1)
    assert dashboard.stage._caption.text.endswith(" on black")
    dashboard.recorder.stop()
    dashboard.recorder.join()
    dashboard.close()
    ((name, content),) = sent
    assert name == "geswarm-aac-by-hand-in-aac-from-0-00.html"
    assert "aac, 20 robots, seed 0" in content.decode()
    assert "if IS_CLOSE_TO(3) == false" in content.decode()
