"""Another rule set that runs beside the one being edited: same scenario, seed and clock."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from geswarm.rules import RuleSet, Vocabulary, load_preset, preset_names
from geswarm.rules.names import name_errors

from .document import RuleDocument
from .runs import Runs
from .swarm import ShownSwarm

BEFORE = "before the last edit"
CHOSEN = "individual clicked"


@dataclass
class Rival:
    """The other swarm.

    Attributes:
        name: One of the names that `rivals_offered` gave.
        swarm: Its world, stepped together with the first.
    """

    name: str
    swarm: ShownSwarm


def best_of(run: str) -> str:
    """What the best rule set of a run is called wherever it can be chosen."""
    return f"best of {run}"


@cache
def presets_of(vocabulary: Vocabulary) -> dict[str, RuleSet]:
    """The presets that a vocabulary can say, by name; read once."""
    return {name: load_preset(name, vocabulary) for name in preset_names(vocabulary)}


def rivals_offered(
    document: RuleDocument, runs: Runs, vocabulary: Vocabulary
) -> dict[str, RuleSet]:
    """The rule sets that there are to compare with now, by name for people."""
    offered = {preset.name: preset for preset in presets_of(vocabulary).values()}
    if document.before is not None:
        offered[BEFORE] = document.before
    if runs.best is not None and runs.shown is not None:
        offered[best_of(runs.shown.name)] = runs.best
    if runs.chosen is not None:
        offered[CHOSEN] = runs.chosen.rule_set
    return {
        name: rule_set
        for name, rule_set in offered.items()
        if not name_errors(rule_set, vocabulary)
    }
