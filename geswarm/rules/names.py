"""Names and probabilities that a vocabulary does not know: what forbids running a rule set."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator

from geswarm.rules.findings import Finding, Place, RuleSetError, shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import BehaviourChange, Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary


def unknown_name(kind: str, given: str, known: Iterable[str]) -> str:
    """Message for a name that is not in the vocabulary, with the nearest one that is."""
    known = list(known)
    upper = given.upper().replace("-", "_")
    by_folded = {name.upper().replace("-", "_"): name for name in known}
    near = difflib.get_close_matches(upper, by_folded, n=1, cutoff=0.5)
    hint = f"did you mean {by_folded[near[0]]}?" if near else f"expected {' or '.join(known)}"
    return f"unknown {kind} {shown(given)}; {hint}"


def probability_error(p: float) -> str | None:
    """Why p is not a probability, or None if it is."""
    if isinstance(p, bool) or not is_finite(p) or not 0.0 <= p <= 1.0:
        return f"probability must be between 0 and 1, got {shown(p)}"
    return None


def require_known_names(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> None:
    """Raise RuleSetError if the rule set has an unknown name or a p outside [0, 1]."""
    if errors := name_errors(rule_set, vocabulary):
        raise RuleSetError(errors)


def name_errors(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[Finding]:
    """Every unknown name and every p outside [0, 1], in the order of the rules."""
    return [
        finding
        for number, rule in enumerate(rule_set.rules, start=1)
        for finding in _in_rule(number, rule, vocabulary)
    ]


def _in_rule(number: int, rule: Rule, vocabulary: Vocabulary) -> Iterator[Finding]:
    for at, precondition in enumerate(rule.preconditions, start=1):
        if precondition.name not in vocabulary.precondition_index:
            message = unknown_name("precondition", precondition.name, vocabulary.precondition_index)
            yield Finding(Place(rule=number, element=f"precondition {at}"), message)
    for at, behaviour in enumerate(rule.behaviours, start=1):
        if behaviour not in vocabulary.behaviour_index:
            message = unknown_name("behaviour", behaviour, vocabulary.behaviour_index)
            yield Finding(Place(rule=number, element=f"behaviour {at}"), message)
    for at, action in enumerate(rule.actions, start=1):
        place = Place(rule=number, element=f"action {at}")
        if isinstance(action, BehaviourChange):
            if action.behaviour not in vocabulary.behaviour_index:
                known = vocabulary.behaviour_index
                yield Finding(place, unknown_name("behaviour", action.behaviour, known))
        elif action.state not in vocabulary.state_index:
            known = vocabulary.state_index
            yield Finding(place, unknown_name("internal state", action.state, known))
        if reason := probability_error(action.p):
            yield Finding(place, reason)
