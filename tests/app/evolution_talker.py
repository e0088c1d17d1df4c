"""Talks to an evolution page without a socket, as its pages do."""

import json
import time

import pytest

from geswarm.app.panels.evolution_page import EvolutionPage
from geswarm.app.state.evolution import EvolutionThread, Phase
from geswarm.app.state.session import Session
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.test_rule_page import Recorder

EVO8 = load_preset("evo8")


class Talker:
    """An evolution page without a socket; `last` is what it was told last, by type."""

    def __init__(self):
        quick = load_scenario("paper").with_changes(duration=20.0)
        self.session = Session(quick, EVO8, EvolutionThread(workers=1))
        self.page = EvolutionPage(self.session)
        self._hear, self._greet = self.page.channel.hear, self.page.channel.on_connect
        self.page.channel = Recorder()

    @property
    def evolution(self):
        return self.session.evolution

    def arrive(self):
        self._greet("client")
        self.session.frame(0.0, 1.0)

    def say(self, kind, **message):
        self._hear("client", json.dumps({"type": kind, **message}))
        self.session.frame(0.0, 1.0)
        self.page.sync(0.1)

    def last(self, kind):
        return self.page.channel.of(kind)[-1]

    def until(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited too long"
            self.say("watch")
            time.sleep(0.01)

    def rest(self):
        """Wait until the generation that was at work when the run was paused is done."""
        done = -1
        while done != len(self.evolution.history):
            done = len(self.evolution.history)
            time.sleep(0.5)

    def plan(self, **values):
        for name, value in values.items():
            self.say("plan", name=name, value=value)

    def evolve(self, **values):
        """A whole small run; returns its name."""
        self.plan(**{"population": 6, "generations": 3, "evaluations": 1, **values})
        self.say("start", instead=False)
        self.until(lambda: self.evolution.phase is Phase.FINISHED)
        name = self.evolution.directory.name
        self.until(lambda: self.run(name)["phase"] == "FINISHED")
        self.until(lambda: self.last("status")["shown"] == name)
        self.until(lambda: self.last("population")["generation"] == self.evolution.generations)
        return name

    def run(self, name):
        """How a run is listed now."""
        runs = {run["name"]: run for run in self.last("runs")["runs"]}
        return runs.get(name, {"phase": None})


@pytest.fixture(name="talker")
def talker_fixture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    talker = Talker()
    talker.arrive()
    yield talker
    talker.session.close()
