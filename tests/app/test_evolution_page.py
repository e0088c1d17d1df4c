"""What the evolution page asks for and is told, without a socket."""

from pathlib import Path

import pytest

from geswarm.app.docstrings import explanations
from geswarm.app.panels.evolution_messages import (
    MOST_POINTS,
    form_message,
    histogram,
    how_bred,
    thinned,
)
from geswarm.app.panels.evolution_panel import begin, status_html
from geswarm.app.panels.page import WATCHED_SECONDS
from geswarm.app.protocol.reading import encode
from geswarm.app.state.evolution import Phase
from geswarm.app.state.rival import CHOSEN
from geswarm.app.state.runs import MOST_COMPARED
from geswarm.evolution import ScenarioFitness
from geswarm.ge import Settings, StoredIndividual
from tests.app.evolution_talker import EVO8, talker_fixture
from tests.app.wire import typed

__all__ = ["talker_fixture"]


def test_a_page_that_arrives_is_told_everything(talker):
    kinds = [message["type"] for message in talker.page.channel.messages]
    assert kinds == [
        "form", "plan", "status", "curves", "compared", "population", "ancestors", "runs", "chosen",
    ]  # fmt: skip
    fields = {field["name"]: field for field in talker.last("form")["fields"]}
    assert fields["population"]["kind"] == "whole"
    assert fields["selection"]["choices"] == ["roulette", "tournament"]
    assert fields["share_evaluations"]["kind"] == "switch"
    assert fields["mutation"]["steerable"]
    plan = talker.last("plan")
    assert (plan["preset"], plan["scenario"], plan["table"]) == ("paper", "paper", "EVO 8")
    assert [rule["frozen"] for rule in plan["rules"]] == [False] * 4
    assert talker.last("status")["phase"] == "IDLE"


def test_every_parameter_has_an_explanation():
    assert all(field.help for field in form_message().fields)
    assert explanations(Settings)["population"] == "Individuals per generation."
    assert explanations(Settings)["initialisation"].endswith("(Fagan et al. 2016).")


def test_nothing_is_looked_up_while_no_page_is_in_view(talker):
    talker.page.sync(WATCHED_SECONDS)
    sent = len(talker.page.channel.messages)
    talker.session.runs.plan = talker.session.runs.plan.with_preset(
        "modern", talker.session.scenario
    )
    talker.page.sync(0.1)
    assert len(talker.page.channel.messages) == sent
    talker.say("watch")
    assert talker.last("plan")["preset"] == "modern"


def test_a_run_starts_as_planned(talker):
    talker.say("preset", name="modern")
    talker.say("freeze", rule=1, on=True)
    talker.plan(seed=5, mutation=0.25, elitism=2)
    assert "fraction of the population" in talker.last("plan")["findings"]["elitism"]
    talker.say("start", instead=False)
    assert "elitism" in talker.last("notice")["text"]
    assert talker.evolution.phase is Phase.IDLE
    name = talker.evolve(elitism=0.2, from_table=True)
    about = talker.last("status")["about"]
    assert (about["seed"], about["frozen"], about["finished"]) == (5, 1, True)
    assert about["preset"] == {"name": "modern", "changed": ["mutation", "elitism"]}
    look = talker.session.runs.look
    assert look.config.frozen == (EVO8.rules[1],)
    assert look.config.settings.mutation == 0.25
    (mark,) = talker.last("curves")["marks"]
    assert mark["generation"] == 1
    assert mark["fitness"] is not None
    assert talker.run(name)["done"] == talker.run(name)["generations"] == 3
    curves = talker.last("curves")
    assert curves["generation"] == [1, 2, 3]
    assert [entry["name"] for entry in curves["references"]] == ["EVO 8", "Hand-coded"]


def test_the_panel_starts_the_same_plan(talker):
    talker.plan(population=6, elitism=2, seed=11)
    begin(talker.session)
    assert talker.evolution.phase is Phase.IDLE
    findings = talker.session.runs.plan.findings(talker.session.scenario, EVO8)
    assert "what is wrong with: elitism" in status_html(talker.session.runs, list(findings))
    talker.plan(elitism=0.5)
    begin(talker.session)
    talker.until(lambda: talker.evolution.run is not None)
    assert talker.evolution.run.config.seed == 11


def test_steering_and_injection_are_marked_in_the_curve(talker):
    talker.plan(population=6, generations=100_000, evaluations=1)
    talker.say("start", instead=False)
    talker.until(lambda: len(talker.evolution.history) > 1)
    talker.say("pause")
    assert talker.last("status")["phase"] == "PAUSED"
    talker.rest()
    talker.say("start", instead=False)
    assert "stop it first" in talker.last("notice")["text"]
    talker.say("steer", name="mutation", value=0.5)
    talker.say("inject")
    assert talker.last("notice")["level"] == "info"
    assert talker.last("status")["settings"]["mutation"] == 0.5
    assert talker.last("status")["idle"] == ["tournament"]
    talker.say("go_on")
    talker.until(lambda: len(talker.last("curves")["marks"]) == 2)
    steered, entered = talker.last("curves")["marks"]
    assert steered["text"] == "mutation 0.05 → 0.5"
    assert steered["generation"] == entered["generation"]
    assert entered["text"].startswith("rules from the table entered, fitness")
    talker.say("stop")
    talker.until(lambda: talker.evolution.phase is Phase.STOPPED)
    talker.say("steer", name="mutation", value=0.5)
    assert "no evolution is running" in talker.last("notice")["text"]


