"""The rule set being edited, with its history: every change can be taken back."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import msgspec

from geswarm.rules import FORAGING, Rule, RuleSet, Vocabulary, apply_edit

from ..protocol.edits import AnyEdit, MoveRule, PlaceEdit, RuleEdit

MAX_HISTORY = 1000
MAX_LATE = 100
"""Versions by which an edit may be late, and still find the rule it was meant for."""


_Standing: TypeAlias = tuple[RuleSet, RuleSet]
"""A rule set, and which one had been loaded last then."""


class StaleError(Exception):
    """What an edit was meant for is no longer there, or no longer what it was."""


class RuleDocument:
    """A rule set with undo and redo.

    Attributes:
        rule_set: As it stands now.
        version: Counts the changes; never goes back, not even by undo.
        loaded: The rule set that was loaded last, for comparison; undo takes a load back too.
        saved: The rule set that was saved last; at first the one loaded.
    """

    def __init__(self, rule_set: RuleSet) -> None:
        self.rule_set = rule_set
        self.version = 1
        self.loaded = self.saved = rule_set
        self._past: list[_Standing] = []
        self._future: list[_Standing] = []
        self._recent = deque([rule_set], MAX_LATE + 1)

    @property
    def can_undo(self) -> bool:
        """True if there is a change to take back."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """True if there is a change to make again."""
        return bool(self._future)

    @property
    def unsaved(self) -> RuleSet | None:
        """The rules, if a crash would lose them; None if they are as loaded or saved."""
        return None if self.rule_set in (self.loaded, self.saved) else self.rule_set

    @property
    def before(self) -> RuleSet | None:
        """The rules before the last change that is more than words; None if there was none."""
        now = bare_rules(self.rule_set)
        return next((past for past, _ in reversed(self._past) if bare_rules(past) != now), None)

    def edit(self, edit: AnyEdit, vocabulary: Vocabulary = FORAGING) -> None:
        """Make one edit.

        Raises:
            EditError: It cannot be made; the document is untouched.
        """
        self.replace(apply_edit(self.rule_set, msgspec.to_builtins(edit), vocabulary))

    def caught_up(self, edit: AnyEdit, version: int) -> AnyEdit:
        """An edit that was meant for an earlier version, as it is meant for this one.

        Raises:
            StaleError: Its rule has gone or been changed meanwhile, or the version is unknown.
        """
        late = self.version - version
        if not 0 <= late < len(self._recent):
            raise StaleError
        return _moved(edit, self._recent[-1 - late].rules, self.rule_set.rules)

    def begin_anew(self, rule_set: RuleSet) -> None:
        """Forget everything before: the rules are in other words now."""
        self._past, self._future = [], []
        self.saved = rule_set
        self._show(rule_set, rule_set)

    def load(self, rule_set: RuleSet) -> None:
        """Put a rule set from elsewhere in place; differences are counted from it."""
        self._replace(rule_set, rule_set)

    def replace(self, rule_set: RuleSet) -> None:
        """Put another rule set in place; `undo` brings the present one back."""
        self._replace(rule_set, self.loaded)

    def undo(self) -> None:
        """Take the last change back, if there is one."""
        if self._past:
            self._future.append((self.rule_set, self.loaded))
            self._show(*self._past.pop())

    def redo(self) -> None:
        """Make the last change taken back again, if there is one."""
        if self._future:
            self._past.append((self.rule_set, self.loaded))
            self._show(*self._future.pop())

    def _replace(self, rule_set: RuleSet, loaded: RuleSet) -> None:
        if rule_set == self.rule_set:
            self.loaded = loaded
            return
        self._past = [*self._past[-MAX_HISTORY + 1 :], (self.rule_set, self.loaded)]
        self._future = []
        self._show(rule_set, loaded)

    def _show(self, rule_set: RuleSet, loaded: RuleSet) -> None:
        self.rule_set, self.loaded = rule_set, loaded
        self.version += 1
        self._recent.append(rule_set)


def _moved(edit: AnyEdit, before: Sequence[Rule], now: Sequence[Rule]) -> AnyEdit:
    """The same edit, with the places of its rules as they are now."""
    if isinstance(edit, MoveRule):
        edit = msgspec.structs.replace(edit, to=min(edit.to, len(now) - 1))
    if isinstance(edit, PlaceEdit):
        return msgspec.structs.replace(edit, at=_place(edit.at, before, now))
    if isinstance(edit, RuleEdit):
        return msgspec.structs.replace(edit, rule=_place(edit.rule, before, now))
    return edit


def _place(place: int, before: Sequence[Rule], now: Sequence[Rule]) -> int:
    """Where a rule is now; behind the last one stays behind the last one."""
    if place == len(before):
        return len(now)
    if not 0 <= place < len(before):
        raise StaleError
    same = [at for at, rule in enumerate(now) if rule == before[place]]
    if not same:
        raise StaleError
    return same[min(before[:place].count(before[place]), len(same) - 1)]


def bare_rules(rule_set: RuleSet) -> tuple[Rule, ...]:
    """The rules without their comments: what the robots see of them."""
    return tuple(replace(rule, comment="") for rule in rule_set.rules)
