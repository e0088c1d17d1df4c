"""Rules as plain English sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from geswarm.rules.elements import format_boolean, format_probability
from geswarm.rules.model import (
    CONTROL_STEP,
    Action,
    BehaviourChange,
    Precondition,
    Rule,
    RuleSet,
)
from geswarm.rules.vocabulary import FORAGING, Vocabulary

NEVER_SECONDS = 1e6
"""Longer mean waiting times are called never; the paper's runs last 5000 s."""


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
    preconditions = list(dict.fromkeys(rule.preconditions))
    clashing = [
        entry
        for entry in preconditions
        if Precondition(entry.name, not entry.holds) in preconditions
    ]
    sensed = [_percept(entry, vocabulary) for entry in clashing or preconditions]
    if clashing:
        return f"never, because a robot cannot be {join_phrases(sensed, 'and')} at once:"
    parts = [f"when {join_phrases(sensed, 'and')}"] if sensed else []
    if rule.behaviours:
        doing = [_doing(name, vocabulary) for name in dict.fromkeys(rule.behaviours)]
        parts.append(f"while {join_phrases(doing, 'or')}")
    return f"{', '.join(parts) or 'at any time'},"


def _percept(precondition: Precondition, vocabulary: Vocabulary) -> str:
    bit = vocabulary.precondition_index.get(precondition.name)
    if bit is None:
        return f"{precondition.name!r} is {format_boolean(precondition.holds)}"
    entry = vocabulary.preconditions[bit]
    return entry.holds if precondition.holds else entry.fails


def _doing(name: str, vocabulary: Vocabulary) -> str:
    code = vocabulary.behaviour_index.get(name)
    return f"doing {name!r}" if code is None else vocabulary.behaviours[code].doing


def _effects(actions: Sequence[Action], vocabulary: Vocabulary) -> str:
    """All actions in order; `then` where a later one can override an earlier one."""
    if not actions:
        return "do nothing"
    phrases = [f"{_deed(action, vocabulary)}{_chance(action.p)}" for action in actions]
    overriding = len(set(map(_target, actions))) < len(actions)
    if overriding:
        return ", then ".join(phrases)
    if all(action.p == 1 for action in actions):
        return join_phrases(phrases, "and")
    return ", and ".join(phrases)


def _target(action: Action) -> str:
    """What the action sets: the behaviour or one of the internal states."""
    return "" if isinstance(action, BehaviourChange) else action.state


def _deed(action: Action, vocabulary: Vocabulary) -> str:
    if isinstance(action, BehaviourChange):
        code = vocabulary.behaviour_index.get(action.behaviour)
        return f"start {action.behaviour!r}" if code is None else vocabulary.behaviours[code].start
    bit = vocabulary.state_index.get(action.state)
    if bit is None:
        return f"set {action.state!r} to {format_boolean(action.value)}"
    entry = vocabulary.internal_states[bit]
    return entry.on if action.value else entry.off


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
