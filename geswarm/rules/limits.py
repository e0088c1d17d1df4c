"""How much GESwarm reads: whatever it is given, it answers soon, with one clear line."""

from __future__ import annotations

import sys

from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import RuleSet

MAX_CHARACTERS = 200_000
"""Of a file or a text that is typed or pasted."""
MAX_RULES = 1000
MAX_ELEMENTS = 1000
"""Preconditions, behaviours and actions of a rule set, all together."""


def too_long(text: str) -> str | None:
    """Why a text is not read, or None if it is short enough."""
    if len(text) > MAX_CHARACTERS:
        return f"expected at most {MAX_CHARACTERS} characters, got more"
    return None


def require_size(rule_set: RuleSet, source: str = "") -> None:
    """Bound what has to be done for a rule set when it is checked, shown and run.

    Raises:
        RuleSetError: It has more than MAX_RULES rules or MAX_ELEMENTS elements.
    """
    elements = sum(
        len(rule.preconditions) + len(rule.behaviours) + len(rule.actions)
        for rule in rule_set.rules
    )
    for number, most, what in (
        (len(rule_set.rules), MAX_RULES, "rules"),
        (elements, MAX_ELEMENTS, "preconditions, behaviours and actions"),
    ):
        if number > most:
            message = f"expected at most {most} {what} in all, got {number}"
            raise RuleSetError([Finding(Place(source), message)])


def is_finite(number: float) -> bool:
    """Whether a float can hold a number, which may be a whole one of any size."""
    return abs(number) <= sys.float_info.max
