"""Work off the loop, of which only the newest matters."""

import queue

from geswarm.app.state.background import Newest


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
