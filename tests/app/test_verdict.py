"""Background answers: the newest question wins, and the figures are those of a plain evaluation."""

import threading
import time

import pytest

from geswarm.app.state.background import Newest
from geswarm.app.state.verdict import RUNS, Judge, VerdictQuestion
from geswarm.app.state.worth import WorthOfPieces, WorthQuestion
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import apply_edit, load_preset
from geswarm.sim import load_scenario

EVO8 = load_preset("evo8")
QUICK = load_scenario("paper").with_changes(duration=300.0)
LONG = load_scenario("paper").with_changes(duration=1e5)


def wait_until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.005)


@pytest.fixture
def verdict():
    verdict = Judge()
    yield verdict
    verdict.close()


@pytest.fixture
def worth():
    worth = WorthOfPieces()
    yield worth
    worth.close()


def test_the_verdict_is_that_of_a_plain_evaluation(verdict):
    edited = apply_edit(EVO8, {"do": "remove_rule", "rule": 2})
    verdict.ask(VerdictQuestion(2, edited, EVO8, QUICK))
    wait_until(lambda: verdict.answer is not None and not verdict.answer.busy)
    samples = {sample.role: sample for sample in verdict.answer.samples}
    assert list(samples) == ["current", "before", "evo8", "hand-coded"]
    for role, rule_set in (("current", edited), ("before", EVO8), ("evo8", EVO8)):
        (expected,) = evaluate_rule_sets([rule_set], QUICK, RUNS)
        assert samples[role].fitness.tolist() == expected.fitness.tolist()
    comparisons = verdict.answer.comparisons
    expected_difference = samples["current"].fitness.mean() - samples["before"].fitness.mean()
    assert comparisons["before"].difference == pytest.approx(expected_difference)
    assert comparisons["evo8"] == comparisons["before"]


def test_without_an_edit_there_is_nothing_before(verdict):
    verdict.ask(VerdictQuestion(1, EVO8, None, QUICK))
    wait_until(lambda: verdict.answer is not None and not verdict.answer.busy)
    assert [sample.role for sample in verdict.answer.samples] == ["current", "evo8", "hand-coded"]
    assert verdict.answer.comparisons["evo8"].difference == 0


def test_a_newer_question_cancels_the_older_one(verdict):
    verdict.ask(VerdictQuestion(1, EVO8, None, LONG))
    time.sleep(0.1)
    verdict.ask(VerdictQuestion(2, EVO8, None, QUICK))
    wait_until(lambda: verdict.answer.question.version == 2 and not verdict.answer.busy)
    assert all(len(sample.fitness) == RUNS for sample in verdict.answer.samples)


def test_every_piece_is_weighed_and_progress_is_told(worth):
    worth.ask(WorthQuestion(1, EVO8, QUICK))
    wait_until(lambda: worth.answer is not None and worth.answer.worths)
    wait_until(lambda: not worth.answer.busy)
    assert len(worth.answer.worths) == worth.answer.total == 4 + 4 + 7 + 6
    worth.forget(2)
    assert worth.answer.worths == ()


def test_weighing_can_be_cancelled(worth):
    worth.ask(WorthQuestion(1, EVO8, LONG))
    wait_until(lambda: worth.answer is not None and worth.answer.busy)
    worth.forget(1)
    time.sleep(0.1)
    assert not worth.answer.busy


def test_newest_answers_the_last_question_and_ends_when_closed():
    answered, started = [], threading.Event()

    def answer(question, stop):
        started.set()
        wait_until(lambda: stop() or question == "last")
        if not stop():
            answered.append(question)

    newest = Newest("test", answer)
    newest.ask("first")
    assert started.wait(10)
    for question in ("second", "third", "last"):
        newest.ask(question)
    wait_until(lambda: answered)
    assert answered == ["last"]
    newest.close()
    assert not any(thread.name == "test" for thread in threading.enumerate())
