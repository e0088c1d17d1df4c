"""What each piece of a rule set is worth: knock it out, run again, compare.

The paper reads the principles of EVO 8 from its rules by eye (section 3.2.1, Table 2); this
measures them. All versions run with the same random streams, so small differences show.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from geswarm.analysis.statistics import PairedDifference, paired_difference
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import RuleSet
from geswarm.sim import Scenario

Part: TypeAlias = Literal["rule", "preconditions", "behaviours", "actions"]
_PARTS: tuple[Part, ...] = ("preconditions", "behaviours", "actions")


@dataclass(frozen=True)
class Piece:
    """A rule, or one element of a rule.

    Attributes:
        rule: Index of the rule, from 0.
        part: `rule` for the whole rule.
        at: Index within the part; None for the whole rule.
    """

    rule: int
    part: Part = "rule"
    at: int | None = None


@dataclass(frozen=True)
class Worth:
    """What removing a piece does to the objective: negative if the piece is good."""

    piece: Piece
    change: PairedDifference


def pieces(rule_set: RuleSet) -> Iterator[Piece]:
    """All pieces of the rules that are switched on, each rule before its elements."""
    for number, rule in enumerate(rule_set.rules):
        if rule.enabled:
            yield Piece(number)
            for part in _PARTS:
                yield from (Piece(number, part, at) for at in range(len(getattr(rule, part))))


def without(rule_set: RuleSet, piece: Piece) -> RuleSet:
    """The rule set with one piece taken out.

    A rule is switched off, so that the others keep their numbers. A rule without behaviours is for
    any behaviour, one without preconditions for always: that is what knocking out the last one
    means.
    """
    rule = rule_set.rules[piece.rule]
    if piece.part == "rule" or piece.at is None:
        changed = replace(rule, enabled=False)
    else:
        elements = getattr(rule, piece.part)
        changes: dict[str, Any] = {piece.part: elements[: piece.at] + elements[piece.at + 1 :]}
        changed = replace(rule, **changes)
    rules = (*rule_set.rules[: piece.rule], changed, *rule_set.rules[piece.rule + 1 :])
    return replace(rule_set, rules=rules)


def worth_of_pieces(
    rule_set: RuleSet,
    scenario: Scenario,
    runs: int = 50,
    seed: int = 0,
    workers: int | None = None,
    stop: Callable[[], bool] | None = None,
) -> Iterator[Worth]:
    """Knock out piece after piece and yield what each was worth, as soon as it is known.

    Raises:
        EvaluationStopped: `stop` returned True.
    """

    def gains(version: RuleSet) -> Any:
        (evaluation,) = evaluate_rule_sets([version], scenario, runs, seed, workers, stop)
        return evaluation.gains

    whole = gains(rule_set)
    for piece in pieces(rule_set):
        yield Worth(piece, paired_difference(gains(without(rule_set, piece)), whole))
