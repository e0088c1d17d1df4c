"""A rule set laid out like the paper's Tables 1 and 2, as plain text."""

from __future__ import annotations

from collections.abc import Iterator

from geswarm.rules.elements import format_probability
from geswarm.rules.model import Action, Rule, RuleSet

EMPTY = "ε"
_GAP = "   "


def format_table(rule_set: RuleSet) -> str:
    """Every rule as its comment and the rows P, B and A, elements side by side."""
    blocks = ["\n".join(_rule_lines(number, rule)) for number, rule in enumerate(rule_set.rules, 1)]
    width = max((len(line) for block in blocks for line in block.split("\n")), default=0)
    title = [rule_set.name] if rule_set.name else []
    comment = rule_set.comment.split("\n") if rule_set.comment else []
    line = "─" * max(width, 20)
    return "\n".join([*title, *comment, line, f"\n{line}\n".join(blocks), line]) + "\n"


def _rule_lines(number: int, rule: Rule) -> Iterator[str]:
    comment = rule.comment.split("\n")
    off = "" if rule.enabled else "(off) "
    yield f"R{number}  {off}{comment[0]}".rstrip()
    yield from (f"    {line}" for line in comment[1:])
    yield _row("P", number, [str(entry) for entry in rule.preconditions])
    yield _row("B", number, [str(entry) for entry in rule.behaviours])
    actions = [_action_cells(action) for action in rule.actions]
    for at, row in enumerate(_columns(actions) or [EMPTY]):
        yield f"{f'A{number}' if at == 0 else '':<4}{row}"


def _row(letter: str, number: int, cells: list[str]) -> str:
    return f"{letter + str(number):<4}{_GAP.join(cells) or EMPTY}"


def _action_cells(action: Action) -> tuple[str, str, str]:
    kind = "state" if action.target else "behaviour"
    probability = f"p = {format_probability(action.p)}"
    return kind, probability, f"{action.target or 'B'} ← {action.becomes}"


def _columns(rows: list[tuple[str, str, str]]) -> list[str]:
    widths = [max(len(row[column]) for row in rows) for column in range(3)] if rows else []
    return [
        _GAP.join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
