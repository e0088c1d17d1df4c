"""Do two rule sets make robots behave the same? Decided exactly, not by simulation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geswarm.rules.control_table import ControlTable
from geswarm.rules.english import join_phrases
from geswarm.rules.model import RuleSet, StateChange, format_value
from geswarm.rules.names import require_known_names
from geswarm.rules.reachability import TOLERANCE, effective_outcomes, reachable_situations
from geswarm.rules.space import Space
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
    for each in (a, b):
        require_known_names(each, vocabulary)
    space = Space.of(vocabulary, a, b)
    effective = effective_outcomes(space)
    tables = [ControlTable.within(space, each).by_percepts @ effective for each in (a, b)]
    differs = (np.abs(tables[0] - tables[1]) > TOLERANCE).any(axis=2)
    for table in tables:
        differs &= reachable_situations(table, space)
    if not differs.any():
        return None
    percepts, start = divmod(int(np.argmax(differs)), space.starts)
    behaviour, states = divmod(start, space.states)
    first, second = (
        {
            _decision(behaviour, states, int(outcome), space): float(row[outcome])
            for outcome in np.argsort(-row, kind="stable")
            if row[outcome] > 0
        }
        for row in (table[percepts, start] for table in tables)
    )
    return Difference(_situation(percepts, behaviour, states, space), first, second)


def _situation(percepts: int, behaviour: int, states: int, space: Space) -> str:
    sensed = join_phrases(_percepts(percepts, space), "and")
    lasting = [
        f"{entry.name} {format_value(value)}"
        for entry, value in zip(space.internal_states, space.state_values[states], strict=True)
        if not entry.momentary
    ]
    inner = f", with {join_phrases(lasting, 'and')}" if lasting else ""
    when = f"when {sensed}, " if sensed else ""
    return f"{when}while {_words(behaviour, space)[0]}{inner}"


def _percepts(percepts: int, space: Space) -> Iterator[str]:
    """Phrases for what is sensed, without the percepts that a true one already excludes."""
    truths = dict(zip((atom.name for atom in space.atoms), space.truths[percepts], strict=True))
    true = {name for name, holds in truths.items() if holds}
    apart = space.vocabulary.apart
    excluded = {name for pair in apart if true & set(pair) for name in pair} - true
    for atom in space.atoms:
        if atom.name not in excluded and atom.reading not in space.vocabulary.state_names:
            yield atom.says(bool(truths[atom.name]), space.vocabulary)
    for drawn in space.drawn:
        chance = space.chance(drawn.precondition)[percepts]
        yield f"{drawn.says(space.vocabulary)} by a chance of {chance:.6g}"


def _words(behaviour: int, space: Space) -> tuple[str, str]:
    term = space.behaviours[behaviour]
    return space.vocabulary.behaviour_names[term.name].says(term)


def _decision(behaviour: int, states: int, outcome: int, space: Space) -> str:
    """What a robot does that comes to an outcome from a behaviour and internal states."""
    after, states_after, restart = space.describe_outcome(outcome)
    doing, start = _words(after, space)
    stays = f"{start} afresh" if restart else f"keep {doing}"
    phrases = [start if after != behaviour else stays]
    values = zip(space.state_values[states], space.state_values[states_after], strict=True)
    for entry, (before, now) in zip(space.internal_states, values, strict=True):
        if before != now:
            phrases.append(entry.says(StateChange(1.0, entry.name, now)))
    return join_phrases(phrases, "and")


def _spread(decisions: dict[str, float]) -> str:
    return ", ".join(f"{decision} (p = {p:.6g})" for decision, p in decisions.items())
