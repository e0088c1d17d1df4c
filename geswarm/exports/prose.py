"""Rule sets to read: as English sentences and as a Markdown table."""

from __future__ import annotations

import re
from collections.abc import Iterator

from geswarm.rules.english import describe
from geswarm.rules.model import Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>()#+!|&~$^=.-])")


def format_english(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """One sentence for every rule, numbered, after the name and the comment."""
    heading = [line for line in (rule_set.name, rule_set.comment) if line]
    described = describe(rule_set, vocabulary)
    sentences = (f"R{at}. {text}" for at, text in enumerate(described, start=1))
    return "\n".join([*heading, *([""] if heading else []), *sentences]) + "\n"


def format_markdown(rule_set: RuleSet) -> str:
    """A table with a row for every rule, its explanation in the last column."""
    return "\n".join(_markdown_lines(rule_set)) + "\n"


def _markdown_lines(rule_set: RuleSet) -> Iterator[str]:
    if rule_set.name:
        yield f"### {_escaped(rule_set.name)}\n"
    if rule_set.comment:
        yield f"{_escaped(rule_set.comment)}\n"
    yield "| | Preconditions | Behaviours | Actions | Comment |"
    yield "| --- | --- | --- | --- | --- |"
    for number, rule in enumerate(rule_set.rules, start=1):
        yield f"| {' | '.join(_cells(number, rule))} |"


def _cells(number: int, rule: Rule) -> tuple[str, ...]:
    return (
        f"R{number}" + ("" if rule.enabled else " (off)"),
        _codes(map(str, rule.preconditions)),
        _codes(map(str, rule.behaviours)),
        _codes(map(str, rule.actions)),
        _escaped(rule.comment),
    )


def _codes(elements: Iterator[str]) -> str:
    """Elements as code, one under the other; they hold no backtick and no bar."""
    return "<br>".join(f"`{element}`" for element in elements) or "ε"


def _escaped(text: str) -> str:
    """Free text that Markdown shows as it is."""
    return _SPECIAL.sub(r"\\\1", text).replace("\n", "<br>")
