"""The experiments with finished rule sets: which run in which scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import yaml

from geswarm.analysis.cases import Case, Samples
from geswarm.analysis.reproduction.results import foraged
from geswarm.sim import Scenario, load_scenario

HAND_CODED, EVO_8 = "hand-coded", "EVO 8"
"""Names of the paper's rule sets, Tables 1 and 2."""

SWARM_SIZES = (5, 10, 20)
"""Robots in Figure 3."""

OF_THE_EVOLVED = ("performance", "scalability", "flexibility")
"""The experiments whose rule sets the evolution decides."""

ZONE_MISSES = tuple(round(0.01 * step, 2) for step in range(21))
_ARGOS = Path(__file__).with_name("argos.yaml")


def evolved_name(seed: int) -> str:
    """What the rule set that a run ended with is called."""
    return f"seed {seed}"


def performance(evolved: Sequence[str]) -> list[Case]:
    """All evolved rule sets and those of the paper where they evolved (Figure 2b)."""
    scenario = load_scenario("paper")
    return [Case(rules, scenario) for rules in (*evolved, EVO_8, HAND_CODED)]


def others(best: str) -> dict[str, list[Case]]:
    """All experiments but the performance, by name.

    Args:
        best: Name of the best evolved rule set.
    """
    return {
        "scalability": _larger_swarms("scalability", best),
        "flexibility": _larger_swarms("flexibility", best),
        "sensitivity": [
            Case(rules, with_zone_miss("paper", miss))
            for miss in ZONE_MISSES
            for rules in (EVO_8, HAND_CODED)
        ],
        "agreement": list(argos()),
    }


def _larger_swarms(kind: str, best: str) -> list[Case]:
    """The best evolved rule set and those of the paper with 5, 10, 20 robots (Figure 3)."""
    return [
        Case(rules, load_scenario(f"{kind}-{robots}"))
        for robots in SWARM_SIZES
        for rules in (best, EVO_8, HAND_CODED)
    ]


@cache
def with_zone_miss(name: str, zone_miss: float) -> Scenario:
    """A scenario with another `zone_miss`, and a name that says so."""
    scenario = load_scenario(name)
    if zone_miss == scenario.zone_miss:
        return scenario
    return scenario.with_changes(name=f"{name}, zone_miss {zone_miss:g}", zone_miss=zone_miss)


def argos() -> Samples:
    """What ARGoS 3 collected in the same scenarios, 20 runs each."""
    samples = {}
    for entry in yaml.safe_load(_ARGOS.read_text(encoding="utf-8"))["cases"]:
        scenario = load_scenario(entry["scenario"])
        if "zone_miss" in entry:
            scenario = with_zone_miss(entry["scenario"], entry["zone_miss"])
        collected = np.array(entry["collected"])
        samples[Case(entry["rules"], scenario)] = foraged(collected, np.zeros_like(collected))
    return samples


def argos_over_zone_miss() -> Samples:
    """Those of ARGoS' runs that differ from `paper` in `zone_miss` alone."""
    points = {}
    for case, evaluation in argos().items():
        scenario = with_zone_miss("paper", case.scenario.zone_miss)
        if case.scenario.with_changes(name=scenario.name) == scenario:
            points[case] = evaluation
    return points
