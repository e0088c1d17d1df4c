"""Edits of a rule set, each a small value that makes a new rule set from an old one.

Positions count from 0 here, as in the JSON messages; error messages count from 1, as on the screen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from geswarm.rules.as_json import (
    JsonError,
    action_from_json,
    behaviour_from_json,
    precondition_from_json,
    rule_from_json,
)
from geswarm.rules.findings import RuleSetError, shown
from geswarm.rules.limits import MAX_CHARACTERS, require_size
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.text import parse_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary

MAX_COMMENT = 10_000

_ELEMENT_READERS: dict[str, Callable[[Any], Any]] = {
    "preconditions": precondition_from_json,
    "behaviours": behaviour_from_json,
    "actions": action_from_json,
}


class EditError(ValueError):
    """An edit cannot be made; the rule set stays as it is."""


def apply_edit(
    rule_set: RuleSet, edit: dict[str, Any], vocabulary: Vocabulary = FORAGING
) -> RuleSet:
    """Make one edit, given as JSON: {"do": NAME, ...} with NAME one of `EDITS`.

    Raises:
        EditError: With what was given and what was expected; `rule_set` is untouched.
    """
    make = EDITS.get(edit.get("do", "")) if isinstance(edit.get("do", ""), str) else None
    if make is None:
        raise EditError(f"unknown edit {shown(edit.get('do'))}; expected one of {', '.join(EDITS)}")
    try:
        edited = make(rule_set, edit, vocabulary)
        require_known_names(edited, vocabulary)
        require_size(edited)
    except (JsonError, RuleSetError) as error:
        raise EditError(str(error)) from error
    return edited


def _position(edit: dict[str, Any], key: str, length: int, what: str) -> int:
    value = edit.get(key)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < length:
        given = value + 1 if isinstance(value, int) else value
        raise EditError(f"there is no {what} {shown(given)}; expected 1 to {length}")
    return value


def _text(edit: dict[str, Any], key: str, most: int = MAX_COMMENT) -> str:
    value = edit.get(key)
    if not isinstance(value, str) or len(value) > most:
        raise EditError(f"{key} must be a text of at most {most} characters")
    return value


def _rule_at(rule_set: RuleSet, edit: dict[str, Any]) -> int:
    return _position(edit, "rule", len(rule_set.rules), "rule")


def _with_rule(rule_set: RuleSet, at: int, rule: Rule) -> RuleSet:
    return replace(rule_set, rules=(*rule_set.rules[:at], rule, *rule_set.rules[at + 1 :]))


def _insert(rule_set: RuleSet, at: int, *rules: Rule) -> RuleSet:
    return replace(rule_set, rules=(*rule_set.rules[:at], *rules, *rule_set.rules[at:]))


def _set_name(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    return replace(rule_set, name=_text(edit, "name"))


def _add_rule(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _position(edit, "at", len(rule_set.rules) + 1, "place for rule")
    return _insert(rule_set, at, rule_from_json(edit.get("rule", {})))


def _paste_rules(rule_set: RuleSet, edit: dict[str, Any], vocabulary: Vocabulary) -> RuleSet:
    """Insert rules written in the rule language; a name or origin among them is left out."""
    at = _position(edit, "at", len(rule_set.rules) + 1, "place for rule")
    pasted = parse_text(_text(edit, "text", MAX_CHARACTERS), vocabulary=vocabulary).rules
    if not pasted:
        raise EditError("expected at least one rule, for example: rule do p = 1, PHOTOTAXIS")
    return _insert(rule_set, at, *pasted)


def _remove_rule(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _rule_at(rule_set, edit)
    return replace(rule_set, rules=rule_set.rules[:at] + rule_set.rules[at + 1 :])


def _duplicate_rule(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _rule_at(rule_set, edit)
    return _insert(rule_set, at + 1, rule_set.rules[at])


def _move_rule(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _rule_at(rule_set, edit)
    to = _position(edit, "to", len(rule_set.rules), "place for rule")
    without = replace(rule_set, rules=rule_set.rules[:at] + rule_set.rules[at + 1 :])
    return _insert(without, to, rule_set.rules[at])


def _set_enabled(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _rule_at(rule_set, edit)
    if not isinstance(edit.get("enabled"), bool):
        raise EditError(f"enabled must be true or false, got {shown(edit.get('enabled'))}")
    return _with_rule(rule_set, at, replace(rule_set.rules[at], enabled=edit["enabled"]))


def _set_comment(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    at = _rule_at(rule_set, edit)
    return _with_rule(rule_set, at, replace(rule_set.rules[at], comment=_text(edit, "comment")))


def _change_part(
    rule_set: RuleSet,
    edit: dict[str, Any],
    change: Callable[[tuple[Any, ...], Callable[[Any], Any]], tuple[Any, ...]],
) -> RuleSet:
    """Change the preconditions, behaviours or actions of one rule."""
    at = _rule_at(rule_set, edit)
    part = edit.get("part")
    if not isinstance(part, str) or part not in _ELEMENT_READERS:
        known = ", ".join(_ELEMENT_READERS)
        raise EditError(f"unknown part {shown(part)}; expected one of {known}")
    elements = change(getattr(rule_set.rules[at], part), _ELEMENT_READERS[part])
    changes: dict[str, Any] = {part: elements}
    return _with_rule(rule_set, at, replace(rule_set.rules[at], **changes))


def _add(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    def change(elements: tuple[Any, ...], read: Callable[[Any], Any]) -> tuple[Any, ...]:
        at = _position(edit, "at", len(elements) + 1, "place")
        return (*elements[:at], read(edit.get("element")), *elements[at:])

    return _change_part(rule_set, edit, change)


def _set(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    def change(elements: tuple[Any, ...], read: Callable[[Any], Any]) -> tuple[Any, ...]:
        at = _position(edit, "at", len(elements), "element")
        return (*elements[:at], read(edit.get("element")), *elements[at + 1 :])

    return _change_part(rule_set, edit, change)


def _remove(rule_set: RuleSet, edit: dict[str, Any], _: Vocabulary) -> RuleSet:
    def change(elements: tuple[Any, ...], _read: Callable[[Any], Any]) -> tuple[Any, ...]:
        at = _position(edit, "at", len(elements), "element")
        return elements[:at] + elements[at + 1 :]

    return _change_part(rule_set, edit, change)


EDITS: dict[str, Callable[[RuleSet, dict[str, Any], Vocabulary], RuleSet]] = {
    "set_name": _set_name,
    "add_rule": _add_rule,
    "remove_rule": _remove_rule,
    "paste_rules": _paste_rules,
    "duplicate_rule": _duplicate_rule,
    "move_rule": _move_rule,
    "set_enabled": _set_enabled,
    "set_comment": _set_comment,
    "add": _add,
    "set": _set,
    "remove": _remove,
}
