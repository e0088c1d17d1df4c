"""What can be said of the edited rules without running them, found in the background."""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.rules import Finding, RuleSet, Simplification, Vocabulary, check, simplify

from .background import Newest, Stop


@dataclass(frozen=True)
class Insight:
    """Findings of one version of the document.

    Attributes:
        version: Of the document.
        findings: Errors, warnings and hints.
        simplification: The shortest rules that behave exactly so.
    """

    version: int
    findings: tuple[Finding, ...]
    simplification: Simplification


class InsightFinder:
    """Looks into the newest version, on a thread of its own.

    Attributes:
        insight: Replaced as it is found; None before the first one.
    """

    def __init__(self) -> None:
        self.insight: Insight | None = None
        self._newest: Newest[tuple[int, RuleSet, Vocabulary]] = Newest("insight", self._look)

    def look_into(self, version: int, rule_set: RuleSet, vocabulary: Vocabulary) -> None:
        """Begin at once; what was under way is dropped."""
        self._newest.ask((version, rule_set, vocabulary))

    def close(self) -> None:
        """End the thread."""
        self._newest.close()

    def _look(self, question: tuple[int, RuleSet, Vocabulary], stop: Stop) -> None:
        version, rule_set, vocabulary = question
        findings = tuple(check(rule_set, vocabulary))
        simplification = simplify(rule_set, vocabulary)
        if not stop():
            self.insight = Insight(version, findings, simplification)
