"""What a vocabulary does not know of a rule set, and what therefore forbids running it."""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.rules.findings import Finding, Place, RuleSetError, shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary


def probability_error(p: float) -> str | None:
    """Why p is not a probability, or None if it is."""
    if isinstance(p, bool) or not is_finite(p) or not 0.0 <= p <= 1.0:
        return f"probability must be between 0 and 1, got {shown(p)}"
    return None


def require_known_names(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> None:
    """Raise RuleSetError if the rule set has something unknown or a p outside [0, 1]."""
    if errors := name_errors(rule_set, vocabulary):
        raise RuleSetError(errors)


def name_errors(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[Finding]:
    """Every unknown name or value and every p outside [0, 1], in the order of the rules."""
    return [
        Finding(Place(rule=number, element=element), message)
        for number, rule in enumerate(rule_set.rules, start=1)
        for element, message in _in_rule(rule, vocabulary)
        if message
    ]


def unknown_terms(rule_set: RuleSet, vocabulary: Vocabulary) -> tuple[str, ...]:
    """The names in a rule set that a vocabulary does not have, in alphabetical order."""
    known = (
        vocabulary.percepts.keys()
        | vocabulary.behaviour_names.keys()
        | vocabulary.state_names.keys()
    )
    return tuple(sorted(set(_names(rule_set)) - known))


def _names(rule_set: RuleSet) -> Iterator[str]:
    """Every name of a term in a rule set."""
    for rule in rule_set.rules:
        yield from (each.percept.name for each in rule.preconditions)
        yield from (each.name for each in rule.behaviours)
        for action in rule.actions:
            yield from (each.name for each in action.behaviours)
            yield from [action.target] if action.target else []


def _in_rule(rule: Rule, vocabulary: Vocabulary) -> Iterator[tuple[str, str | None]]:
    for at, precondition in enumerate(rule.preconditions, start=1):
        yield f"precondition {at}", vocabulary.precondition_error(precondition)
    for at, behaviour in enumerate(rule.behaviours, start=1):
        yield f"behaviour {at}", vocabulary.behaviour_error(behaviour)
    for at, action in enumerate(rule.actions, start=1):
        yield f"action {at}", action.error(vocabulary)
        yield f"action {at}", probability_error(action.p)
