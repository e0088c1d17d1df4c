"""Rule sets as plain JSON values, for the rule table page and for other programs.

{"name", "scenario", "comment", "origin": {"preset", "run", "generation", "fitness"},
 "rules": [{"comment", "enabled", "preconditions": [{"percept": TERM, "comparison", "value"}],
            "behaviours": [TERM],
            "actions": [{"p", "behaviour": TERM} or {"p", "state", "operation", "value"}]}]}

TERM is {"name", "arguments"}. A file has `"schema": 2` beside these, and exports add what follows
from the rules, which is not read. Files of schema 1 are read, too: it had no arguments, so a term
was its name, and a precondition {"name", "holds"}. `geswarm/exports/rule-set.schema.json` is the
JSON Schema of files.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any, TypeAlias, TypeVar

from geswarm.plain_text import tidy
from geswarm.rules.findings import Finding, Place, RuleSetError, shown, unknown_name
from geswarm.rules.limits import is_finite
from geswarm.rules.model import (
    Action,
    BehaviourChange,
    Origin,
    Precondition,
    Rule,
    RuleSet,
    StateChange,
    Term,
    Value,
)
from geswarm.rules.names import name_errors, probability_error
from geswarm.rules.vocabulary import FORAGING, Vocabulary

SCHEMA = 2

_TOP_KEYS = ("schema", "name", "scenario", "comment", "origin", "rules", "state_machine")
_RULE_KEYS = ("comment", "enabled", "preconditions", "behaviours", "actions")
_ORIGIN_KEYS: dict[str, type | tuple[type, ...]] = {
    "preset": str,
    "run": str,
    "generation": int,
    "fitness": (int, float),
}
_EXPECTED: dict[type | tuple[type, ...], str] = {
    str: "text",
    bool: "true or false",
    int: "a whole number",
    (int, float): "a number",
}

Json: TypeAlias = Any
T = TypeVar("T")


class JsonError(ValueError):
    """A JSON value is not the part of a rule set that was expected."""


class _Object(dict[str, Json]):
    """An object of a JSON text, which knows the keys that it had more than once."""

    def __init__(self, pairs: Sequence[tuple[str, Json]]) -> None:
        super().__init__(pairs)
        counts = Counter(key for key, _ in pairs)
        self.repeated = [key for key, count in counts.items() if count > 1]


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
        document = json.loads(tidy(text), object_pairs_hook=_Object)
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
        raise RuleSetError(findings, rule_set.scenario)
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
        self.keys(document, _TOP_KEYS)
        schema = document.get("schema", SCHEMA)
        if schema not in (1, SCHEMA) or isinstance(schema, bool):
            self.report(JsonError(f"expected schema {SCHEMA}, got {shown(schema)}"))
        if "rules" not in document:
            self.report(JsonError('expected "rules" with a list of rules'))
        rules = self.part(list[Json](), lambda: _list(document, "rules"))
        return RuleSet(
            rules=tuple(self.rule(number, rule) for number, rule in enumerate(rules, start=1)),
            name=self.part("", lambda: _field(document, "name", str, "")),
            comment=self.part("", lambda: _field(document, "comment", str, "")),
            origin=self.part(Origin(), lambda: _origin(document.get("origin", {}))),
            scenario=self.part("", lambda: _field(document, "scenario", str, "")),
        )

    def rule(self, number: int, value: Json) -> Rule:
        if not isinstance(value, dict):
            return self.part(Rule(), lambda: rule_from_json(value), number)
        self.keys(value, _RULE_KEYS, number)

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

    def keys(self, value: dict[str, Json], known: Sequence[str], rule: int | None = None) -> None:
        for reason in _wrong_keys(value, known):
            self.report(JsonError(reason), rule)

    def part(self, fallback: T, read: Callable[[], T], rule: int | None = None) -> T:
        try:
            return read()
        except JsonError as error:
            self.report(error, rule)
            return fallback

    def report(self, error: JsonError, rule: int | None = None, element: str = "") -> None:
        self.findings.append(Finding(Place(self.source, None, rule, element), str(error)))


def _origin(value: Json) -> Origin:
    _require_keys(value, "an object", tuple(_ORIGIN_KEYS), "origin: ")
    given = [key for key in _ORIGIN_KEYS if value.get(key) is not None]
    parts = {key: _field(value, key, _ORIGIN_KEYS[key]) for key in given}
    for key in ("generation", "fitness"):
        if not is_finite(parts.get(key, 0)):
            raise JsonError(f"{key}: expected a finite number, got {shown(parts[key])}")
    return Origin(**parts)


def rule_from_json(value: Json) -> Rule:
    """Read one rule.

    Raises:
        JsonError: The value has another shape.
    """
    _require_keys(value, "a rule", _RULE_KEYS)
    return Rule(
        preconditions=tuple(map(precondition_from_json, _list(value, "preconditions"))),
        behaviours=tuple(map(behaviour_from_json, _list(value, "behaviours"))),
        actions=tuple(map(action_from_json, _list(value, "actions"))),
        comment=_field(value, "comment", str, ""),
        enabled=_field(value, "enabled", bool, True),
    )


def precondition_from_json(value: Json) -> Precondition:
    """Read {"percept", "comparison", "value"}, or {"name", "holds"} of schema 1.

    Raises:
        JsonError: The value has another shape.
    """
    if isinstance(value, dict) and "percept" not in value and "name" in value:
        _require_keys(value, "a precondition", ("name", "holds"))
        return Precondition(Term(_field(value, "name", str)), _field(value, "holds", bool))
    _require_keys(value, "a precondition", ("percept", "comparison", "value"))
    percept = term_from_json(value.get("percept"), "percept: expected a term")
    return Precondition(percept, _value(value, "value"), _field(value, "comparison", str, "=="))


def term_from_json(value: Json, expected: str = "expected a term") -> Term:
    """Read {"name", "arguments"}, or a name alone.

    Raises:
        JsonError: The value has another shape.
    """
    if isinstance(value, str):
        return Term(value)
    if not isinstance(value, dict):
        raise JsonError(f"{expected}, got {shown(value)}")
    _require_keys(value, "a term", ("name", "arguments"))
    arguments = [_value({"argument": each}, "argument") for each in _list(value, "arguments")]
    return Term(_field(value, "name", str), tuple(arguments))


def behaviour_from_json(value: Json) -> Term:
    """Read a behaviour: a term.

    Raises:
        JsonError: The value has another shape.
    """
    return term_from_json(value, "expected a behaviour")


def action_from_json(value: Json) -> Action:
    """Read {"p", "behaviour"} or {"p", "state", "operation", "value"}.

    Raises:
        JsonError: The value has another shape, or p is no finite number.
    """
    _require_keys(value, "an action", ("p", "behaviour", "state", "operation", "value"))
    if "behaviour" in value and len(value) > 2:
        raise JsonError("expected either behaviour, or state and value, got both")
    p = _field(value, "p", (int, float))
    if not is_finite(p):
        raise JsonError(probability_error(p))
    if "behaviour" in value:
        return BehaviourChange(float(p), behaviour_from_json(value["behaviour"]))
    operation = _field(value, "operation", str, "=")
    return StateChange(float(p), _field(value, "state", str), _value(value, "value"), operation)


def _require_keys(value: Json, what: str, known: Sequence[str], where: str = "") -> None:
    if not isinstance(value, dict):
        raise JsonError(f"{where}expected {what}, got {shown(value)}")
    if reasons := _wrong_keys(value, known):
        raise JsonError(where + "; ".join(reasons))


def _wrong_keys(value: dict[str, Json], known: Sequence[str]) -> list[str]:
    """What is wrong with the keys of an object."""
    unknown = [unknown_name("key", key, known) for key in value if key not in known]
    repeated = value.repeated if isinstance(value, _Object) else []
    return unknown + [f"{shown(key)} is given twice" for key in repeated]


def _list(value: dict[str, Json], key: str) -> list[Json]:
    items = value.get(key, [])
    if not isinstance(items, (list, tuple)):
        raise JsonError(f"{key}: expected a list, got {shown(items)}")
    return list(items)


def _value(value: dict[str, Json], key: str) -> Value:
    found: Value | None = value.get(key)
    if isinstance(found, bool | str) or (isinstance(found, int | float) and is_finite(found)):
        return found
    given = shown(found) if key in value else "nothing"
    raise JsonError(f"{key}: expected a truth, a number or a name, got {given}")


def _field(
    value: dict[str, Json], key: str, kind: type | tuple[type, ...], default: Json = None
) -> Json:
    found = value.get(key, default)
    if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
        given = shown(found) if key in value else "nothing"
        raise JsonError(f"{key}: expected {_EXPECTED[kind]}, got {given}")
    return found
