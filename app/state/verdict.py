"""Did the edit make it better? Full runs in the background, the newest rules first.

All versions run with the same random streams (run i of one against run i of another), so that the
difference of means has the interval of paired samples and small effects show.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from hashlib import blake2b

import numpy as np
import numpy.typing as npt

from geswarm.analysis import PairedDifference, paired_difference
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import ControlTable, RuleSet
from geswarm.sim import EvaluationStopped, Scenario, vocabulary_of

from .background import Newest, Stop
from .references import references_of

RUNS = 50
_FIRST_RUNS = 10  # the first look at every sample; then all of them in full
_CACHED_SAMPLES = 500


@dataclass(frozen=True)
class VerdictQuestion:
    """What a verdict is wanted on.

    Attributes:
        version: Of the document.
        rule_set: The rules now.
        before: The rules before the last change; None if there was none.
        scenario: Where they are run.
    """

    version: int
    rule_set: RuleSet
    before: RuleSet | None
    scenario: Scenario


@dataclass(frozen=True, eq=False)
class Sample:
    """The runs of one rule set so far.

    Attributes:
        role: `current`, `before`, or the name of a preset.
        name: For people.
        fitness: Value of the objective in each run, shape (runs so far,).
    """

    role: str
    name: str
    fitness: npt.NDArray[np.float64]


@dataclass(frozen=True)
class Answer:
    """The verdict as far as it is known.

    Attributes:
        question: What was asked.
        samples: The rules now, before, and the presets, in this order.
        comparisons: The rules now against each other sample, by its role.
        busy: More runs are to come.
    """

    question: VerdictQuestion
    samples: tuple[Sample, ...] = ()
    comparisons: dict[str, PairedDifference] = field(default_factory=dict)
    busy: bool = True


def compared(samples: tuple[Sample, ...]) -> dict[str, PairedDifference]:
    """Mean of the rules now minus the mean of each other sample, over their common runs."""
    current, *others = samples
    found = {}
    for other in others:
        runs = min(len(current.fitness), len(other.fitness))
        if runs > 1:
            found[other.role] = paired_difference(current.fitness[:runs], other.fitness[:runs])
    return found


class Judge:
    """Answers the newest question, on a thread of its own.

    Attributes:
        workers: Threads that simulate.
        answer: To the newest question, replaced as runs come in; None before the first question.
    """

    def __init__(self, workers: int = 1) -> None:
        self.workers = workers
        self.answer: Answer | None = None
        self._samples: OrderedDict[bytes, npt.NDArray[np.float64]] = OrderedDict()
        self._newest = Newest("verdict", self._answer)

    def ask(self, question: VerdictQuestion) -> None:
        """Begin with a question at once; what was under way is dropped."""
        self._newest.ask(question)

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def _answer(self, question: VerdictQuestion, stop: Stop) -> None:
        self.answer = Answer(question)
        try:
            for runs in (_FIRST_RUNS, RUNS):
                self._run_all(question, runs, stop)
        except EvaluationStopped:
            return
        self._publish(question, busy=False)

    def _run_all(self, question: VerdictQuestion, runs: int, stop: Stop) -> None:
        for _, _, rule_set in contestants(question):
            self._run(rule_set, question.scenario, runs, stop)
            self._publish(question, busy=True)

    def _publish(self, question: VerdictQuestion, busy: bool) -> None:
        samples = self._known(question)
        self.answer = Answer(question, samples, compared(samples), busy)

    def _run(self, rule_set: RuleSet, scenario: Scenario, runs: int, stop: Stop) -> None:
        key = _key(rule_set, scenario)
        if len(self._samples.get(key, ())) >= runs:
            self._samples.move_to_end(key)
            return
        (evaluation,) = evaluate_rule_sets(
            [rule_set], scenario, runs, workers=self.workers, stop=stop
        )
        self._samples[key] = evaluation.fitness
        while len(self._samples) > _CACHED_SAMPLES:
            self._samples.popitem(last=False)

    def _known(self, question: VerdictQuestion) -> tuple[Sample, ...]:
        """The samples so far; the rules now always come first, even while they have no run."""
        nothing = np.zeros(0)
        return tuple(
            Sample(role, name, self._samples.get(_key(rule_set, question.scenario), nothing))
            for role, name, rule_set in contestants(question)
        )


def contestants(question: VerdictQuestion) -> list[tuple[str, str, RuleSet]]:
    """(role, name, rules) of everything that a verdict compares."""
    found = [("current", "these rules", question.rule_set)]
    if question.before is not None:
        found.append(("before", "before the edit", question.before))
    for name, reference in references_of(question.scenario).items():
        found.append((name, reference.name, reference))
    return found


def _key(rule_set: RuleSet, scenario: Scenario) -> bytes:
    """Rule sets that behave alike share their runs; a digest, as the whole takes 20 kB."""
    table = ControlTable.compile(rule_set, vocabulary_of(scenario))
    decided = table.space.signature.encode() + table.probabilities.tobytes()
    return blake2b(decided + scenario.to_yaml().encode()).digest()
