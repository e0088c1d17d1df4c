"""What is wrong with a rule set, all of it at once, each finding with its place."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from geswarm.rules.model import BehaviourChange, Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary


@dataclass(frozen=True)
class Place:
    """Where a finding is: file and line (text input), rule number and element within the rule.

    `rule` counts from 1; `element` is the reader's word for the part, for example `action 2`.
    """

    source: str = ""
    line: int | None = None
    rule: int | None = None
    element: str = ""

    def __str__(self) -> str:
        where = self.source
        if self.line is not None:
            where = f"{where}:{self.line}" if where else f"line {self.line}"
        inside = [f"rule {self.rule}"] if self.rule is not None else []
        inside += [self.element] if self.element else []
        return ": ".join(part for part in (where, ", ".join(inside)) if part)


@dataclass(frozen=True)
class Finding:
    """One thing to know about a rule set; an error forbids running it, a warning does not."""

    place: Place
    message: str
    severity: Literal["error", "warning"] = "error"

    def __str__(self) -> str:
        return f"{self.place}: {self.message}" if str(self.place) else self.message


class RuleSetError(ValueError):
    """A rule set cannot be used; `findings` lists every reason."""

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(str(finding) for finding in self.findings))


def unknown_name(kind: str, given: str, known: Iterable[str]) -> str:
    """Message for a name that is not in the vocabulary, with the nearest one that is."""
    known = list(known)
    upper = given.upper().replace("-", "_")
    by_folded = {name.upper().replace("-", "_"): name for name in known}
    near = difflib.get_close_matches(upper, by_folded, n=1, cutoff=0.5)
    hint = f"did you mean {by_folded[near[0]]}?" if near else f"expected {' or '.join(known)}"
    return f"unknown {kind} {given!r}; {hint}"


def probability_error(p: float) -> str | None:
    """Why p is not a probability, or None if it is."""
    if isinstance(p, bool) or not math.isfinite(p) or not 0.0 <= p <= 1.0:
        return f"probability must be between 0 and 1, got {p}"
    return None


def check(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[Finding]:
    """All findings of a rule set, errors and warnings, in the order of the rules."""
    findings: list[Finding] = []
    for number, rule in enumerate(rule_set.rules, start=1):
        findings += _unknown_names(number, rule, vocabulary)
        findings += _doubtful_parts(number, rule)
    if not rule_set.active_rules:
        findings.append(
            Finding(Place(), "there is no rule that is switched on: robots only walk", "warning")
        )
    return findings


def require_known_names(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> None:
    """Raise RuleSetError if the rule set has an unknown name or a p outside [0, 1]."""
    errors = [
        finding
        for number, rule in enumerate(rule_set.rules, start=1)
        for finding in _unknown_names(number, rule, vocabulary)
    ]
    if errors:
        raise RuleSetError(errors)


def _unknown_names(number: int, rule: Rule, vocabulary: Vocabulary) -> Iterator[Finding]:
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


def _doubtful_parts(number: int, rule: Rule) -> Iterator[Finding]:
    if not rule.actions:
        place = Place(rule=number, element="actions")
        yield Finding(place, "no action: this rule does nothing", "warning")
    sensed: dict[str, bool] = {}
    for at, precondition in enumerate(rule.preconditions, start=1):
        place = Place(rule=number, element=f"precondition {at}")
        if sensed.setdefault(precondition.name, precondition.holds) != precondition.holds:
            message = f"{precondition.name} cannot be both true and false: this rule never fires"
            yield Finding(place, message, "warning")
    for at, action in enumerate(rule.actions, start=1):
        if action.p == 0:
            place = Place(rule=number, element=f"action {at}")
            yield Finding(place, "p = 0: this action never happens", "warning")