def test_rules_that_cannot_enter_are_named_with_the_nearest_probability(talker):
    action = {"p": 0.3, "behaviour": "RANDOM_WALK"}
    talker.session.edit(
        typed({"do": "set", "rule": 0, "part": "actions", "at": 0, "element": action})
    )
    talker.plan(population=6, generations=100_000, evaluations=1)
    talker.say("start", instead=False)
    talker.until(lambda: talker.evolution.run is not None)
    talker.say("inject")
    assert "rule 1: p = 0.3 cannot evolve" in talker.last("notice")["text"]
    assert "nearest is 0.1" in talker.last("notice")["text"]


def test_individuals_are_looked_at_and_loaded(talker):
    name = talker.evolve()
    population = talker.last("population")
    assert population["size"] == len(population["members"]) == 6
    assert 1 <= population["diversity"] <= population["behaviours"] <= 6
    assert sum(population["fitness"]["counts"]) == 6
    generation, key, fitness, *_ = population["members"][0]
    talker.say("choose", generation=generation, key=key)
    chosen = talker.last("chosen")
    assert chosen["individual"] == {
        "run": name, "generation": generation, "key": key, "fitness": pytest.approx(fitness),
    }  # fmt: skip
    assert all(rule["english"] and rule["text"].startswith("rule") for rule in chosen["rules"])
    talker.say("load")
    loaded = talker.session.document.rule_set
    assert loaded.name == f"Generation {generation}, individual {key}"
    assert loaded.origin.generation == generation
    assert talker.session.world.rule_set == loaded
    assert talker.last("notice")["text"].startswith(f"{loaded.name}: now in the table")
    talker.say("load_best")
    best = talker.session.document.rule_set
    assert talker.last("notice")["text"].startswith(f"{best.name}: now in the table")
    talker.say("compare_with")
    assert talker.session.rival.name == CHOSEN
    assert talker.session.rival.swarm.world.rule_set == loaded
    talker.say("forget")
    assert talker.last("chosen")["individual"] is None
    for kind in ("load", "compare_with"):
        talker.say(kind)
        assert "clicked" in talker.last("notice")["text"]
    assert talker.session.document.rule_set == talker.session.runs.look.best


def test_the_line_of_ancestors_ends_with_the_best(talker):
    talker.session.change_scenario(duration=200.0)
    talker.evolve(population=20, generations=8)
    ancestors = talker.last("ancestors")
    first, *_, last = ancestors["line"]
    best = talker.session.runs.look.best
    assert (first[0], first[2]) == (best.origin.generation, best.origin.fitness)
    assert last[3] == "initial"
    family = [one[:2] for one in ancestors["all"]]
    assert all(step[:2] in family for step in ancestors["line"])
    talker.say("choose", generation=last[0], key=last[1])
    assert talker.last("chosen")["individual"]["key"] == last[1]


def test_runs_are_compared_opened_resumed_and_deleted(talker):
    first, second = talker.evolve(seed=1), talker.evolve(seed=2)
    talker.say("compare", name=first, on=True)
    (curve,) = talker.last("compared")["runs"]
    assert (curve["name"], curve["generation"]) == (first, [1, 2, 3])
    talker.say("open", name=first)
    talker.until(lambda: talker.last("curves")["run"] == first)
    assert talker.last("status")["shown"] == first
    assert talker.last("status")["about"]["seed"] == 1
    talker.until(lambda: len(talker.last("curves")["references"]) == 2)
    talker.say("resume", name=second)
    assert "3 generations are done" in talker.last("notice")["text"]
    talker.say("delete", name=first)
    assert not Path("runs", first).exists()
    assert Path("runs", second).exists()
    assert [run["colour"] for run in talker.last("runs")["runs"]] == [None]
    assert talker.last("compared")["runs"] == []
    assert talker.last("status")["shown"] == second
    talker.say("delete", name=second)
    status = talker.last("status")
    assert (status["run"], status["shown"], status["phase"]) == (None, None, "IDLE")
    talker.say("delete", name=f"../{Path.cwd().name}")
    assert "there is no run" in talker.last("notice")["text"]


def test_the_run_under_way_cannot_be_deleted(talker):
    talker.plan(population=6, generations=100_000, evaluations=1)
    talker.say("start", instead=False)
    talker.until(lambda: talker.last("runs")["runs"])
    name = talker.evolution.directory.name
    assert talker.run(name)["phase"] == "RUNNING"
    talker.say("delete", name=name)
    assert "stop it before" in talker.last("notice")["text"]
    assert Path("runs", name, "run.db").exists()
    talker.say("resume", name=name, instead=True)
    assert "under way already" in talker.last("notice")["text"]


