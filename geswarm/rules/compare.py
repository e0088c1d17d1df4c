"""Do two rule sets make robots behave the same? Decided exactly, not by simulation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geswarm.rules.control_table import ControlTable, Indexing
from geswarm.rules.english import join_phrases
from geswarm.rules.model import RuleSet
from geswarm.rules.reachability import TOLERANCE, effective_outcomes, reachable_situations
from geswarm.rules.vocabulary import FORAGING, Vocabulary


@dataclass(frozen=True)
class Difference:
    """The first situation in which two rule sets decide differently.

    Attributes:
        situation: In words, at the start of a control step.
        first: What robots under the first rule set then do, in words, and with which probability;
            likeliest first.
        second: The same for the second rule set.
    """

    situation: str
    first: dict[str, float]
    second: dict[str, float]

    def __str__(self) -> str:
        return f"{self.situation}: {_spread(self.first)} - against {_spread(self.second)}"


def same_behaviour(a: RuleSet, b: RuleSet, vocabulary: Vocabulary = FORAGING) -> bool:
    """Whether robots under either rule set do the same, with the same probabilities.

    Asked in every situation that robots can get into; probabilities may differ by 1e-12. To drop an
    object where none is held is to do nothing.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    return first_difference(a, b, vocabulary) is None


def first_difference(
    a: RuleSet, b: RuleSet, vocabulary: Vocabulary = FORAGING
) -> Difference | None:
    """Where two rule sets first decide differently, in the order of the control table; or None.

    Robots can get into that situation under both of them: up to the first step in which the
    decisions differ, they go through the same situations.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    indexing = Indexing.of(vocabulary)
    shape = (indexing.percepts, indexing.behaviours * indexing.states, indexing.outcomes)
    tables = [
        ControlTable.compile(each, vocabulary).probabilities.reshape(shape)
        @ effective_outcomes(vocabulary)
        for each in (a, b)
    ]
    differs = (np.abs(tables[0] - tables[1]) > TOLERANCE).any(axis=2)
    for table in tables:
        differs &= reachable_situations(table, vocabulary)
    if not differs.any():
        return None
    percepts, start = divmod(int(np.argmax(differs)), shape[1])
    behaviour, states = divmod(start, indexing.states)
    first, second = (
        {
            _decision(behaviour, states, int(outcome), vocabulary): float(row[outcome])
            for outcome in np.argsort(-row, kind="stable")
            if row[outcome] > 0
        }
        for row in (table[percepts, start] for table in tables)
    )
    return Difference(_situation(percepts, behaviour, states, vocabulary), first, second)


def _situation(percepts: int, behaviour: int, states: int, vocabulary: Vocabulary) -> str:
    sensed = join_phrases(_percepts(percepts, vocabulary), "and")
    lasting = [
        f"{entry.name} {'true' if states >> bit & 1 else 'false'}"
        for bit, entry in enumerate(vocabulary.internal_states)
        if not entry.momentary
    ]
    inner = f", with {join_phrases(lasting, 'and')}" if lasting else ""
    return f"when {sensed}, while {vocabulary.behaviours[behaviour].doing}{inner}"


def _percepts(percepts: int, vocabulary: Vocabulary) -> Iterator[str]:
    """Phrases for what is sensed, without the percepts that a true one already excludes."""
    true = {entry.name for bit, entry in enumerate(vocabulary.preconditions) if percepts >> bit & 1}
    excluded = {name for pair in vocabulary.apart if true & set(pair) for name in pair} - true
    for entry in vocabulary.preconditions:
        if entry.name not in excluded:
            yield entry.holds if entry.name in true else entry.fails


def _decision(behaviour: int, states: int, outcome: int, vocabulary: Vocabulary) -> str:
    """What a robot does that comes to an outcome from a behaviour and internal states."""
    after, states_after, restart = Indexing.of(vocabulary).describe_outcome(outcome)
    entry = vocabulary.behaviours[after]
    if after != behaviour:
        phrases = [entry.start]
    else:
        phrases = [f"{entry.start} afresh" if restart else f"keep {entry.doing}"]
    for bit, state in enumerate(vocabulary.internal_states):
        if (states ^ states_after) >> bit & 1:
            phrases.append(state.on if states_after >> bit & 1 else state.off)
    return join_phrases(phrases, "and")


def _spread(decisions: dict[str, float]) -> str:
    return ", ".join(f"{decision} (p = {p:.6g})" for decision, p in decisions.items())
