"""What each piece of the edited rules is worth, on request, in the background."""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.analysis import Worth, pieces, worth_of_pieces
from geswarm.rules import RuleSet
from geswarm.sim import EvaluationStopped, Scenario

from .background import Newest, Stop

RUNS = 50


@dataclass(frozen=True)
class WorthQuestion:
    """Whose pieces are to be weighed; `version` is that of the document."""

    version: int
    rule_set: RuleSet
    scenario: Scenario


@dataclass(frozen=True)
class WorthAnswer:
    """What is known so far.

    Attributes:
        version: Of the document that was weighed.
        total: Pieces in all.
        worths: Of the pieces done.
        busy: More are to come.
    """

    version: int
    total: int = 0
    worths: tuple[Worth, ...] = ()
    busy: bool = False


class WorthOfPieces:
    """Weighs the newest rules asked for, on a thread of its own.

    Attributes:
        workers: Threads that simulate.
        answer: Replaced as pieces are done; None before the first question.
    """

    def __init__(self, workers: int = 1) -> None:
        self.workers = workers
        self.answer: WorthAnswer | None = None
        self._newest = Newest("worth", self._answer)

    def ask(self, question: WorthQuestion) -> None:
        """Begin at once; what was under way is dropped."""
        self._newest.ask(question)

    def forget(self, version: int) -> None:
        """Stop, and forget what is known: the document is now at this version."""
        self._newest.ask(None)
        if self.answer is not None:
            self.answer = WorthAnswer(version)

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def _answer(self, question: WorthQuestion, stop: Stop) -> None:
        rule_set, version = question.rule_set, question.version
        total = sum(1 for _ in pieces(rule_set))
        worths: tuple[Worth, ...] = ()
        self.answer = WorthAnswer(version, total, worths, busy=True)
        found = worth_of_pieces(rule_set, question.scenario, RUNS, workers=self.workers, stop=stop)
        try:
            for worth in found:
                if stop():
                    return
                worths = (*worths, worth)
                self.answer = WorthAnswer(version, total, worths, busy=len(worths) < total)
        except EvaluationStopped:
            return
