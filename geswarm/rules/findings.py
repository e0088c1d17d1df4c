"""Findings: what there is to know about a rule set or a file, each with its place."""

from __future__ import annotations

import difflib
import reprlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

Severity: TypeAlias = Literal["error", "warning", "hint"]

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = 60


def shown(value: object) -> str:
    """A value as messages quote it: short, on one line, whatever it is."""
    try:
        return _SHORT.repr(value)
    except ValueError:  # a whole number with more digits than Python writes
        return "a number with thousands of digits"
    except RecursionError:
        return "something nested deeply"


def unknown_name(kind: str, given: str, known: Iterable[str]) -> str:
    """Message for a name that is not in the vocabulary, with the nearest one that is."""
    known = list(known)
    upper = given.upper().replace("-", "_")
    by_folded = {name.upper().replace("-", "_"): name for name in known}
    near = difflib.get_close_matches(upper, by_folded, n=1, cutoff=0.5)
    if near:
        hint = f"did you mean {by_folded[near[0]]}?"
    else:
        hint = f"expected {' or '.join(known)}" if known else "there is none on offer"
    return f"unknown {kind} {shown(given)}; {hint}"


@dataclass(frozen=True)
class Place:
    """Where a finding is: file and line (text input), rule number and element within the rule.

    `rule` counts from 1; `element` is the reader's word for the part, for example `action 2`.
    """

    source: str = ""
    line: int | None = None
    rule: int | None = None
    element: str = ""

    def __str__(self) -> str:
        where = self.source
        if self.line is not None:
            where = f"{where}:{self.line}" if where else f"line {self.line}"
        inside = [f"rule {self.rule}"] if self.rule is not None else []
        inside += [self.element] if self.element else []
        return ": ".join(part for part in (where, ", ".join(inside)) if part)


@dataclass(frozen=True)
class Finding:
    """One thing to know about a rule set.

    An error forbids running it; a warning says that it cannot be meant so; a hint says that a
    piece has no effect, which is true and harmless.
    """

    place: Place
    message: str
    severity: Severity = "error"

    def __str__(self) -> str:
        return f"{self.place}: {self.message}" if str(self.place) else self.message


class RuleSetError(ValueError):
    """A rule set cannot be used.

    Attributes:
        findings: Every reason.
        scenario: The scenario for which it says that it was written; empty if it does not.
    """

    def __init__(self, findings: Iterable[Finding], scenario: str = "") -> None:
        self.findings = tuple(findings)
        self.scenario = scenario
        super().__init__("\n".join(str(finding) for finding in self.findings))
