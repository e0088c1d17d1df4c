"""Rules as plain English sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from geswarm.rules.elements import format_probability
from geswarm.rules.model import (
    CONTROL_STEP,
    Action,
    Precondition,
    Rule,
    RuleSet,
    Term,
    format_value,
)
from geswarm.rules.vocabulary import FORAGING, Vocabulary

NEVER_SECONDS = 1e6
"""Longer mean waiting times are called never; the paper's runs last 5000 s."""

_IS = {"==": "is", "!=": "is not"} | {sign: f"is {sign}" for sign in (">=", "<=", ">", "<")}


def describe(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[str]:
    """One sentence for every rule."""
    return [describe_rule(rule, vocabulary) for rule in rule_set.rules]


def describe_rule(rule: Rule, vocabulary: Vocabulary = FORAGING) -> str:
    """One sentence that says when the rule fires and what it does.

    Names that the vocabulary does not know are quoted as they stand.
    """
    sentence = f"{_condition(rule, vocabulary)} {_effects(rule.actions, vocabulary)}."
    sentence = sentence[0].upper() + sentence[1:]
    return sentence if rule.enabled else f"(switched off) {sentence}"


def _condition(rule: Rule, vocabulary: Vocabulary) -> str:
    preconditions = [
        entry
        for at, entry in enumerate(rule.preconditions)
        if vocabulary.is_drawn(entry) or entry not in rule.preconditions[:at]
    ]
    clashing = [
        entry
        for entry in preconditions
        if isinstance(entry.value, bool)
        and not vocabulary.is_drawn(entry)
        and replace(entry, value=not entry.value) in preconditions
    ]
    sensed = [_percept(entry, vocabulary) for entry in clashing or preconditions]
    if clashing:
        return f"never, because a robot cannot be {join_phrases(sensed, 'and')} at once:"
    parts = [f"when {join_phrases(sensed, 'and')}"] if sensed else []
    if rule.behaviours:
        doing = [_doing(entry, vocabulary) for entry in dict.fromkeys(rule.behaviours)]
        parts.append(f"while {join_phrases(doing, 'or')}")
    return f"{', '.join(parts) or 'at any time'},"


def _percept(precondition: Precondition, vocabulary: Vocabulary) -> str:
    known = vocabulary.percepts.get(precondition.percept.name)
    if known is None:
        value = format_value(precondition.value)
        return f"{str(precondition.percept)!r} {_IS[precondition.comparison]} {value}"
    return known.says(precondition)


def _doing(behaviour: Term, vocabulary: Vocabulary) -> str:
    known = vocabulary.behaviour_names.get(behaviour.name)
    return known.says(behaviour)[0] if known else f"doing {str(behaviour)!r}"


def _effects(actions: Sequence[Action], vocabulary: Vocabulary) -> str:
    """All actions in order; `then` where a later one can override an earlier one."""
    if not actions:
        return "do nothing"
    phrases = [f"{action.says(vocabulary)}{_chance(action.p)}" for action in actions]
    overriding = len({action.target for action in actions}) < len(actions)
    if overriding:
        return ", then ".join(phrases)
    if all(action.p == 1 for action in actions):
        return join_phrases(phrases, "and")
    return ", and ".join(phrases)


def _chance(p: float) -> str:
    """Nothing for p = 1, else the probability and the mean time until it happens."""
    if p == 1:
        return ""
    if not 0 < p < 1:
        return f" with probability {format_probability(p)} (never)"
    seconds = CONTROL_STEP / p
    if seconds > NEVER_SECONDS:
        mean = "practically never"
    else:
        mean = f"about every {seconds:.1f} s" if seconds < 10 else f"about every {seconds:.0f} s"
    return f" with probability {format_probability(p)} per step ({mean})"


def join_phrases(phrases: Iterable[str], last: str) -> str:
    """`a`, `a and b`, `a, b and c`."""
    *front, end = [*phrases] or [""]
    return f"{', '.join(front)} {last} {end}" if front else end
