"""The shortest rule set found with exactly the same behaviour."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

from geswarm.rules.control_table import apply_rule
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.reachability import Trace, effective_outcomes, is_nothing, no_change
from geswarm.rules.space import FloatArray
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_IsSame: TypeAlias = Callable[[Rule | None], bool]
_Shorten: TypeAlias = Callable[[Rule, _IsSame], Rule | None]


@dataclass(frozen=True)
class Simplification:
    """A shorter rule set and what was left out.

    Attributes:
        rule_set: Behaves exactly as the original in all situations that robots can get into.
        removed: `rule 3` or `rule 2: action p = 1, PHOTOTAXIS`, numbered as in the original.
    """

    rule_set: RuleSet
    removed: tuple[str, ...]


def simplify(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> Simplification:
    """Leave out, one after the other, every piece without which the behaviour stays the same.

    Whole rules first, the last one first; then actions, preconditions and behaviours; again until
    nothing more can go. Removing preconditions or all behaviours of a rule lets it hold more often,
    in situations where that makes no difference. Comments and names stay, rules that are switched
    off stay as they are: they have no behaviour that could be kept.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    rules: list[Rule | None] = [rule if rule.enabled else None for rule in rule_set.rules]
    target = Trace.of(rule_set, vocabulary)
    before: list[Rule | None] = []
    while rules != before:
        before = rules
        for shorten in (_without_rule, _without_pieces):
            rules = _sweep(rules, shorten, target)
    kept = [
        rule if original.enabled else original
        for original, rule in zip(rule_set.rules, rules, strict=True)
    ]
    removed = [
        line
        for number, (original, rule) in enumerate(zip(rule_set.rules, kept, strict=True), start=1)
        for line in _removed(number, original, rule)
    ]
    remaining = tuple(rule for rule in kept if rule is not None)
    return Simplification(replace(rule_set, rules=remaining), tuple(removed))


def _sweep(rules: list[Rule | None], shorten: _Shorten, target: Trace) -> list[Rule | None]:
    """Shorten the rules from the last to the first as far as `target` allows; None is no rule."""
    space = target.space
    before = [target.before[0]]
    for rule in rules:
        before.append(apply_rule(before[-1], rule, space) if rule else before[-1])
    after = effective_outcomes(space)
    swept = list(rules)
    for at in reversed(range(len(rules))):
        rule = rules[at]
        if rule is not None:
            swept[at] = rule = shorten(rule, partial(_is_same, target, before[at], after))
        if rule is not None:
            after = apply_rule(no_change(space), rule, space) @ after
    return swept


def _is_same(target: Trace, turn: FloatArray, after: FloatArray, rule: Rule | None) -> bool:
    """Whether `rule` may stand where `turn` comes before it and `after` are the rules behind it."""
    done = turn if rule is None else apply_rule(turn, rule, target.space)
    return is_nothing(done @ after - target.decided)


def _without_rule(rule: Rule, is_same: _IsSame) -> Rule | None:
    return None if is_same(None) else rule


def _without_pieces(rule: Rule, is_same: _IsSame) -> Rule:
    """Without each piece that can go, the last one first."""
    for part in ("actions", "preconditions", "behaviours"):
        anywhere = replace(rule, behaviours=())
        if part == "behaviours" and is_same(anywhere):
            rule = anywhere
        for index in reversed(range(len(getattr(rule, part)))):
            elements: tuple[Any, ...] = getattr(rule, part)
            changes: dict[str, Any] = {part: elements[:index] + elements[index + 1 :]}
            shorter = replace(rule, **changes)
            if shorter != anywhere and is_same(shorter):
                rule = shorter
    return rule


def _removed(number: int, original: Rule, rule: Rule | None) -> Iterator[str]:
    if rule is None:
        yield f"rule {number}"
        return
    for kind, elements, kept in (
        (
            "precondition",
            *(map(str, each.preconditions) for each in (original, rule)),
        ),
        ("behaviour", *(map(str, each.behaviours) for each in (original, rule))),
        ("action", *(map(str, each.actions) for each in (original, rule))),
    ):
        for element in (Counter(elements) - Counter(kept)).elements():
            yield f"rule {number}: {kind} {element}"
