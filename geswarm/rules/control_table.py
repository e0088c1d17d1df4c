"""ControlTable: a rule set as the exact outcome distribution of one control step.

A rule set is a probabilistic finite state machine (paper, section 5). For every combination of
percepts, behaviour and internal states at the start of a step, the distribution over what the robot
decides is finite; compiling it once makes a control step one table row and one random number,
whatever the number of rules.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.check import require_known_names
from geswarm.rules.model import Action, BehaviourChange, Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary

FloatArray: TypeAlias = npt.NDArray[np.float64]


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

    def describe_outcome(self, outcome: int) -> tuple[int, int, bool]:
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

        Every action is a 0/1 matrix on outcomes, mixed in with its probability; a rule applies its
        actions to the part of the distribution in which it is active when its turn comes.

        Raises:
            RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        """
        require_known_names(rule_set, vocabulary)
        indexing = Indexing.of(vocabulary)
        distribution = _before_any_rule(indexing)
        for rule in rule_set.active_rules:
            active = distribution * _active(rule, vocabulary)
            waiting = distribution - active
            for action in rule.actions:
                active = (1.0 - action.p) * active + action.p * (
                    active @ _action_matrix(action, vocabulary)
                )
            distribution = waiting + active
        table = np.ascontiguousarray(distribution.reshape(indexing.situations, indexing.outcomes))
        table.setflags(write=False)
        return cls(table, vocabulary)


def _before_any_rule(indexing: Indexing) -> FloatArray:
    """Nothing has changed yet; shape (percepts, behaviours * states, outcomes)."""
    starts = indexing.behaviours * indexing.states
    identity = np.zeros((starts, indexing.outcomes))
    identity[np.arange(starts), 2 * np.arange(starts)] = 1.0
    return np.broadcast_to(identity, (indexing.percepts, *identity.shape)).copy()


def _active(rule: Rule, vocabulary: Vocabulary) -> FloatArray:
    """1 where the rule is active, else 0; shape (percepts, 1, outcomes)."""
    indexing = Indexing.of(vocabulary)
    percepts = np.ones(indexing.percepts)
    for precondition in rule.preconditions:
        bit = vocabulary.precondition_index[precondition.name]
        sensed = (np.arange(indexing.percepts) >> bit) & 1
        percepts *= sensed == precondition.holds
    behaviours = np.zeros(indexing.behaviours)
    behaviours[[vocabulary.behaviour_index[name] for name in rule.behaviours] or slice(None)] = 1.0
    outcomes = np.repeat(behaviours, indexing.states * 2)
    return percepts[:, None, None] * outcomes[None, None, :]


def _action_matrix(action: Action, vocabulary: Vocabulary) -> FloatArray:
    """The action as a 0/1 matrix from outcome to outcome, shape (outcomes, outcomes)."""
    indexing = Indexing.of(vocabulary)
    matrix = np.zeros((indexing.outcomes, indexing.outcomes))
    for before in range(indexing.outcomes):
        behaviour, state, restart = indexing.describe_outcome(before)
        if isinstance(action, BehaviourChange):
            target = vocabulary.behaviour_index[action.behaviour]
            if target != behaviour:
                restart = vocabulary.behaviours[target].restarts
            behaviour = target
        else:
            bit = 1 << vocabulary.state_index[action.state]
            state = state | bit if action.value else state & ~bit
        matrix[before, indexing.outcome(behaviour, state, restart)] = 1.0
    return matrix
