"""What the evolution page and the panel beside the arena say of the runs that are kept."""

import shutil
from collections import Counter
from pathlib import Path

import pytest

from geswarm.app.panels.evolution_panel import load_best, status_html
from geswarm.app.state.behaviours import MOST_COLOURED, Labels
from geswarm.app.state.evolution import Phase
from geswarm.evolution import EvolutionRun, Member, Population
from geswarm.ge import RunStore, fall_in_words
from tests.app.evolution_talker import talker_fixture

__all__ = ["talker_fixture"]

OLDER = Path(__file__).parents[1] / "robustness" / "files" / "0.1.0" / "run"


def history(name):
    lines = Path("runs", name, "history.csv").read_text().splitlines()
    return [line.rpartition(",")[0] for line in lines]


def open_run(talker, name):
    talker.say("open", name=name)
    talker.until(lambda: (talker.last("status")["about"] and talker.last("curves")["run"]) == name)


def finished(talker, done):
    talker.until(lambda: talker.evolution.phase is Phase.FINISHED)
    talker.until(lambda: talker.last("status")["about"]["done"] == done)


def test_a_finished_run_is_extended(talker):
    whole, part = talker.evolve(generations=5), talker.evolve(generations=3)
    assert talker.last("status")["resumable"]
    talker.say("resume", name=part, generations=5, instead=False)
    finished(talker, 5)
    assert history(part) == history(whole)
    talker.until(lambda: (talker.run(part)["done"], talker.run(part)["generations"]) == (5, 5))


@pytest.mark.parametrize(
    ("generations", "words"),
    [
        (2, "3 generations are done, expected more of them to resume it, got 2"),
        (None, "3 generations are done, expected more"),
        (0, "expected a whole number >= 1"),
        (10**9, "expected at most"),
        (4.5, "expected a whole number, got 4.5"),
        ("many", "expected a whole number, got 'many'"),
    ],
)
def test_a_number_of_generations_that_cannot_be_is_told(talker, generations, words):
    name = talker.evolve()
    talker.say("resume", name=name, generations=generations, instead=False)
    assert words in talker.last("notice")["text"]
    assert talker.evolution.phase is Phase.FINISHED


def test_a_run_that_was_reopened_can_be_resumed(talker):
    talker.plan(population=6, generations=100_000, evaluations=1)
    talker.say("start", instead=False)
    talker.until(lambda: len(talker.evolution.history) > 1)
    unfinished = talker.evolution.directory.name
    assert not talker.last("status")["resumable"]
    talker.session.evolution.stop()
    talker.evolve(seed=2)
    open_run(talker, unfinished)
    status = talker.last("status")
    assert (status["resumable"], status["about"]["finished"]) == (True, False)
    done = status["about"]["done"] + 2
    talker.say("resume", name=unfinished, generations=done, instead=False)
    finished(talker, done)
    assert talker.last("status")["shown"] == unfinished


def test_the_best_is_that_of_the_run_looked_at_everywhere(talker):
    session = talker.session
    first, second = talker.evolve(seed=1), talker.evolve(seed=2)
    for name, other in ((second, first), (first, second), (second, first)):
        open_run(talker, name)
        assert f"best of {name}" in session.rivals_offered()
        assert f"best of {other}" not in session.rivals_offered()
        assert f"Kept in runs/{name}." in status_html(session.runs, [])
        load_best(session)
        assert session.document.rule_set.origin.run == f"runs/{name}"
        session.load_preset("evo8")
        talker.say("load_best")
        assert session.document.rule_set.origin.run == f"runs/{name}"
        session.compare_with(f"best of {name}")
        rival = session.rival.swarm.world
        assert rival.rule_set == session.document.rule_set
    open_run(talker, first)
    session.reset()
    assert session.rival.name == f"best of {second}"
    assert rival.rule_set.origin.run == f"runs/{second}"


def test_a_compared_run_keeps_its_colour(talker):
    names = [talker.evolve()]
    for copy in ("b", "c", "d"):
        shutil.copytree(Path("runs", names[0]), Path("runs", copy))
        names.append(copy)
    talker.until(lambda: talker.run("d")["phase"] == "FINISHED")

    def colours():
        listed = {run["name"]: run["colour"] for run in talker.last("runs")["runs"]}
        drawn = {run["name"]: run["colour"] for run in talker.last("compared")["runs"]}
        assert drawn == {name: at for name, at in listed.items() if at is not None}
        return [listed[name] for name in names]

    for name in names[:3]:
        talker.say("compare", name=name, on=True)
    assert colours() == [0, 1, 2, None]
    talker.say("compare", name=names[0], on=False)
    assert colours() == [None, 1, 2, None]
    talker.say("compare", name="d", on=True)
    talker.say("compare", name="c", on=True)
    assert colours() == [None, 1, 2, 0]
    shutil.rmtree(Path("runs", "b"))
    talker.until(lambda: talker.run("b")["phase"] is None)
    talker.say("compare", name=names[0], on=True)
    assert talker.last("runs")["runs"][0]["colour"] is not None


