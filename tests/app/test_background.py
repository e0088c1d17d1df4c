"""Work off the loop, of which only the newest matters."""

import queue
import threading
import time

from geswarm.app.state.background import Lookout, Newest


def test_a_question_that_fails_does_not_end_the_answers(caplog):
    answers = queue.SimpleQueue()

    def answer(question, stop):
        answers.put(1 / question)

    newest = Newest("division", answer)
    newest.ask(0)
    while not caplog.records:
        pass
    newest.ask(2)
    assert answers.get(timeout=60) == 0.5
    newest.close()
    assert "division failed" in caplog.text


def test_a_lookout_looks_once_at_a_time_and_rests_unless_it_is_hurried():
    looks, go_on = queue.SimpleQueue(), threading.Event()

    def look(_stop):
        looks.put("begun")
        assert go_on.wait(60)

    lookout = Lookout("lookout", look)
    lookout.ask()
    assert looks.get(timeout=60) == "begun"
    lookout.ask()
    assert looks.empty()
    lookout.hurry()
    lookout.ask()  # there is something new: once more
    go_on.set()
    assert looks.get(timeout=60) == "begun"
    lookout.close()
    assert looks.empty()


def test_a_lookout_that_is_hurried_during_a_look_does_not_rest_after_it():
    looks, ended = queue.SimpleQueue(), threading.Event()

    def look(_stop):
        looks.put("begun")
        time.sleep(0.2)  # so that it would rest for longer than the test waits
        lookout.hurry()
        ended.set()

    lookout = Lookout("lookout", look)
    lookout.ask()
    assert ended.wait(60)
    for _ in range(20):  # until the thread has left the look
        time.sleep(0.01)
        lookout.ask()
    assert [looks.get(timeout=60) for _ in range(2)] == ["begun", "begun"]
    lookout.close()
