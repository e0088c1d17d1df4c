"""ControlTable: a rule set as the exact outcome distribution of one control step.

A rule set is a probabilistic finite state machine (paper, section 5). For every combination of
percepts, behaviour and internal states at the start of a step, the distribution over what the robot
decides is finite; compiling it once makes a control step one table row and one random number,
whatever the number of rules.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import Action, BehaviourChange, Precondition, Rule, RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.vocabulary import FORAGING, Vocabulary

FloatArray: TypeAlias = npt.NDArray[np.float64]
Outcome: TypeAlias = tuple[int, int, bool]
"""Behaviour, internal-state bits, restart."""


@dataclass(frozen=True)
class Indexing:
    """How percepts, states and outcomes are numbered.

    A *situation* (table row) is (percept bits, behaviour, internal-state bits) at the start of the
    step: `(percepts * behaviours + behaviour) * states + state`. An *outcome* (column) is
    (behaviour, internal-state bits, restart) after all rules:
    `(behaviour * states + state) * 2 + restart`, where restart says that the behaviour was switched
    into during the step and starts afresh.
    """

    percepts: int
    behaviours: int
    states: int

    @classmethod
    def of(cls, vocabulary: Vocabulary) -> Indexing:
        """The numbering that belongs to a vocabulary."""
        return cls(
            percepts=1 << len(vocabulary.preconditions),
            behaviours=len(vocabulary.behaviours),
            states=1 << len(vocabulary.internal_states),
        )

    @property
    def situations(self) -> int:
        """Number of table rows."""
        return self.percepts * self.behaviours * self.states

    @property
    def outcomes(self) -> int:
        """Number of table columns."""
        return self.behaviours * self.states * 2

    def situation(self, percepts: int, behaviour: int, state: int) -> int:
        """Row of one situation."""
        return (percepts * self.behaviours + behaviour) * self.states + state

    def outcome(self, behaviour: int, state: int, restart: bool = False) -> int:
        """Column of one outcome."""
        return (behaviour * self.states + state) * 2 + restart

    def describe_outcome(self, outcome: int) -> Outcome:
        """(behaviour, internal-state bits, restart) of a column."""
        rest, restart = divmod(outcome, 2)
        behaviour, state = divmod(rest, self.states)
        return behaviour, state, bool(restart)


@dataclass(frozen=True, eq=False)
class ControlTable:
    """Outcome distribution of every situation.

    Attributes:
        probabilities: Shape (situations, outcomes), float64, rows sum to 1; numbered by `indexing`.
        vocabulary: The names that the numbers stand for.
    """

    probabilities: FloatArray
    vocabulary: Vocabulary

    @property
    def indexing(self) -> Indexing:
        """How rows and columns are numbered."""
        return Indexing.of(self.vocabulary)

    @classmethod
    def compile(cls, rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> ControlTable:
        """Compile the enabled rules.

        Raises:
            RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        """
        require_known_names(rule_set, vocabulary)
        indexing = Indexing.of(vocabulary)
        distribution = before_any_rule(vocabulary)
        for rule in rule_set.active_rules:
            distribution = apply_rule(distribution, rule, vocabulary)
        table = np.ascontiguousarray(distribution.reshape(indexing.situations, indexing.outcomes))
        table.setflags(write=False)
        return cls(table, vocabulary)


def before_any_rule(vocabulary: Vocabulary) -> FloatArray:
    """Nothing has changed yet; shape (percepts, behaviours * states, outcomes)."""
    indexing = Indexing.of(vocabulary)
    starts = indexing.behaviours * indexing.states
    identity = np.zeros((starts, indexing.outcomes))
    identity[np.arange(starts), 2 * np.arange(starts)] = 1.0
    return np.broadcast_to(identity, (indexing.percepts, *identity.shape)).copy()


def apply_rule(distribution: FloatArray, rule: Rule, vocabulary: Vocabulary) -> FloatArray:
    """The distribution after one more rule.

    The rule applies its actions, in order, to the part in which it is active when its turn comes.

    Args:
        distribution: Shape (percepts, any, outcomes).
        rule: Whether it is enabled is not asked.
        vocabulary: The names that the numbers stand for.
    """
    active = distribution * active_part(rule, vocabulary)
    waiting = distribution - active
    for action in rule.actions:
        active = apply_action(active, action, vocabulary)
    return waiting + active


def apply_action(distribution: FloatArray, action: Action, vocabulary: Vocabulary) -> FloatArray:
    """Mix in the outcomes of the action with its probability; shape (..., outcomes)."""
    if isinstance(action, BehaviourChange):
        matrix = _behaviour_matrix(action.behaviour, vocabulary)
    else:
        matrix = _state_matrix(action.state, action.value, vocabulary)
    done = distribution @ matrix
    return (1.0 - action.p) * distribution + action.p * done


def active_part(rule: Rule, vocabulary: Vocabulary) -> FloatArray:
    """1 where the rule is active, else 0; shape (percepts, 1, outcomes), read-only."""
    return _active_part(rule.preconditions, rule.behaviours, vocabulary)


@lru_cache(maxsize=4096)
def _active_part(
    preconditions: tuple[Precondition, ...], behaviours: tuple[str, ...], vocabulary: Vocabulary
) -> FloatArray:
    indexing = Indexing.of(vocabulary)
    percepts = np.ones(indexing.percepts)
    for precondition in preconditions:
        bit = vocabulary.precondition_index[precondition.name]
        sensed = (np.arange(indexing.percepts) >> bit) & 1
        percepts *= sensed == precondition.holds
    current = np.zeros(indexing.behaviours)
    current[[vocabulary.behaviour_index[name] for name in behaviours] or slice(None)] = 1.0
    outcomes = np.repeat(current, indexing.states * 2)
    part = percepts[:, None, None] * outcomes[None, None, :]
    part.setflags(write=False)
    return part


@lru_cache(maxsize=64)
def _behaviour_matrix(name: str, vocabulary: Vocabulary) -> FloatArray:
    """What a change of the behaviour does, as a 0/1 matrix, shape (outcomes, outcomes)."""
    target = vocabulary.behaviour_index[name]
    restarts = vocabulary.behaviours[target].restarts

    def effect(behaviour: int, state: int, restart: bool) -> Outcome:
        return target, state, restart if behaviour == target else restarts

    return _matrix(effect, vocabulary)


@lru_cache(maxsize=64)
def _state_matrix(name: str, value: bool, vocabulary: Vocabulary) -> FloatArray:
    """What setting an internal state does, as a 0/1 matrix, shape (outcomes, outcomes)."""
    bit = 1 << vocabulary.state_index[name]

    def effect(behaviour: int, state: int, restart: bool) -> Outcome:
        return behaviour, state | bit if value else state & ~bit, restart

    return _matrix(effect, vocabulary)


def _matrix(effect: Callable[[int, int, bool], Outcome], vocabulary: Vocabulary) -> FloatArray:
    indexing = Indexing.of(vocabulary)
    matrix = np.zeros((indexing.outcomes, indexing.outcomes))
    for before in range(indexing.outcomes):
        after = effect(*indexing.describe_outcome(before))
        matrix[before, indexing.outcome(*after)] = 1.0
    matrix.setflags(write=False)
    return matrix
