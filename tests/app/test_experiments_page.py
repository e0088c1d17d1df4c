"""What the experiments page asks for and is told, without a browser."""

import csv
import http.client
import io
import json
import time
from urllib.parse import quote

import pytest

from geswarm.analysis.reproduction import Campaign, CampaignError
from geswarm.app.panels.evolution_panel import begin
from geswarm.app.panels.experiments_page import ExperimentsPage
from geswarm.app.server.access import Access
from geswarm.app.server.gate import open_server
from geswarm.app.state.campaign_folder import CampaignFolder
from geswarm.app.state.evolution import EvolutionThread, Phase
from geswarm.app.state.session import Session
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import format_text, load_preset, save_rule_set
from geswarm.sim import EvaluationStopped, load_scenario
from tests.app.experiments_campaign import finished_campaign
from tests.app.test_rule_page import Recorder

EVO8 = load_preset("evo8")
HAND_CODED = load_preset("hand-coded")
QUICK = load_scenario("paper").with_changes(duration=100.0)


class Talker:
    """An experiments page without a socket; `last` is what it was told last, by type."""

    def __init__(self):
        self.session = Session(QUICK, EVO8, EvolutionThread(workers=1))
        self.page = ExperimentsPage(self.session)
        self._hear, self._greet = self.page.channel.hear, self.page.channel.on_connect
        self.page.channel = Recorder()

    def arrive(self):
        self._greet("client")
        self.session.frame(0.0, 1.0)

    def say(self, kind, **message):
        self._hear("client", json.dumps({"type": kind, **message}))
        self.session.frame(0.0, 1.0)
        self.page.sync(0.6)

    def last(self, kind):
        return self.page.channel.of(kind)[-1]

    def until(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited too long"
            self.say("watch")
            time.sleep(0.01)

    def refused(self):
        return [notice["text"] for notice in self.page.channel.of("notice")]


@pytest.fixture
def talker(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    talker = Talker()
    talker.session.campaigns.rate = 1000.0
    talker.arrive()
    yield talker
    talker.session.close()


def chosen(talker, what):
    return [offer["name"] for offer in talker.last("choice")[what] if offer["chosen"]]


# Rule sets compared


def test_what_is_chosen_is_run_as_the_command_runs_it(talker):
    talker.say("choose", what="rules", name="table", on=False)
    talker.say("choice", name="against", value="Hand-coded")
    talker.say("choice", name="runs", value=5)
    talker.say("choice", name="seed", value=3)
    talker.say("compare")
    talker.until(lambda: not talker.last("compared")["busy"])
    compared = talker.last("compared")
    assert (compared["runs"], compared["seed"], compared["share"]) == (5, 3, 1.0)
    (scenario,) = compared["scenarios"]
    assert scenario["name"] == "arena"
    expected = evaluate_rule_sets([EVO8, HAND_CODED], QUICK, 5, 3, workers=1)
    found = [result["fitness"] for result in scenario["results"]]
    assert found == [evaluation.fitness.tolist() for evaluation in expected]
    assert [result["p_holm"] is None for result in scenario["results"]] == [False, True]
    document = json.loads(talker.page.made_file("comparison.json").body)
    for told, shown in zip(document["results"], scenario["results"], strict=True):
        assert told["objective"]["expression"] == "collected"
        assert {**told, **shown} == told
    rows = csv.DictReader(io.StringIO(talker.page.made_file("comparison.csv").body.decode()))
    assert [float(row["fitness"]) for row in rows] == found[0] + found[1]
    assert b"Plotly.newPlot" in talker.page.made_file("comparison.html").body
    assert talker.page.made_file("comparison.exe") is None


@pytest.mark.parametrize(
    ("name", "value"),
    [("runs", 1), ("runs", 1001), ("runs", 2.5), ("runs", "many"), ("runs", True), ("seed", -1)],
)
def test_what_cannot_be_run_is_said_and_not_run(talker, name, value):
    talker.say("choice", name=name, value=value)
    assert "expected a whole number from" in talker.last("choice")["findings"][name]
    talker.say("compare")
    assert talker.refused()[-1].startswith(f"{name}: expected a whole number")
    assert talker.session.comparison.progress is None
    assert talker.page.made_file("comparison.json") is None


def test_nothing_chosen_cannot_be_compared(talker):
    talker.say("choose", what="scenarios", name="arena", on=False)
    assert "scenarios" in talker.last("choice")["findings"]
    talker.say("choose", what="scenarios", name="moon", on=True)
    assert "there is no 'moon'" in talker.refused()[-1]


def test_a_file_is_offered_and_chosen_and_a_bad_one_is_not(talker):
    talker.say("file", name="mine.rules", text=format_text(HAND_CODED))
    assert chosen(talker, "rules")[-1] == "file mine.rules"
    talker.say("file", name="bad.rules", text="rule do p = 2, FLY")
    assert "bad.rules" in talker.refused()[-1]
    assert "file bad.rules" not in chosen(talker, "rules")


def test_the_best_of_a_run_is_offered_as_long_as_it_is_there(talker, tmp_path):
    best = tmp_path / "runs" / "first" / "best.yaml"
    best.parent.mkdir(parents=True)
    save_rule_set(HAND_CODED, best)
    talker.say("watch")
    talker.say("choose", what="rules", name="best of first", on=True)
    assert "best of first" in chosen(talker, "rules")
    best.write_text("not: rules")
    talker.say("compare")
    assert "best.yaml" in talker.refused()[-1]
    best.unlink()
    talker.say("watch")
    assert "best of first" not in chosen(talker, "rules")


@pytest.mark.parametrize(
    "change",
    [
        {"kind": "choice", "name": "runs", "value": 20},
        {"kind": "choose", "what": "scenarios", "name": "scalability-5", "on": True},
        {"kind": "compare"},
    ],
)
def test_why_a_comparison_failed_is_told_until_something_else_is_asked(talker, change, monkeypatch):
    def fails(*_, **__):
        raise MemoryError("too many robots")

    with monkeypatch.context() as patched:
        patched.setattr("geswarm.app.state.comparison.run_cases", fails)
        talker.say("compare")
        talker.until(lambda: not talker.last("compared")["busy"])
    assert talker.last("compared")["error"] == "MemoryError: too many robots"
    talker.say(**change)
    talker.until(lambda: talker.last("compared")["error"] == "")


def test_a_cancelled_comparison_is_over(talker):
    talker.say("choose", what="scenarios", name="scalability-20", on=True)
    talker.say("choice", name="runs", value=1000)
    talker.say("compare")
    assert talker.last("compared")["busy"]
    talker.say("cancel")
    assert not talker.last("compared")["busy"]
    time.sleep(0.2)
    talker.say("watch")
    assert not talker.last("compared")["busy"]


# Campaigns


def test_the_time_is_said_before_and_bad_values_are_not_begun(talker):
    quick = talker.last("draft")["seconds"]
    talker.say("draft", name="seed", value=7)
    talker.say("size", name="full")
    draft = talker.last("draft")
    assert draft["seconds"] > 50 * quick
    assert draft["values"] == {"runs": 10, "generations": 1000, "evaluations": 50, "seed": 7}
    assert [size["chosen"] for size in draft["sizes"]] == [False, True]
    for value in (0, 101, "ten", 2.5):
        talker.say("draft", name="runs", value=value)
        assert "expected" in talker.last("draft")["findings"]["runs"]
        assert talker.last("draft")["seconds"] is None
        talker.say("start")
        assert talker.refused()[-1].startswith("runs: expected")
    talker.say("size", name="huge")
    assert "expected quick or full, got 'huge'" in talker.refused()[-1]


def test_a_campaign_is_begun_stopped_and_gone_on_with(talker, tmp_path):
    for name, value in {"runs": 1, "generations": 100_000, "seed": 4}.items():
        talker.say("draft", name=name, value=value)
    talker.say("start")
    thread = talker.session.campaigns.thread
    talker.until(lambda: "generation" in talker.last("status")["doing"])
    name = talker.last("status")["name"]
    assert Campaign.at(tmp_path / "runs" / name).plan.seed == 4
    talker.say("start")
    assert talker.refused()[-1] == "a campaign is under way: stop it first"
    begin(talker.session)
    assert talker.session.evolution.phase is Phase.IDLE
    talker.until(lambda: len(talker.last("campaign")["curves"][0]["generation"]) > 0)
    part = talker.last("campaign")["parts"][0]
    assert (part["name"], part["total"]) == ("seed 4", 100_000)
    talker.say("stop")
    talker.until(lambda: talker.last("status")["phase"] == "STOPPED")
    talker.say("resume", name=name)
    talker.until(lambda: thread.phase is Phase.RUNNING and thread.share > 0)


def test_a_failed_campaign_says_why_and_can_go_on(talker, monkeypatch):
    def fails(*_, **__):
        raise ZeroDivisionError("no robots")

    monkeypatch.setattr(Campaign, "run", fails)
    talker.say("start")
    talker.until(lambda: talker.last("status")["phase"] == "FAILED")
    assert talker.last("status")["error"] == "ZeroDivisionError: no robots"

    def stops(*_, **__):
        raise EvaluationStopped

    monkeypatch.setattr(Campaign, "run", stops)
    talker.say("resume", name=talker.last("status")["name"])
    talker.until(lambda: talker.last("status")["phase"] == "STOPPED")
    assert talker.last("status")["error"] == ""


def test_no_campaign_beside_an_evolution(talker, monkeypatch):
    monkeypatch.setattr(EvolutionThread, "active", True)
    talker.say("start")
    assert "an evolution is under way" in talker.refused()[-1]


def test_a_campaign_is_looked_at(talker, tmp_path):
    finished_campaign(tmp_path / "runs" / "whole")
    (tmp_path / "runs" / "broken").mkdir()
    (tmp_path / "runs" / "broken" / "campaign.yaml").write_text("runs: many")
    talker.until(lambda: len(talker.last("campaigns")["campaigns"]) == 2)
    whole, broken = talker.last("campaigns")["campaigns"]
    assert (whole["name"], whole["reported"], whole["plan"]["runs"]) == ("whole", True, 10)
    assert "expected the keys" in broken["problem"]
    talker.say("open", name="whole")
    talker.until(lambda: talker.last("campaign")["name"] == "whole")
    look = talker.last("campaign")
    assert len(look["claims"]) == 14
    assert {claim["verdict"] for claim in look["claims"]} == {"HOLDS"}
    assert len(look["curves"]) == 10
    assert look["curves"][0]["best_so_far"] == [10, 20, 30]
    assert {level["name"]: level["mean"] for level in look["levels"]} == {
        "EVO 8": 100,
        "hand-coded": 65,
    }
    talker.say("open", name="../whole")
    assert "there is no campaign '../whole'" in talker.refused()[-1]


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("data/claims.csv", "where,paper\n"),
        ("data/claims.csv", "where,paper,found,verdict\na,b,c,perhaps\n"),
        ("data/performance.csv", "rules,collected\nEVO 8,many\n"),
        ("data/performance.csv", "rules,collected\nEVO 8\n"),
        ("evolution/seed-1/history.csv", "generation,best_so_far\n1,none\n"),
        ("evolution/seed-1/history.csv", "generation,best_so_far\n1,inf\n"),
    ],
)
def test_a_damaged_campaign_says_so(tmp_path, file, text):
    finished_campaign(tmp_path / "runs" / "whole")
    (tmp_path / "runs" / "whole" / file).write_text(text)
    with pytest.raises(CampaignError, match="cannot be read"):
        CampaignFolder(tmp_path / "runs").look("whole")


