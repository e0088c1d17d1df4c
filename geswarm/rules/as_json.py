"""Rule sets as plain JSON values, for the rule table page and for other programs.

{"name", "comment", "origin": {"preset", "run", "generation", "fitness"},
 "rules": [{"comment", "enabled", "preconditions": [{"name", "holds"}], "behaviours": [name],
            "actions": [{"p", "behaviour"} or {"p", "state", "value"}]}]}
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, TypeAlias

from geswarm.rules.model import Action, BehaviourChange, Precondition, Rule, RuleSet, StateChange

Json: TypeAlias = Any


class JsonError(ValueError):
    """A JSON value is not the part of a rule set that was expected."""


def rule_set_to_json(rule_set: RuleSet) -> dict[str, Json]:
    """The whole rule set."""
    return asdict(rule_set)


def rule_from_json(value: Json) -> Rule:
    """Read one rule.

    Raises:
        JsonError: The value has another shape.
    """
    if not isinstance(value, dict):
        raise JsonError(f"expected a rule, got {value!r}")
    return Rule(
        preconditions=tuple(map(precondition_from_json, _list(value, "preconditions"))),
        behaviours=tuple(map(behaviour_from_json, _list(value, "behaviours"))),
        actions=tuple(map(action_from_json, _list(value, "actions"))),
        comment=_field(value, "comment", str, ""),
        enabled=_field(value, "enabled", bool, True),
    )


def precondition_from_json(value: Json) -> Precondition:
    """Read {"name", "holds"}.

    Raises:
        JsonError: The value has another shape.
    """
    if not isinstance(value, dict):
        raise JsonError(f"expected a precondition, got {value!r}")
    return Precondition(_field(value, "name", str), _field(value, "holds", bool))


def behaviour_from_json(value: Json) -> str:
    """Read a behaviour name.

    Raises:
        JsonError: The value is not text.
    """
    if not isinstance(value, str):
        raise JsonError(f"expected the name of a behaviour, got {value!r}")
    return value


def action_from_json(value: Json) -> Action:
    """Read {"p", "behaviour"} or {"p", "state", "value"}.

    Raises:
        JsonError: The value has another shape.
    """
    if not isinstance(value, dict):
        raise JsonError(f"expected an action, got {value!r}")
    p = _field(value, "p", (int, float))
    if "behaviour" in value:
        return BehaviourChange(float(p), _field(value, "behaviour", str))
    return StateChange(float(p), _field(value, "state", str), _field(value, "value", bool))


def _list(value: dict[str, Json], key: str) -> list[Json]:
    items = value.get(key, [])
    if not isinstance(items, (list, tuple)):
        raise JsonError(f"{key}: expected a list, got {items!r}")
    return list(items)


def _field(
    value: dict[str, Json], key: str, kind: type | tuple[type, ...], default: Json = None
) -> Json:
    found = value.get(key, default)
    if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
        raise JsonError(f"{key}: got {found!r}")
    return found
