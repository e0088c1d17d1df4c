"""The rule sets that others are compared with where they run."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from geswarm.rules import RuleSet, RuleSetError, load_preset, load_rule_set, preset_names
from geswarm.sim import Scenario, vocabulary_of

_OF_THE_PAPER = ("evo8", "hand-coded")


@lru_cache(maxsize=64)
def references_of(scenario: Scenario) -> dict[str, RuleSet]:
    """The paper's two where they can run, else the scenario's own; by name."""
    vocabulary = vocabulary_of(scenario)
    known = preset_names(vocabulary)
    if set(_OF_THE_PAPER) <= set(known):
        return {name: load_preset(name, vocabulary) for name in _OF_THE_PAPER}
    if not scenario.reference:
        return {}
    try:
        rules = load_rule_set(scenario.reference, vocabulary)
        return {Path(scenario.reference).stem: rules}
    except RuleSetError:  # a file that has gone: there is nothing to compare with
        return {}


def first_rules(scenario: Scenario) -> RuleSet:
    """What robots run where nobody has said anything: EVO 8, or the scenario's reference."""
    return next(iter(references_of(scenario).values()), RuleSet(name="New rules"))
