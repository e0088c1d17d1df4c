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

from geswarm.rules.control_table import apply_rule, before_any_rule
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.space import FloatArray, Space
from geswarm.rules.vocabulary import FORAGING, Vocabulary

TOLERANCE = 1e-12
"""Probabilities that differ by less are the same: rounding is about 1e-16."""

BoolArray: TypeAlias = npt.NDArray[np.bool_]
_Body: TypeAlias = tuple[bool, int, int]  # holding an object, behaviour, internal states


def reachable_situations(table: FloatArray, space: Space) -> BoolArray:
    """Mark the situations that a robot under this table can get into.

    Args:
        table: Outcome distributions, shape (percepts, behaviours * states, outcomes).
        space: What the numbers stand for.

    Returns:
        Shape (percepts, behaviours * states).
    """
    possible = table > 0
    reachable = np.zeros(table.shape[:2], dtype=bool)
    found: set[_Body] = {(False, space.initial_behaviour, space.initial_states)}
    waiting = list(found)
    while waiting:
        holding, behaviour, states = waiting.pop()
        column = behaviour * space.states + states
        percepts = _percepts(holding, states, space)
        reachable[percepts, column] = True
        for outcome in np.flatnonzero(possible[percepts, column].any(axis=0)):
            after, set_states, _ = space.describe_outcome(int(outcome))
            for body in _next_bodies(holding, after, set_states, space):
                if body not in found:
                    found.add(body)
                    waiting.append(body)
    return reachable


@lru_cache(maxsize=4096)
def _percepts(holding: bool, states: int, space: Space) -> list[int]:
    return space.perceivable(holding, states)


def _next_bodies(holding: bool, behaviour: int, states: int, space: Space) -> Iterator[_Body]:
    """What a robot can be like at the start of the next step; an object may be near or not."""
    kept, objects = space.kept[states], space.vocabulary.objects
    if objects is None:
        yield False, behaviour, kept
        return
    still = holding and not space.state(states, objects.dropping)
    if not still:
        yield False, behaviour, kept
    if still or space.state(states, objects.wanting):
        yield True, behaviour, kept


@dataclass(frozen=True, eq=False)
class Trace:
    """A rule set followed rule by rule through one control step in all reachable situations.

    Attributes:
        rules: The enabled rules.
        space: What they tell apart.
        before: When the turn of each rule comes, and last after all rules: shape (percepts,
            behaviours * states, outcomes), rows of unreachable situations are zero.
        matrices: What each rule does, shape (percepts, outcomes, outcomes).
        after: What all rules from each one on do together, and last what becomes of outcomes when
            the rules are done, see `effective_outcomes`; same shape.
    """

    rules: tuple[Rule, ...]
    space: Space
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
        rules, space = rule_set.active_rules, Space.of(vocabulary, rule_set)
        before = [before_any_rule(space)]
        for rule in rules:
            before.append(apply_rule(before[-1], rule, space))
        reachable = reachable_situations(before[-1], space)[:, :, None]
        nothing = no_change(space)
        matrices = [apply_rule(nothing, rule, space) for rule in rules]
        after = [effective_outcomes(space)]
        for matrix in reversed(matrices):
            after.append(matrix @ after[-1])
        return cls(
            rules,
            space,
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
        replaced = turn if instead is None else apply_rule(turn, instead, self.space)
        return not is_nothing((replaced - self.before[at + 1]) @ self.after[at + 1])


@lru_cache(maxsize=64)
def effective_outcomes(space: Space) -> FloatArray:
    """Each outcome as the one that stands for its effects, as 0/1 matrices.

    It is another one where nothing is held that could be dropped.

    Returns:
        Shape (percepts, outcomes, outcomes), read-only.
    """
    matrices = no_change(space).copy()
    if objects := space.vocabulary.objects:
        empty = ~space.held
        for outcome in range(space.outcomes):
            behaviour, states, restart = space.describe_outcome(outcome)
            undropped = space.with_state(states, objects.dropping, False)
            matrices[empty, outcome] = 0.0
            matrices[empty, outcome, space.outcome(behaviour, undropped, restart)] = 1.0
    matrices.setflags(write=False)
    return matrices


def no_change(space: Space) -> FloatArray:
    """The matrices of a rule that does nothing, shape (percepts, outcomes, outcomes)."""
    one = np.eye(space.outcomes)
    return np.broadcast_to(one, (space.percepts, *one.shape))


def is_nothing(difference: FloatArray) -> bool:
    """Whether a difference of distributions is no more than rounding."""
    return bool(np.abs(difference).max(initial=0.0) <= TOLERANCE)
