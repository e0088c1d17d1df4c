"""The rule set being edited, with its history: every change can be taken back."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from geswarm.rules import Rule, RuleSet, apply_edit

MAX_HISTORY = 1000


class RuleDocument:
    """A rule set with undo and redo.

    Attributes:
        rule_set: As it stands now.
        version: Counts the changes; never goes back, not even by undo.
        loaded: The rule set that was loaded last, for comparison.
    """

    def __init__(self, rule_set: RuleSet) -> None:
        self.rule_set = rule_set
        self.version = 1
        self.loaded = rule_set
        self._past: list[RuleSet] = []
        self._future: list[RuleSet] = []

    @property
    def can_undo(self) -> bool:
        """True if there is a change to take back."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """True if there is a change to make again."""
        return bool(self._future)

    @property
    def before(self) -> RuleSet | None:
        """The rules before the last change that is more than words; None if there was none."""
        now = bare_rules(self.rule_set)
        return next((past for past in reversed(self._past) if bare_rules(past) != now), None)

    def edit(self, edit: dict[str, Any]) -> None:
        """Make one edit (see `geswarm.rules.edits`).

        Raises:
            EditError: It cannot be made; the document is untouched.
        """
        self.replace(apply_edit(self.rule_set, edit))

    def load(self, rule_set: RuleSet) -> None:
        """Put a rule set from elsewhere in place; differences are counted from it."""
        self.loaded = rule_set
        self.replace(rule_set)

    def replace(self, rule_set: RuleSet) -> None:
        """Put another rule set in place; `undo` brings the present one back."""
        if rule_set == self.rule_set:
            return
        self._past = [*self._past[-MAX_HISTORY + 1 :], self.rule_set]
        self._future = []
        self._show(rule_set)

    def undo(self) -> None:
        """Take the last change back, if there is one."""
        if self._past:
            self._future.append(self.rule_set)
            self._show(self._past.pop())

    def redo(self) -> None:
        """Make the last change taken back again, if there is one."""
        if self._future:
            self._past.append(self.rule_set)
            self._show(self._future.pop())

    def _show(self, rule_set: RuleSet) -> None:
        self.rule_set = rule_set
        self.version += 1


def bare_rules(rule_set: RuleSet) -> tuple[Rule, ...]:
    """The rules without their comments: what the robots see of them."""
    return tuple(replace(rule, comment="") for rule in rule_set.rules)
