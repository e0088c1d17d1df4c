"""ControlTable: a rule set as the exact outcome distribution of one control step.

A rule set is a probabilistic finite state machine (paper, section 5). For every combination of
percepts, behaviour and internal states at the start of a step, the distribution over what the robot
decides is finite; compiling it once makes a control step one table row and one random number,
whatever the number of rules.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geswarm.rules.model import Action, Precondition, Rule, RuleSet, Term
from geswarm.rules.names import require_known_names
from geswarm.rules.space import FloatArray, Space
from geswarm.rules.vocabulary import FORAGING, Vocabulary


@dataclass(frozen=True, eq=False)
class ControlTable:
    """Outcome distribution of every situation.

    Attributes:
        probabilities: Shape (situations, outcomes), float64, rows sum to 1; numbered by `space`.
        space: What the numbers stand for.
    """

    probabilities: FloatArray
    space: Space

    @classmethod
    def compile(cls, rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> ControlTable:
        """Compile the enabled rules.

        Raises:
            RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        """
        require_known_names(rule_set, vocabulary)
        return cls.within(Space.of(vocabulary, rule_set), rule_set)

    @classmethod
    def within(cls, space: Space, rule_set: RuleSet) -> ControlTable:
        """Compile rules whose names are known, numbered as a space says."""
        distribution = before_any_rule(space)
        for rule in rule_set.active_rules:
            distribution = apply_rule(distribution, rule, space)
        table = np.ascontiguousarray(distribution.reshape(space.situations, space.outcomes))
        table.setflags(write=False)
        return cls(table, space)

    @property
    def by_percepts(self) -> FloatArray:
        """The same, shape (percepts, behaviours * states, outcomes)."""
        space = self.space
        return self.probabilities.reshape(space.percepts, space.starts, space.outcomes)


def before_any_rule(space: Space) -> FloatArray:
    """Nothing has changed yet; shape (percepts, behaviours * states, outcomes)."""
    identity = np.zeros((space.starts, space.outcomes))
    identity[np.arange(space.starts), 2 * np.arange(space.starts)] = 1.0
    return np.broadcast_to(identity, (space.percepts, *identity.shape)).copy()


def apply_rule(distribution: FloatArray, rule: Rule, space: Space) -> FloatArray:
    """The distribution after one more rule.

    The rule applies its actions, in order, to the part in which it is active when its turn comes.

    Args:
        distribution: Shape (percepts, any, outcomes).
        rule: Whether it is enabled is not asked.
        space: What the numbers stand for.
    """
    active = distribution * active_part(rule, space)
    waiting = distribution - active
    for action in rule.actions:
        active = apply_action(active, action, space)
    return waiting + active


def apply_action(distribution: FloatArray, action: Action, space: Space) -> FloatArray:
    """Mix in the outcomes of the action with its probability; shape (..., outcomes)."""
    done = distribution @ space.effect(action)
    return (1.0 - action.p) * distribution + action.p * done


def active_part(rule: Rule, space: Space) -> FloatArray:
    """How probably the rule is active where; shape (percepts, 1, outcomes), read-only.

    0 or 1, unless a precondition holds by chance; each that does is drawn on its own.
    """
    return _active_part(rule.preconditions, rule.behaviours, space)


@lru_cache(maxsize=4096)
def _active_part(
    preconditions: tuple[Precondition, ...], behaviours: tuple[Term, ...], space: Space
) -> FloatArray:
    percepts = np.ones(space.percepts)
    for precondition in preconditions:
        percepts *= space.chance(precondition)
    current = np.zeros(len(space.behaviours))
    current[[space.behaviours.index(term) for term in behaviours] or slice(None)] = 1.0
    outcomes = np.repeat(current, space.states * 2)
    part = percepts[:, None, None] * outcomes[None, None, :]
    part.setflags(write=False)
    return part
