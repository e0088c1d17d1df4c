"""Rule sets as plain JSON values, for the rule table page and for other programs.

{"name", "comment", "origin": {"preset", "run", "generation", "fitness"},
 "rules": [{"comment", "enabled", "preconditions": [{"name", "holds"}], "behaviours": [name],
            "actions": [{"p", "behaviour"} or {"p", "state", "value"}]}]}

A file has `"schema": 1` beside these; whatever else it has is not read. The JSON Schema of files is
`geswarm/exports/rule-set.schema.json`.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from typing import Any, TypeAlias, TypeVar

from geswarm.rules.findings import Finding, Place, RuleSetError, shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import (
    Action,
    BehaviourChange,
    Origin,
    Precondition,
    Rule,
    RuleSet,
    StateChange,
)
from geswarm.rules.names import name_errors, probability_error
from geswarm.rules.vocabulary import FORAGING, Vocabulary

SCHEMA = 1

Json: TypeAlias = Any
T = TypeVar("T")


class JsonError(ValueError):
    """A JSON value is not the part of a rule set that was expected."""


def rule_set_to_json(rule_set: RuleSet) -> dict[str, Json]:
    """The whole rule set."""
    return asdict(rule_set)


def format_json(rule_set: RuleSet) -> str:
    """Write a rule set as a JSON file; `parse_json` reads back exactly the same value."""
    document = {"schema": SCHEMA, **rule_set_to_json(rule_set)}
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


def parse_json(text: str, source: str = "", vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """Read a rule set from JSON.

    Raises:
        RuleSetError: With every problem, each with file, rule and element.
    """
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        reason = f"not valid JSON: {error.msg} at column {error.colno}"
        raise RuleSetError([Finding(Place(source, error.lineno), reason)]) from error
    except (RecursionError, ValueError) as error:
        reason = "not valid JSON: it is nested too deeply or a number is too long"
        raise RuleSetError([Finding(Place(source), reason)]) from error
    reader = _Reader(source)
    rule_set = reader.read(document)
    findings = reader.findings or [
        Finding(Place(source, None, finding.place.rule, finding.place.element), finding.message)
        for finding in name_errors(rule_set, vocabulary)
    ]
    if findings:
        raise RuleSetError(findings)
    return rule_set


class _Reader:
    """Reads part by part and collects problems instead of stopping at the first."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.findings: list[Finding] = []

    def read(self, document: Json) -> RuleSet:
        if not isinstance(document, dict):
            self.report(JsonError(f"expected a rule set, got {shown(document)}"))
            return RuleSet()
        if document.get("schema", SCHEMA) != SCHEMA:
            self.report(JsonError(f"expected schema {SCHEMA}, got {shown(document['schema'])}"))
        if "rules" not in document:
            self.report(JsonError('expected "rules" with a list of rules'))
        rules = self.part(list[Json](), lambda: _list(document, "rules"))
        return RuleSet(
            rules=tuple(self.rule(number, rule) for number, rule in enumerate(rules, start=1)),
            name=self.part("", lambda: _field(document, "name", str, "")),
            comment=self.part("", lambda: _field(document, "comment", str, "")),
            origin=self.part(Origin(), lambda: _origin(document.get("origin") or {})),
        )

    def rule(self, number: int, value: Json) -> Rule:
        if not isinstance(value, dict):
            return self.part(Rule(), lambda: rule_from_json(value), number)

        def elements(key: str, read: Callable[[Json], T]) -> tuple[T, ...]:
            items = self.part(list[Json](), lambda: _list(value, key), number)
            found = []
            for at, item in enumerate(items, start=1):
                try:
                    found.append(read(item))
                except JsonError as error:
                    self.report(error, number, f"{key[:-1]} {at}")
            return tuple(found)

        return Rule(
            preconditions=elements("preconditions", precondition_from_json),
            behaviours=elements("behaviours", behaviour_from_json),
            actions=elements("actions", action_from_json),
            comment=self.part("", lambda: _field(value, "comment", str, ""), number),
            enabled=self.part(True, lambda: _field(value, "enabled", bool, True), number),
        )

    def part(self, fallback: T, read: Callable[[], T], rule: int | None = None) -> T:
        try:
            return read()
        except JsonError as error:
            self.report(error, rule)
            return fallback

    def report(self, error: JsonError, rule: int | None = None, element: str = "") -> None:
        self.findings.append(Finding(Place(self.source, None, rule, element), str(error)))


def _origin(value: Json) -> Origin:
    if not isinstance(value, dict):
        raise JsonError(f"origin: expected an object, got {shown(value)}")
    known: dict[str, type | tuple[type, ...]] = {
        "preset": str,
        "run": str,
        "generation": int,
        "fitness": (int, float),
    }
    parts = {key: _field(value, key, known[key]) for key in known if value.get(key) is not None}
    for key in ("generation", "fitness"):
        if not is_finite(parts.get(key, 0)):
            raise JsonError(f"{key}: expected a finite number, got {shown(parts[key])}")
    return Origin(**parts)


def rule_from_json(value: Json) -> Rule:
    """Read one rule.

    Raises:
        JsonError: The value has another shape.
    """
    if not isinstance(value, dict):
        raise JsonError(f"expected a rule, got {shown(value)}")
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
        raise JsonError(f"expected a precondition, got {shown(value)}")
    return Precondition(_field(value, "name", str), _field(value, "holds", bool))


def behaviour_from_json(value: Json) -> str:
    """Read a behaviour name.

    Raises:
        JsonError: The value is not text.
    """
    if not isinstance(value, str):
        raise JsonError(f"expected the name of a behaviour, got {shown(value)}")
    return value


def action_from_json(value: Json) -> Action:
    """Read {"p", "behaviour"} or {"p", "state", "value"}.

    Raises:
        JsonError: The value has another shape, or p is no finite number.
    """
    if not isinstance(value, dict):
        raise JsonError(f"expected an action, got {shown(value)}")
    p = _field(value, "p", (int, float))
    if not is_finite(p):
        raise JsonError(probability_error(p))
    if "behaviour" in value:
        return BehaviourChange(float(p), _field(value, "behaviour", str))
    return StateChange(float(p), _field(value, "state", str), _field(value, "value", bool))


def _list(value: dict[str, Json], key: str) -> list[Json]:
    items = value.get(key, [])
    if not isinstance(items, (list, tuple)):
        raise JsonError(f"{key}: expected a list, got {shown(items)}")
    return list(items)


def _field(
    value: dict[str, Json], key: str, kind: type | tuple[type, ...], default: Json = None
) -> Json:
    found = value.get(key, default)
    if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
        raise JsonError(f"{key}: got {shown(found)}")
    return found
