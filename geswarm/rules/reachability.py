"""Which situations a robot can get into, and how a rule set acts in them, rule by rule.

The model is simple and errs on one side only: what it calls unreachable never happens; what it
calls reachable may still need a path through the arena that no robot finds. It speaks of whole
runs, not of robots whose rules are changed on the way. A robot starts with the
vocabulary's initial behaviour and internal states and without an object. In every step it perceives
anything, except percepts that are never true together (the nest and the source do not overlap) and
except that it perceives a held object exactly. It holds an object from a step at whose end it
wanted one until a step at whose end it drops it; momentary internal states are then false again.
Dropping without an object does nothing: outcomes that differ in that alone are the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.control_table import FloatArray, Indexing, apply_rule, before_any_rule
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.vocabulary import FORAGING, Vocabulary

TOLERANCE = 1e-12
"""Probabilities that differ by less are the same: rounding is about 1e-16."""

BoolArray: TypeAlias = npt.NDArray[np.bool_]
_Body: TypeAlias = tuple[bool, int, int]  # holding an object, behaviour, internal states


def reachable_situations(table: FloatArray, vocabulary: Vocabulary = FORAGING) -> BoolArray:
    """Mark the situations that a robot under this table can get into.

    Args:
        table: Outcome distributions, shape (percepts, behaviours * states, outcomes).
        vocabulary: The names that the numbers stand for.

    Returns:
        Shape (percepts, behaviours * states).
    """
    indexing = Indexing.of(vocabulary)
    possible = table > 0
    reachable = np.zeros(table.shape[:2], dtype=bool)
    percepts = _percepts(False, vocabulary), _percepts(True, vocabulary)
    start = vocabulary.behaviour_index[vocabulary.initial_behaviour]
    found: set[_Body] = {(False, start, vocabulary.initial_states)}
    waiting = list(found)
    while waiting:
        holding, behaviour, states = waiting.pop()
        column = behaviour * indexing.states + states
        reachable[percepts[holding], column] = True
        for outcome in np.flatnonzero(possible[percepts[holding], column].any(axis=0)):
            after, set_states, _ = indexing.describe_outcome(int(outcome))
            for body in _next_bodies(holding, after, set_states, vocabulary):
                if body not in found:
                    found.add(body)
                    waiting.append(body)
    return reachable


@lru_cache(maxsize=8)
def _percepts(holding: bool, vocabulary: Vocabulary) -> list[int]:
    """Everything that a robot can perceive while it holds an object, or while it does not."""
    bits = vocabulary.precondition_index
    together = [1 << bits[a] | 1 << bits[b] for a, b in vocabulary.apart]
    held = 1 << bits[vocabulary.objects.holding] if vocabulary.objects else 0
    return [
        percepts
        for percepts in range(1 << len(bits))
        if not any(percepts & both == both for both in together)
        and (not held or bool(percepts & held) == holding)
    ]


def _next_bodies(
    holding: bool, behaviour: int, states: int, vocabulary: Vocabulary
) -> Iterator[_Body]:
    """What a robot can be like at the start of the next step; an object may be near or not."""
    kept = states & vocabulary.lasting_states
    if vocabulary.objects is None:
        yield False, behaviour, kept
        return
    bits = vocabulary.state_index
    still = holding and not states >> bits[vocabulary.objects.dropping] & 1
    if not still:
        yield False, behaviour, kept
    if still or states >> bits[vocabulary.objects.wanting] & 1:
        yield True, behaviour, kept


@dataclass(frozen=True, eq=False)
class Trace:
    """A rule set followed rule by rule through one control step in all reachable situations.

    Attributes:
        rules: The enabled rules.
        vocabulary: Their names.
        before: When the turn of each rule comes, and last after all rules: shape (percepts,
            behaviours * states, outcomes), rows of unreachable situations are zero.
        matrices: What each rule does, shape (percepts, outcomes, outcomes).
        after: What all rules from each one on do together, and last what becomes of outcomes when
            the rules are done, see `effective_outcomes`; same shape.
    """

    rules: tuple[Rule, ...]
    vocabulary: Vocabulary
    before: tuple[FloatArray, ...]
    matrices: tuple[FloatArray, ...]
    after: tuple[FloatArray, ...]

    @classmethod
    def of(cls, rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> Trace:
        """Follow the enabled rules.

        Raises:
            RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        """
        require_known_names(rule_set, vocabulary)
        rules = rule_set.active_rules
        before = [before_any_rule(vocabulary)]
        for rule in rules:
            before.append(apply_rule(before[-1], rule, vocabulary))
        reachable = reachable_situations(before[-1], vocabulary)[:, :, None]
        nothing = no_change(vocabulary)
        matrices = [apply_rule(nothing, rule, vocabulary) for rule in rules]
        after = [effective_outcomes(vocabulary)]
        for matrix in reversed(matrices):
            after.append(matrix @ after[-1])
        return cls(
            rules,
            vocabulary,
            tuple(distribution * reachable for distribution in before),
            tuple(matrices),
            tuple(reversed(after)),
        )

    @property
    def reachable(self) -> BoolArray:
        """The reachable situations, shape (percepts, behaviours * states)."""
        return np.asarray(self.before[0].any(axis=2))

    @property
    def decided(self) -> FloatArray:
        """What robots come to in the end, by its effects; shape as `before`."""
        return self.before[-1] @ self.after[-1]

    def matters(self, at: int, instead: Rule | None) -> bool:
        """Whether the step's outcome differs with another rule, or none, in the place of one."""
        turn = self.before[at]
        replaced = turn if instead is None else apply_rule(turn, instead, self.vocabulary)
        return not is_nothing((replaced - self.before[at + 1]) @ self.after[at + 1])


@lru_cache(maxsize=8)
def effective_outcomes(vocabulary: Vocabulary) -> FloatArray:
    """Each outcome as the one that stands for its effects, as 0/1 matrices.

    It is another one where nothing is held that could be dropped.

    Returns:
        Shape (percepts, outcomes, outcomes), read-only.
    """
    indexing, objects = Indexing.of(vocabulary), vocabulary.objects
    matrices = no_change(vocabulary).copy()
    if objects is not None:
        held = vocabulary.precondition_index[objects.holding]
        empty = (np.arange(indexing.percepts) >> held & 1) == 0
        dropping = 1 << vocabulary.state_index[objects.dropping]
        for outcome in range(indexing.outcomes):
            behaviour, states, restart = indexing.describe_outcome(outcome)
            same = indexing.outcome(behaviour, states & ~dropping, restart)
            matrices[empty, outcome] = 0.0
            matrices[empty, outcome, same] = 1.0
    matrices.setflags(write=False)
    return matrices


def no_change(vocabulary: Vocabulary) -> FloatArray:
    """The matrices of a rule that does nothing, shape (percepts, outcomes, outcomes)."""
    indexing = Indexing.of(vocabulary)
    one = np.eye(indexing.outcomes)
    return np.broadcast_to(one, (indexing.percepts, *one.shape))


def is_nothing(difference: FloatArray) -> bool:
    """Whether a difference of distributions is no more than rounding."""
    return bool(np.abs(difference).max(initial=0.0) <= TOLERANCE)
