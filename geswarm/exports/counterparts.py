"""Which terms of a rule set have a counterpart where it is exported to."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import RuleSet, Term


class CounterpartError(RuleSetError):
    """A rule set mentions what the form has no counterpart for; one finding for each term."""


def require_counterparts(rule_set: RuleSet, form: str, known: Collection[str]) -> None:
    """Refuse a rule set that a form cannot express.

    Args:
        rule_set: Rules that are switched off are not looked at.
        form: What it is exported to, for messages.
        known: Names of the terms that have a counterpart there, without arguments.

    Raises:
        CounterpartError: A term has none.
    """
    findings: dict[Term, Finding] = {}
    for number, element, term in _terms(rule_set):
        if term.name not in known or term.arguments:
            place = Place(rule=number, element=element)
            message = f"{term} has no counterpart in {form}"
            findings.setdefault(term, Finding(place, message))
    if findings:
        raise CounterpartError(findings.values(), rule_set.scenario)


def _terms(rule_set: RuleSet) -> Iterator[tuple[int, str, Term]]:
    """Every term of the rules that are switched on, with the number of its rule and its place."""
    for number, rule in enumerate(rule_set.rules, start=1):
        if not rule.enabled:
            continue
        for at, precondition in enumerate(rule.preconditions, start=1):
            yield number, f"precondition {at}", precondition.percept
        for at, behaviour in enumerate(rule.behaviours, start=1):
            yield number, f"behaviour {at}", behaviour
        for at, action in enumerate(rule.actions, start=1):
            for term in action.behaviours or (Term(action.target),):
                yield number, f"action {at}", term