@pytest.mark.parametrize(
    "message",
    [
        {"type": "fly"},
        {"type": "choose", "what": "__class__", "name": "x", "on": True},
        {"type": "choose", "what": "rules", "name": 3, "on": True},
        {"type": "choice", "name": "rules", "value": 3},
        {"type": "choice", "name": "runs", "value": [1]},
        {"type": "file", "name": "x" * 256, "text": ""},
        {"type": "file", "name": "x", "text": None},
        {"type": "draft", "name": "workers", "value": 1},
        {"type": "draft", "name": "runs", "value": {}},
        {"type": "open", "name": "nowhere"},
        {"type": "resume", "name": ".."},
    ],
)
def test_bad_messages_are_answered_with_a_line(talker, message):
    kind = message.pop("type")
    talker.say(kind, **message)
    assert len(talker.refused()) == 1


# Files


def get(server, path):
    connection = http.client.HTTPConnection("127.0.0.1", server.get_port(), timeout=60)
    connection.request("GET", path)
    response = connection.getresponse()
    answer = response.status, response.headers["Content-Security-Policy"], response.read()
    connection.close()
    return answer


def test_reports_are_served_alone_and_nothing_else_is(talker, channel, tmp_path):
    name = "fünf & zehn"
    finished_campaign(tmp_path / "runs" / name)
    outside = tmp_path / "outside"
    finished_campaign(outside)
    (tmp_path / "runs" / "link").symlink_to(outside, target_is_directory=True)
    unfinished = Campaign.at(tmp_path / "runs" / "linked")
    (unfinished.directory / "report.html").symlink_to(outside / "report.html")
    made = {"experiments": talker.page.made_file}
    server = open_server(Access("127.0.0.1"), 0, {"experiments": channel}, "test", made)
    try:
        reports = "/experiments/files/report/"
        status, policy, body = get(server, reports + quote(name))
        assert status == 200
        assert body == (tmp_path / "runs" / name / "report.html").read_bytes()
        assert policy.startswith("sandbox allow-scripts; default-src 'none';")
        assert "connect-src" not in policy
        assert "allow-same-origin" not in policy
        for missing in ("nothing", "link", "linked", "..%2Foutside", "../outside", ""):
            assert get(server, reports + missing)[0] == 404
        assert get(server, "/experiments/files/comparison.json")[0] == 404
    finally:
        server.stop()