def test_an_exception_in_an_evolution_is_shown_and_the_run_goes_on(talker, monkeypatch):
    evaluate = ScenarioFitness.__call__

    def fails(self, generation, individuals):
        if generation == 2:
            raise ZeroDivisionError("no robots")
        return evaluate(self, generation, individuals)

    monkeypatch.setattr(ScenarioFitness, "__call__", fails)
    talker.plan(population=6, generations=3, evaluations=1)
    talker.say("start", instead=False)
    talker.until(lambda: talker.evolution.phase is Phase.FAILED)
    talker.say("watch")
    status = talker.last("status")
    assert (status["error"], status["resumable"]) == ("ZeroDivisionError: no robots", True)
    time_before = talker.session.world.steps
    talker.session.step()
    assert talker.session.world.steps == time_before + 1
    monkeypatch.setattr(ScenarioFitness, "__call__", evaluate)
    talker.say("resume", name=status["run"], instead=False)
    talker.until(lambda: talker.evolution.phase is Phase.FINISHED)
    assert [record.generation for record in talker.evolution.history] == [1, 2, 3]


def test_a_damaged_run_is_told_and_nothing_else_happens(talker):
    name = talker.evolve()
    database = Path("runs", name, "run.db")
    for suffix in ("-wal", "-shm"):
        database.with_name(f"run.db{suffix}").unlink(missing_ok=True)
    damaged = Path("damaged")
    damaged.write_text("damaged" * 100)
    damaged.replace(database)  # at once: who reads meanwhile sees the one or the other
    talker.until(lambda: talker.run(name)["phase"] == "FAILED")
    assert "no database" in talker.run(name)["problem"]
    talker.until(lambda: "no database" in talker.last("status")["problem"])
    talker.say("resume", name=name, instead=False)
    talker.until(lambda: talker.evolution.phase is Phase.FAILED)
    assert "no database" in talker.evolution.error


@pytest.mark.parametrize(
    "message",
    [
        {"type": None},
        {"type": "dance"},
        {"type": "preset", "name": "luck"},
        {"type": "plan", "name": "luck", "value": 1},
        {"type": "plan", "name": "seed"},
        {"type": "plan", "name": "seed", "value": "x" * 1000},
        {"type": "freeze", "rule": 99, "on": True},
        {"type": "freeze", "rule": "1", "on": True},
        {"type": "freeze", "rule": 0, "on": "yes"},
        {"type": "steer", "name": "self", "value": 1},
        {"type": "steer", "name": "mutation", "value": "high"},
        {"type": "steer", "name": "mutation", "value": 0.5},
        {"type": "inject"},
        {"type": "load"},
        {"type": "load_best"},
        {"type": "choose", "generation": 1, "key": 10**30},
        {"type": "choose", "generation": 1},
        {"type": "choose", "generation": 1, "key": 1},
        {"type": "open", "name": ".."},
        {"type": "open", "name": "x" * 1000},
        {"type": "compare", "name": "x", "on": True},
        {"type": "resume", "name": "x"},
        {"type": "delete", "name": "x\0y"},
        {"type": "delete"},
    ],
)
def test_what_cannot_be_done_is_told_and_changes_nothing(talker, message):
    plan = talker.session.runs.plan
    talker.say(message.pop("type"), **message)
    assert talker.last("notice")["level"] == "error"
    assert talker.session.runs.plan == plan
    assert talker.evolution.phase is Phase.IDLE


def test_no_more_runs_are_compared_than_there_are_colours(talker):
    name = talker.evolve()
    for i in range(MOST_COMPARED + 1):
        Path("runs", f"copy-{i}").mkdir()
        Path("runs", f"copy-{i}", "run.db").write_bytes(Path("runs", name, "run.db").read_bytes())
        talker.say("compare", name=f"copy-{i}", on=True)
    assert "at most" in talker.last("notice")["text"]
    assert len(talker.session.runs.compared) == MOST_COMPARED


def test_messages_are_bounded():
    assert thinned(0) == []
    assert thinned(1) == [0]
    assert thinned(3) == [0, 1, 2]
    many = thinned(100_000)
    assert len(many) == MOST_POINTS
    assert (many[0], many[-1]) == (0, 99_999)
    assert histogram([]).counts == ()
    assert sum(histogram([2.0, 2.0]).counts) == 2
    assert encode(histogram([0.0, 5.0]))


def test_how_an_individual_was_bred():
    def one(generation, parents, phenotype="a"):
        return StoredIndividual(generation, 9, parents, 0.0, 1, phenotype)

    known = {(1, 0): "a", (1, 1): "b"}
    assert how_bred(one(1, ()), known) == "initial"
    assert how_bred(one(4, ()), known) == "injected"
    assert how_bred(one(2, ((1, 0),)), known) == "unchanged"
    assert how_bred(one(2, ((1, 1),)), known) == "mutation"
    assert how_bred(one(2, ((1, 1), (1, 0))), known) == "crossover"
