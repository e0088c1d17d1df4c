"""Work off the loop of which only the newest matters."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable
from typing import Generic, TypeVar

Question = TypeVar("Question")
Stop = Callable[[], bool]

logger = logging.getLogger(__name__)


class Newest(Generic[Question]):
    """Answers one question at a time on a thread of its own; a newer one cancels it.

    Args:
        name: Of the thread.
        answer: Called with the question and a `stop` that turns True when a newer one was asked.
            It should return soon after.
    """

    def __init__(self, name: str, answer: Callable[[Question, Stop], None]) -> None:
        self._name = name
        self._answer = answer
        self._changed = threading.Condition()
        self._question: Question | None = None
        self._closed = False
        self._thread: threading.Thread | None = None

    def ask(self, question: Question | None) -> None:
        """Begin with a question at once, or only stop; what was under way is dropped."""
        with self._changed:
            self._question = question
            self._changed.notify()
        if self._thread is None and question is not None:
            self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
            self._thread.start()

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._closed = True
            self._changed.notify()
        if self._thread is not None:
            self._thread.join(10)

    def _work(self) -> None:
        done: Question | None = None
        while True:
            with self._changed:
                while self._question is done and not self._closed:
                    self._changed.wait()
                if self._closed:
                    return
                question = done = self._question
            if question is not None:
                try:
                    self._answer(question, self._stop_for(question))
                except Exception:  # one bad question must not end the answers to the next
                    logger.exception("%s failed", self._name)

    def _stop_for(self, question: Question) -> Stop:
        return lambda: self._closed or self._question is not question


class Lookout:
    """Finds out how things stand, off the loop, again and again.

    It rests for twice as long as a look takes, so that the loop has its share.

    Args:
        name: Of the thread.
        look: Called with a `stop`, see `Newest`.
    """

    def __init__(self, name: str, look: Callable[[Stop], None]) -> None:
        self._look = look
        self._rest_until = 0.0
        self._newest: Newest[object] = Newest(name, self._answer)

    def ask(self) -> None:
        """Look, unless a look is under way or it rests."""
        if time.monotonic() >= self._rest_until:
            self._rest_until = math.inf
            self._newest.ask(object())

    def hurry(self) -> None:
        """The next `ask` looks at once: there is something new."""
        self._rest_until = 0.0

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def _answer(self, _question: object, stop: Stop) -> None:
        began = time.monotonic()
        try:
            self._look(stop)
        finally:
            if self._rest_until == math.inf and not stop():  # neither hurried nor asked again
                self._rest_until = time.monotonic() + 2 * (time.monotonic() - began)
