"""A rule set as an HTML table in the form of the paper's tables, for notebooks and pages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from geswarm.rules.model import Rule, RuleSet

_CELL = "text-align:left;vertical-align:top;padding:1px 10px 1px 0;background:none"
_HEAD = f"{_CELL};border-top:1px solid #9aa5b1;padding-top:6px"


def format_html(rule_set: RuleSet) -> str:
    """A fragment without scripts; every text is escaped."""
    return "\n".join(_lines(rule_set))


def _lines(rule_set: RuleSet) -> Iterator[str]:
    yield '<table class="geswarm-rules" style="border-collapse:collapse">'
    title = " — ".join(part for part in (rule_set.name, rule_set.comment) if part)
    if title:
        yield f'<caption style="text-align:left;font-weight:bold">{escape(title)}</caption>'
    for number, rule in enumerate(rule_set.rules, start=1):
        yield from _rule(number, rule)
    yield "</table>"


def _rule(number: int, rule: Rule) -> Iterator[str]:
    faded = "" if rule.enabled else ' style="opacity:0.5"'
    off = "" if rule.enabled else "(off) "
    yield f"<tbody{faded}>"
    yield _row(f"R{number}", [off + rule.comment], _HEAD)
    yield _row("P", list(map(str, rule.preconditions)) or ["ε"], _CELL)
    yield _row("B", list(map(str, rule.behaviours)) or ["ε"], _CELL)
    yield _row("A", list(map(str, rule.actions)) or ["ε"], _CELL)
    yield "</tbody>"


def _row(heading: str, elements: Sequence[str], style: str) -> str:
    shown = "<br>".join(escape(element).replace("\n", "<br>") for element in elements)
    return f'<tr><th style="{style}">{heading}</th><td style="{style}">{shown}</td></tr>'
