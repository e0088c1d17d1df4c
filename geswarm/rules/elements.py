"""Preconditions, behaviours and actions as the paper writes them, one element at a time.

The text and the YAML form of a rule set share this notation: `ON_NEST == true`,
`IS_CLOSE_TO(3) == true`, `NEIGHBOURS >= 3`, `RANDOM_WALK`, `ATTRACTION(2.5)`,
`p = 0.05, RANDOM_WALK`, `p = 1, DROP_OBJECT = true`, `p = 0.1, HUNGER += 1` (productions 7, 8, 10
and 11). `str` of an element writes it.
"""

from __future__ import annotations

import re
from functools import lru_cache

from geswarm.rules.findings import shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import (
    Action,
    BehaviourChange,
    Precondition,
    StateChange,
    Term,
    Value,
    format_value,
)
from geswarm.rules.names import probability_error
from geswarm.rules.vocabulary import Vocabulary

_NAME = r"[A-Za-z_](?:[A-Za-z0-9_-]*[A-Za-z0-9_])?"
_TERM = rf"(?P<name>{_NAME})\s*(?:\((?P<arguments>[^()]*)\))?"
_PLAIN_TERM = re.compile(_TERM)
_PRECONDITION = re.compile(rf"{_TERM}\s*(?P<sign>==|!=|>=|<=|>|<)\s*(?P<value>[\w.+-]+)")
_ACTION = re.compile(r"p\s*=\s*(?P<p>[^\s,]+)\s*,\s*(?P<deed>.+)", re.IGNORECASE)
_CHANGE = re.compile(rf"(?P<name>{_NAME})\s*(?P<sign>\+=|-=|=)\s*(?P<value>[\w.+-]+)")
_WHOLE = re.compile(r"[+-]?[0-9]{1,15}")


class ElementError(ValueError):
    """One element is not understood; the message says what was expected."""


def format_probability(p: float) -> str:
    """The shortest text that reads back as exactly p."""
    return format_value(float(p))


@lru_cache(maxsize=4096)  # evolution reads the same ones again and again
def parse_precondition(text: str, vocabulary: Vocabulary) -> Precondition:
    """Read `NAME == true`, `NAME(ARGUMENT) == false` or `NAME >= NUMBER`.

    Raises:
        ElementError: It is not of that form, or not in the vocabulary.
    """
    match = _PRECONDITION.fullmatch(text.strip())
    if match is None:
        expected = "NAME == true or NAME == false"
        if any(not isinstance(vocabulary.values_of(name)[0], bool) for name in vocabulary.percepts):
            expected += ", or NAME >= NUMBER"
        raise ElementError(f"expected {expected}, got {shown(text.strip())}")
    precondition = Precondition(_term(match), _value(match["value"]), match["sign"])
    _require(vocabulary.precondition_error(precondition))
    return precondition


@lru_cache(maxsize=4096)
def parse_behaviour(text: str, vocabulary: Vocabulary) -> Term:
    """Read a behaviour: `NAME` or `NAME(ARGUMENT, ...)`.

    Raises:
        ElementError: It is not in the vocabulary.
    """
    match = _PLAIN_TERM.fullmatch(text.strip())
    behaviour = _term(match) if match else Term(text.strip())
    _require(vocabulary.behaviour_error(behaviour))
    return behaviour


@lru_cache(maxsize=4096)
def parse_action(text: str, vocabulary: Vocabulary) -> Action:
    """Read `p = P, BEHAVIOUR` or `p = P, STATE = VALUE`, `+=` and `-=` for counters.

    Raises:
        ElementError: It is not of that form, not in the vocabulary, or P is outside [0, 1].
    """
    match = _ACTION.fullmatch(text.strip())
    if match is None:
        raise ElementError(
            f"expected p = NUMBER, BEHAVIOUR or p = NUMBER, STATE = true, got {shown(text.strip())}"
        )
    p, deed = _probability(match["p"]), match["deed"].strip()
    change = _CHANGE.fullmatch(deed)
    behaviours, states = vocabulary.behaviour_names, vocabulary.state_names
    if change is None:
        if deed in states:
            values = " or = ".join(map(format_value, states[deed].values[::-1]))
            raise ElementError(f"{deed} is an internal state: write {deed} = {values}")
        if _PLAIN_TERM.fullmatch(deed) is None:
            given = shown(text.strip())
            expected = "p = NUMBER, BEHAVIOUR or p = NUMBER, STATE = true"
            raise ElementError(f"expected {expected}, got {given}")
        return BehaviourChange(p, parse_behaviour(deed, vocabulary))
    name, sign = change["name"], change["sign"]
    if name in behaviours:
        raise ElementError(f"{name} is a behaviour: write it without {sign} {change['value']}")
    action = StateChange(p, name, _value(change["value"]), sign)
    _require(vocabulary.change_error(action))
    return action


def _require(problem: str | None) -> None:
    if problem:
        raise ElementError(problem)


def _term(match: re.Match[str]) -> Term:
    inside = match["arguments"]
    if inside is None or not inside.strip():
        return Term(match["name"])
    return Term(match["name"], tuple(_value(part.strip()) for part in inside.split(",")))


def _value(text: str) -> Value:
    """A truth, a number or a name."""
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    if _WHOLE.fullmatch(text):
        return int(text)
    try:
        number = float(text)
    except ValueError:
        return text
    return number if is_finite(number) else text


def _probability(text: str) -> float:
    try:
        p = float(text)
    except ValueError:
        message = f"probability must be a number between 0 and 1, got {shown(text)}"
        raise ElementError(message) from None
    if reason := probability_error(p):
        raise ElementError(reason)
    return p
