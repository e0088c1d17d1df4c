"""Preconditions, behaviours and actions as the paper writes them, one element at a time.

The text and the YAML form of a rule set share this notation: `ON_NEST == true`, `RANDOM_WALK`,
`p = 0.05, RANDOM_WALK`, `p = 1, DROP_OBJECT = true` (productions 7, 8, 10 and 11).
"""

from __future__ import annotations

import re

from geswarm.rules.findings import shown
from geswarm.rules.model import Action, BehaviourChange, Precondition, StateChange
from geswarm.rules.names import probability_error, unknown_name
from geswarm.rules.vocabulary import Vocabulary

_NAME = r"[A-Za-z_][A-Za-z0-9_-]*"
_PRECONDITION = re.compile(rf"(?P<name>{_NAME})\s*==\s*(?P<value>\w+)")
_ACTION = re.compile(
    rf"p\s*=\s*(?P<p>[^\s,]+)\s*,\s*(?P<name>{_NAME})(\s*=\s*(?P<value>\w+))?", re.IGNORECASE
)
_BOOLEANS = {"true": True, "false": False}


class ElementError(ValueError):
    """One element is not understood; the message says what was expected."""


def format_precondition(precondition: Precondition) -> str:
    """`ON_NEST == true`."""
    return f"{precondition.name} == {format_boolean(precondition.holds)}"


def format_action(action: Action) -> str:
    """`p = 0.05, RANDOM_WALK` or `p = 1, DROP_OBJECT = true`."""
    probability = f"p = {format_probability(action.p)}"
    if isinstance(action, BehaviourChange):
        return f"{probability}, {action.behaviour}"
    return f"{probability}, {action.state} = {format_boolean(action.value)}"


def format_probability(p: float) -> str:
    """The shortest text that reads back as exactly p."""
    return repr(float(p)).removesuffix(".0")


def format_boolean(value: bool) -> str:
    """`true` or `false`."""
    return "true" if value else "false"


def parse_precondition(text: str, vocabulary: Vocabulary) -> Precondition:
    """Read `NAME == true|false`.

    Raises:
        ElementError: It is not of that form or the name is unknown.
    """
    match = _PRECONDITION.fullmatch(text.strip())
    if match is None:
        raise ElementError(f"expected NAME == true or NAME == false, got {shown(text.strip())}")
    known = vocabulary.precondition_index
    if match["name"] not in known:
        raise ElementError(unknown_name("precondition", match["name"], known))
    return Precondition(match["name"], _boolean(match["value"]))


def parse_behaviour(text: str, vocabulary: Vocabulary) -> str:
    """Read a behaviour name.

    Raises:
        ElementError: The name is unknown.
    """
    name = text.strip()
    if name not in vocabulary.behaviour_index:
        raise ElementError(unknown_name("behaviour", name, vocabulary.behaviour_index))
    return name


def parse_action(text: str, vocabulary: Vocabulary) -> Action:
    """Read `p = P, BEHAVIOUR` or `p = P, STATE = true|false`.

    Raises:
        ElementError: It is not of that form, a name is unknown or P is outside [0, 1].
    """
    match = _ACTION.fullmatch(text.strip())
    if match is None:
        raise ElementError(
            f"expected p = NUMBER, BEHAVIOUR or p = NUMBER, STATE = true, got {shown(text.strip())}"
        )
    p = _probability(match["p"])
    name, value = match["name"], match["value"]
    behaviours, states = vocabulary.behaviour_index, vocabulary.state_index
    if value is None:
        if name in states:
            raise ElementError(f"{name} is an internal state: write {name} = true or = false")
        if name not in behaviours:
            raise ElementError(unknown_name("behaviour", name, behaviours))
        return BehaviourChange(p, name)
    if name in behaviours:
        raise ElementError(f"{name} is a behaviour: write it without = {value}")
    if name not in states:
        raise ElementError(unknown_name("internal state", name, states))
    return StateChange(p, name, _boolean(value))


def _boolean(text: str) -> bool:
    try:
        return _BOOLEANS[text.lower()]
    except KeyError:
        raise ElementError(f"expected true or false, got {shown(text)}") from None


def _probability(text: str) -> float:
    try:
        p = float(text)
    except ValueError:
        message = f"probability must be a number between 0 and 1, got {shown(text)}"
        raise ElementError(message) from None
    if reason := probability_error(p):
        raise ElementError(reason)
    return p
