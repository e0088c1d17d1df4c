"""What is wrong with a rule set, all of it at once, each finding with its place."""

from __future__ import annotations

from geswarm.rules.diagnosis import diagnose
from geswarm.rules.findings import Finding
from geswarm.rules.model import RuleSet
from geswarm.rules.names import name_errors
from geswarm.rules.vocabulary import FORAGING, Vocabulary


def check(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[Finding]:
    """All findings of a rule set in the order of the rules, then those about it as a whole.

    Errors come alone: what a rule set does is defined only when there is none.
    """
    return name_errors(rule_set, vocabulary) or diagnose(rule_set, vocabulary)
