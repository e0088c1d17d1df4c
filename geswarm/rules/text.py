"""The rule language: a rule set as text that a person can read and type.

    # Comments before a rule belong to it.
    rule
      if ON_NEST == true and HAS_OBJECT == true
      while RANDOM_WALK or PHOTOTAXIS
      do p = 1, PHOTOTAXIS
      do p = 0.001, ANTI-PHOTOTAXIS

Line breaks and indentation are free. `rule off` is a rule that is switched off. Before the first
rule, `name "..."`, `scenario "..."` (in whose words it is written) and `origin ...` may stand;
comments before them belong to the rule set. The phenotypes that the grammar derives are sentences
of this language.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from geswarm.plain_text import tidy
from geswarm.rules.elements import (
    ElementError,
    parse_action,
    parse_behaviour,
    parse_precondition,
)
from geswarm.rules.findings import Finding, Place, RuleSetError, shown
from geswarm.rules.limits import is_finite
from geswarm.rules.model import Action, Origin, Precondition, Rule, RuleSet, Term, clean_line
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_TOKEN = re.compile(
    r'(?P<comment>\#.*)|(?P<string>"(?:[^"\\]|\\.)*"?)|(?P<word>[\w.+-]+)|(?P<space>\s+)|(?P<other>.)'
)
_KEYWORDS = frozenset({"name", "scenario", "origin", "rule", "if", "and", "while", "or", "do"})
_STAGE = {"rule": 0, "if": 1, "and": 1, "while": 2, "or": 2, "do": 3}
_ORIGIN_PART = re.compile(r'\s*(\w+)\s+("(?:[^"\\]|\\.)*"|[^\s,"]+)\s*(?:,|$)')
_ORIGIN_TYPES: dict[str, type] = {"preset": str, "run": str, "generation": int, "fitness": float}


def format_text(rule_set: RuleSet) -> str:
    """Write a rule set in the rule language; `parse_text` reads back exactly the same value."""
    lines = _comment_lines(rule_set.comment)
    lines.append(f"name {json.dumps(rule_set.name, ensure_ascii=False)}")
    if rule_set.scenario:
        lines.append(f"scenario {json.dumps(rule_set.scenario, ensure_ascii=False)}")
    origin = ", ".join(
        f"{key} {json.dumps(value, ensure_ascii=False)}"
        for key, value in vars(rule_set.origin).items()
        if value is not None
    )
    if origin:
        lines.append(f"origin {origin}")
    for rule in rule_set.rules:
        lines += ["", format_rule(rule)]
    return "\n".join(lines) + "\n"


def format_rule(rule: Rule) -> str:
    """One rule with its comment, as it stands in the text of its rule set."""
    return "\n".join([*_comment_lines(rule.comment), *_rule_lines(rule)])


def _comment_lines(comment: str) -> list[str]:
    return [f"# {line}".rstrip() for line in comment.split("\n")] if comment else []


def _rule_lines(rule: Rule) -> Iterator[str]:
    yield "rule" if rule.enabled else "rule off"
    if rule.preconditions:
        yield "  if " + " and ".join(map(str, rule.preconditions))
    if rule.behaviours:
        yield "  while " + " or ".join(map(str, rule.behaviours))
    for action in rule.actions:
        yield "  do " + str(action)


def parse_text(text: str, source: str = "", vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """Read a rule set from the rule language.

    Args:
        text: The sentence, for example what `format_text` wrote or a grammar derived.
        source: File name for error messages.
        vocabulary: The names that may occur.

    Raises:
        RuleSetError: With every problem, each with file, line, rule and element.
    """
    parser = _Parser(source, vocabulary)
    for phrase in _phrases(text):
        parser.take(phrase)
    return parser.rule_set()


@dataclass
class _Phrase:
    """A keyword with all that stands behind it up to the next one; `#` is a line of comment."""

    keyword: str
    line: int
    body: str = ""
    comments: list[str] = field(default_factory=list)


def _phrases(text: str) -> Iterator[_Phrase]:
    """Cut the text at its keywords; a comment behind a phrase goes with that phrase."""
    phrase: _Phrase | None = None
    for number, line in enumerate(tidy(text).split("\n"), start=1):
        for match in _TOKEN.finditer(line):
            if match.lastgroup == "comment":
                comment = match[0][1:].removeprefix(" ")
                if phrase and line[: match.start()].strip():
                    phrase.comments.append(comment)
                    continue
                if phrase:
                    yield phrase
                    phrase = None
                yield _Phrase("#", number, comment)
            elif match.lastgroup == "word" and match[0] in _KEYWORDS:
                if phrase:
                    yield phrase
                phrase = _Phrase(match[0], number)
            elif phrase:
                phrase.body += match[0]
            elif match.lastgroup != "space":
                phrase = _Phrase("", number, match[0])
        if phrase:
            phrase.body += " "
    if phrase:
        yield phrase


@dataclass
class _Draft:
    """A rule being read."""

    comment: list[str]
    enabled: bool = True
    stage: str = "rule"
    preconditions: list[Precondition] = field(default_factory=list)
    behaviours: list[Term] = field(default_factory=list)
    actions: list[Action] = field(default_factory=list)
    elements: Counter[str] = field(default_factory=Counter)

    def rule(self) -> Rule:
        return Rule(
            tuple(self.preconditions),
            tuple(self.behaviours),
            tuple(self.actions),
            "\n".join(self.comment),
            self.enabled,
        )


class _Parser:
    """Takes phrases one by one and collects problems instead of stopping at the first."""

    def __init__(self, source: str, vocabulary: Vocabulary) -> None:
        self.source = source
        self.vocabulary = vocabulary
        self.findings: list[Finding] = []
        self.drafts: list[_Draft] = []
        self.name = ""
        self.scenario = ""
        self.comment: list[str] = []
        self.origin = Origin()
        self.headers: set[str] = set()
        self.pending: list[str] = []  # lines of comment whose owner comes next

    def rule_set(self) -> RuleSet:
        if not self.drafts and not self.headers and not self.findings:
            self.report(1, "expected at least one rule, for example: rule do p = 1, PHOTOTAXIS")
        if self.findings:
            raise RuleSetError(self.findings, self.scenario)
        (self.drafts[-1] if self.drafts else self).comment += self.pending
        rules = tuple(draft.rule() for draft in self.drafts)
        return RuleSet(rules, self.name, "\n".join(self.comment), self.origin, self.scenario)

    def report(self, line: int, message: str, element: str = "") -> None:
        rule = len(self.drafts) or None
        self.findings.append(Finding(Place(self.source, line, rule, element), message))

    def take(self, phrase: _Phrase) -> None:
        if phrase.keyword == "#":
            self.pending.append(phrase.body)
        elif phrase.keyword == "":
            expected = "if, while, do or rule" if self.drafts else "name, scenario, origin or rule"
            self.report(phrase.line, f"expected {expected}, got {shown(phrase.body.strip())}")
        elif phrase.keyword in ("name", "scenario", "origin"):
            self.take_header(phrase)
        elif phrase.keyword == "rule":
            self.take_rule(phrase)
        elif not self.drafts:
            self.report(phrase.line, f"expected rule before {phrase.keyword}")
        else:
            self.take_element(phrase, self.drafts[-1])

    def take_header(self, phrase: _Phrase) -> None:
        if self.drafts:
            self.report(phrase.line, f"{phrase.keyword} must stand before the first rule")
            return
        if phrase.keyword in self.headers:
            self.report(phrase.line, f"{phrase.keyword} is given twice")
        self.headers.add(phrase.keyword)
        self.comment += self.pending + phrase.comments
        self.pending = []
        try:
            if phrase.keyword == "name":
                self.name = _string(phrase.body.strip())
            elif phrase.keyword == "scenario":
                self.scenario = clean_line(_string(phrase.body.strip()))
            else:
                self.origin = _origin(phrase.body)
        except ElementError as error:
            self.report(phrase.line, str(error), phrase.keyword)

    def take_rule(self, phrase: _Phrase) -> None:
        self.drafts.append(_Draft(self.pending + phrase.comments))
        self.pending = []
        word = phrase.body.strip().removeprefix(":").strip()
        if word == "off":
            self.drafts[-1].enabled = False
        elif word:
            self.report(phrase.line, f"expected if, while, do or off, got {shown(word)}")

    def take_element(self, phrase: _Phrase, draft: _Draft) -> None:
        draft.comment += self.pending + phrase.comments
        self.pending = []
        keyword = phrase.keyword
        if (problem := _out_of_order(draft.stage, keyword)) is not None:
            self.report(phrase.line, problem)
        draft.stage = keyword
        kind = ("precondition", "behaviour", "action")[_STAGE[keyword] - 1]
        draft.elements[kind] += 1
        try:
            if kind == "precondition":
                draft.preconditions.append(parse_precondition(phrase.body, self.vocabulary))
            elif kind == "behaviour":
                draft.behaviours.append(parse_behaviour(phrase.body, self.vocabulary))
            else:
                draft.actions.append(parse_action(phrase.body, self.vocabulary))
        except ElementError as error:
            self.report(phrase.line, str(error), f"{kind} {draft.elements[kind]}")


def _out_of_order(before: str, keyword: str) -> str | None:
    """Why `keyword` cannot follow `before` within a rule, or None if it can."""
    if _STAGE[keyword] < _STAGE[before]:
        return f"{keyword} must stand before {before}"
    if keyword == "and" and _STAGE[before] != 1:
        return "and must follow if"
    if keyword == "or" and _STAGE[before] != 2:
        return "or must follow while"
    if keyword in ("if", "while") and _STAGE[before] == _STAGE[keyword]:
        return f"a rule has one {keyword}: join with {'and' if keyword == 'if' else 'or'}"
    return None


def _string(text: str) -> str:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, str):
        given = shown(text) if text else "nothing"
        raise ElementError(f"expected a text in double quotes, got {given}")
    return value


def _origin(text: str) -> Origin:
    parts: dict[str, Any] = {}
    at, text = 0, text.strip()
    while at < len(text):
        match = _ORIGIN_PART.match(text, at)
        if match is None or match[1] not in _ORIGIN_TYPES:
            raise ElementError(
                'expected preset "...", run "...", generation N or fitness X, '
                f"separated by commas, got {shown(text[at:])}"
            )
        key, value = match.groups()
        if key in parts:
            raise ElementError(f"{key} is given twice")
        parts[key] = _string(value) if _ORIGIN_TYPES[key] is str else _number(key, value)
        at = match.end()
    return Origin(**parts)


def _number(key: str, text: str) -> float:
    try:
        value: float = _ORIGIN_TYPES[key](text)
    except ValueError:
        raise ElementError(f"{key} must be a number, got {shown(text)}") from None
    if not is_finite(value):
        raise ElementError(f"{key} must be a finite number, got {shown(text)}")
    return value