def test_the_curve_of_a_compared_run_goes_on_while_another_is_looked_at(talker):
    looked_at = talker.evolve()
    talker.plan(population=6, generations=100_000, evaluations=1)
    talker.say("start", instead=True)
    name = talker.evolution.directory.name
    talker.until(lambda: talker.run(name)["phase"] == "RUNNING")
    talker.say("compare", name=name, on=True)
    open_run(talker, looked_at)

    def drawn():
        (curve,) = talker.last("compared")["runs"]
        return curve["generation"][-1] if curve["generation"] else 0

    for _ in range(2):
        before = drawn()
        talker.until(lambda before=before: drawn() > before + 1)
    talker.until(lambda: abs(talker.run(name)["done"] - drawn()) < 5)


def test_a_run_that_another_process_writes_is_left_alone(talker):
    name, own = talker.evolve(seed=1), talker.evolve(seed=2)
    with RunStore.open(Path("runs", name)):  # a claim is a claim, whoever has it
        talker.until(lambda: talker.run(name)["elsewhere"])
        assert not talker.run(own)["elsewhere"]
        talker.say("resume", name=name, generations=9, instead=False)
        assert "under way in another process" in talker.last("notice")["text"]
        talker.say("delete", name=name)
        assert "another process is at work on this run" in talker.last("notice")["text"]
        open_run(talker, name)
        assert not talker.last("status")["resumable"]
    talker.until(lambda: not talker.run(name)["elsewhere"])
    talker.until(lambda: talker.last("status")["resumable"])
    assert len(history(name)) == 4


def test_a_run_that_cannot_be_claimed_fails_in_words(talker):
    name = talker.evolve()
    with RunStore.open(Path("runs", name)):
        talker.evolution.resume(Path("runs", name), 5)
        talker.until(lambda: talker.evolution.phase is Phase.FAILED)
        assert talker.evolution.error.startswith(f"runs/{name}: another process is at work")
    assert len(history(name)) == 4


def test_what_there_is_to_know_of_a_run_that_is_resumed_is_shown(talker, monkeypatch):
    shutil.copytree(OLDER, "runs/older")
    monkeypatch.setattr("geswarm.evolution.run.__version__", "9.9")
    monkeypatch.setattr("geswarm.app.panels.evolution_messages.__version__", "9.9")
    talker.until(lambda: talker.run("older")["phase"] == "STOPPED")
    open_run(talker, "older")
    assert talker.last("status")["about"]["version"] == "0.1.0"
    assert talker.last("status")["remarks"] == []
    talker.say("resume", name="older", instead=False)
    talker.until(lambda: talker.last("status")["remarks"])
    (remark,) = talker.last("status")["remarks"]
    assert "began with GESwarm 0.1.0 and goes on with 9.9: results may differ" in remark
    assert "results may differ" in status_html(talker.session.runs, [])


def test_the_best_does_not_fall_without_a_word(talker):
    assert fall_in_words([131.2, 129.8]) == "re-evaluated: 131.2 → 129.8"
    assert fall_in_words([1.0, 131.2, 131.16]) == ""
    talker.say("preset", name="modern")
    name = talker.evolve()
    curves = talker.last("curves")
    assert curves["reevaluated"]
    run = EvolutionRun.resume(f"runs/{name}")
    run._store._connection.execute("UPDATE generation SET best_so_far = 99 WHERE generation = 1")
    run.close()
    talker.until(lambda: "re-evaluated: 99.0 → " in talker.run(name)["fall"])
    talker.until(lambda: "re-evaluated: 99.0 → " in talker.last("status")["about"]["fall"])


def population(*behaviours):
    members = [Member(1, key, 0.0, 1, 5, None, one) for key, one in enumerate(behaviours)]
    return Population(tuple(members), len(set(behaviours)), 1.0)


def test_a_behaviour_keeps_its_number_and_colour_as_long_as_it_lives():
    labels = Labels()
    first = labels.of(population("a", "b", "b", None, "c", "d", "e", "f"))
    assert [first[one].number for one in "abcdef"] == [1, 2, 3, 4, 5, 6]
    assert first["b"].colour == 0
    assert Counter(label.colour is None for label in first.values())[False] == MOST_COLOURED
    then = labels.of(population("f", "f", "f", "g", "c", "b", "a"))
    assert {one: then[one] for one in "abc"} == {one: first[one] for one in "abc"}
    assert then["f"].number == first["f"].number
    assert then["f"].colour in {first["d"].colour, first["e"].colour}
    assert then["g"].number == 7
    again = labels.of(population("d", "f"))
    assert again["d"].number == 8


def test_the_population_is_told_with_these_labels(talker):
    talker.session.change_scenario(duration=100.0)
    talker.evolve(population=20)
    message = talker.last("population")
    numbers = Counter(member[6] for member in message["members"])
    assert 1 <= len(message["coloured"]) <= MOST_COLOURED
    for number, count, colour in message["coloured"]:
        assert numbers[number] == count
        assert colour.startswith("#")
