"""A rule set as YAML: pleasant to read, to diff and to change by hand.

schema: 1
name: EVO 8
origin: {preset: evo8}
rules:
- comment: The switch to random walk is probabilistic
  while: [PHOTOTAXIS]
  do:
  - p = 0.05, RANDOM_WALK
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import yaml

from geswarm.rules.elements import (
    ElementError,
    parse_action,
    parse_behaviour,
    parse_precondition,
)
from geswarm.rules.findings import Finding, Place, RuleSetError, shown, unknown_name
from geswarm.rules.limits import is_finite
from geswarm.rules.model import Origin, Rule, RuleSet
from geswarm.rules.plain_yaml import YamlError, compose, value_of
from geswarm.rules.vocabulary import FORAGING, Vocabulary

SCHEMA = 1

_TOP_KEYS = ("schema", "name", "scenario", "comment", "origin", "rules")
_RULE_KEYS = ("comment", "enabled", "if", "while", "do")
_ORIGIN_KEYS: dict[str, type | tuple[type, ...]] = {
    "preset": str,
    "run": str,
    "generation": int,
    "fitness": (int, float),
}
T = TypeVar("T")


def format_yaml(rule_set: RuleSet) -> str:
    """Write a rule set as YAML; `parse_yaml` reads back exactly the same value."""
    document: dict[str, Any] = {"schema": SCHEMA, "name": rule_set.name}
    if rule_set.scenario:
        document["scenario"] = rule_set.scenario
    if rule_set.comment:
        document["comment"] = _Prose(rule_set.comment)
    origin = {key: value for key, value in vars(rule_set.origin).items() if value is not None}
    if origin:
        document["origin"] = _InLine(origin)
    document["rules"] = [_rule_document(rule) for rule in rule_set.rules]
    return yaml.dump(document, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=100)


def _rule_document(rule: Rule) -> dict[str, Any]:
    document: dict[str, Any] = {}
    if rule.comment:
        document["comment"] = _Prose(rule.comment)
    if not rule.enabled:
        document["enabled"] = False
    if rule.preconditions:
        document["if"] = _InRow(map(str, rule.preconditions))
    if rule.behaviours:
        document["while"] = _InRow(map(str, rule.behaviours))
    document["do"] = [str(action) for action in rule.actions]
    return document


class _InLine(dict[str, Any]):
    """A mapping written on one line."""


class _InRow(list[str]):
    """A list written on one line."""


class _Prose(str):
    """Text that is written as a block when it has several lines."""


class _Dumper(yaml.SafeDumper):
    """SafeDumper that knows the three layouts above and never writes aliases."""

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002 (name fixed by PyYAML)
        return True


_Dumper.add_representer(
    _InLine,
    lambda dumper, data: dumper.represent_mapping("tag:yaml.org,2002:map", data, flow_style=True),
)
_Dumper.add_representer(
    _InRow,
    lambda dumper, data: dumper.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=True),
)
_Dumper.add_representer(
    _Prose,
    lambda dumper, data: dumper.represent_scalar(
        "tag:yaml.org,2002:str", str(data), style="|" if "\n" in data else None
    ),
)


def parse_yaml(text: str, source: str = "", vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """Read a rule set from YAML.

    Raises:
        RuleSetError: With every problem, each with file, line, rule and element.
    """
    reader = _Reader(source, vocabulary)
    rule_set = reader.read(text)
    if reader.findings or rule_set is None:
        raise RuleSetError(reader.findings, rule_set.scenario if rule_set else "")
    return rule_set


class _Reader:
    """Walks the node tree, which knows its lines, and collects problems."""

    def __init__(self, source: str, vocabulary: Vocabulary) -> None:
        self.source = source
        self.vocabulary = vocabulary
        self.findings: list[Finding] = []
        self.rule: int | None = None

    def report(self, node: yaml.Node | None, message: str, element: str = "") -> None:
        line = node.start_mark.line + 1 if node else 1
        self.findings.append(Finding(Place(self.source, line, self.rule, element), message))

    def read(self, text: str) -> RuleSet | None:
        try:
            root = compose(text)
        except YamlError as error:
            self.findings.append(Finding(Place(self.source, error.line), str(error)))
            return None
        parts = self.mapping(root, "a rule set", _TOP_KEYS)
        if parts is None:
            return None
        schema = self.scalar(parts.get("schema"), int, "schema")
        if schema not in (SCHEMA, None):
            self.report(parts["schema"], f"expected schema {SCHEMA}, got {schema}", "schema")
        if "rules" not in parts:
            self.report(root, "expected rules: with a list of rules")
        rules = []
        for number, node in enumerate(self.sequence(parts.get("rules"), "rules"), start=1):
            self.rule = number
            rules.append(self.read_rule(node))
        self.rule = None
        return RuleSet(
            rules=tuple(rules),
            name=self.scalar(parts.get("name"), str, "name") or "",
            comment=self.scalar(parts.get("comment"), str, "comment") or "",
            origin=self.read_origin(parts.get("origin")),
            scenario=self.scalar(parts.get("scenario"), str, "scenario") or "",
        )

    def read_origin(self, node: yaml.Node | None) -> Origin:
        parts = self.mapping(node, "origin", tuple(_ORIGIN_KEYS)) if node else None
        values = {
            key: self.scalar(value, _ORIGIN_KEYS[key], f"origin {key}")
            for key, value in (parts or {}).items()
        }
        return Origin(**values)

    def read_rule(self, node: yaml.Node) -> Rule:
        parts = self.mapping(node, "a rule", _RULE_KEYS) or {}
        enabled = self.scalar(parts.get("enabled"), bool, "enabled")
        return Rule(
            preconditions=self.elements(parts.get("if"), "precondition", parse_precondition),
            behaviours=self.elements(parts.get("while"), "behaviour", parse_behaviour),
            actions=self.elements(parts.get("do"), "action", parse_action),
            comment=self.scalar(parts.get("comment"), str, "comment") or "",
            enabled=True if enabled is None else enabled,
        )

    def elements(
        self, node: yaml.Node | None, kind: str, parse: Callable[[str, Vocabulary], T]
    ) -> tuple[T, ...]:
        """A list of elements in the paper's notation; a single one may stand without the list."""
        nodes = [node] if isinstance(node, yaml.ScalarNode) else self.sequence(node, f"{kind}s")
        parsed = []
        for number, item in enumerate(nodes, start=1):
            if not isinstance(item, yaml.ScalarNode):
                self.report(item, "expected plain text", f"{kind} {number}")
                continue
            try:
                parsed.append(parse(item.value, self.vocabulary))
            except ElementError as error:
                self.report(item, str(error), f"{kind} {number}")
        return tuple(parsed)

    def mapping(
        self, node: yaml.Node | None, what: str, known: Sequence[str]
    ) -> dict[str, yaml.Node] | None:
        if not isinstance(node, yaml.MappingNode):
            self.report(node, f"expected {what} with the keys {', '.join(known)}")
            return None
        parts: dict[str, yaml.Node] = {}
        for key, value in node.value:
            name = key.value
            if not isinstance(name, str):
                self.report(key, "expected text as key")
            elif name not in known:
                self.report(key, unknown_name("key", name, known))
            elif name in parts:
                self.report(key, f"{name} is given twice")
            else:
                parts[name] = value
        null = "tag:yaml.org,2002:null"
        return {name: value for name, value in parts.items() if value.tag != null}

    def sequence(self, node: yaml.Node | None, what: str) -> list[yaml.Node]:
        if isinstance(node, yaml.SequenceNode):
            return list(node.value)
        if node is not None:
            self.report(node, f"expected a list of {what}")
        return []

    def scalar(self, node: yaml.Node | None, kind: type | tuple[type, ...], what: str) -> Any:
        """The value of a scalar node of the given type; None if absent or wrong (reported)."""
        if node is None:
            return None
        if kind is str and isinstance(node, yaml.ScalarNode):
            return node.value  # any scalar may serve as text: a name such as 8 or yes
        value = None
        if isinstance(node, yaml.ScalarNode):
            try:
                value = value_of(node)
            except YamlError:
                value = None
        if (
            not isinstance(value, kind)
            or (isinstance(value, bool) and kind is not bool)
            or (isinstance(value, int | float) and not is_finite(value))
        ):
            wanted = {str: "text", bool: "true or false", int: "a whole number"}
            expected = wanted.get(kind, "a number") if isinstance(kind, type) else "a number"
            given = node.value if isinstance(node, yaml.ScalarNode) else "a list or mapping"
            self.report(node, f"expected {expected}, got {shown(given)}", what)
            return None
        return value
