"""The paper's grammar over a vocabulary: its sentences are rule sets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import resources

from geswarm.ge import Grammar
from geswarm.rules import FORAGING, Vocabulary
from geswarm.rules.elements import format_probability


def rule_grammar(vocabulary: Vocabulary = FORAGING) -> Grammar:
    """The grammar whose sentences are the rule sets that a vocabulary allows."""
    return geswarm_grammar(
        {
            "P_name": list(vocabulary.precondition_index),
            "B_name": list(vocabulary.behaviour_index),
            "IS_name": list(vocabulary.state_index),
            "value": [format_probability(p) for p in vocabulary.probabilities],
        }
    )


def geswarm_grammar(words: Mapping[str, Sequence[str]]) -> Grammar:
    """The GESwarm grammar (paper, section 2.2) over words.

    Args:
        words: For `P_name` (preconditions), `B_name` (behaviours), `IS_name` (internal states) and
            `value` (probabilities, as text).
    """
    text = resources.files(__package__).joinpath("geswarm.bnf").read_text(encoding="utf-8")
    return Grammar.parse(text, source="geswarm.bnf", vocabulary=words)
