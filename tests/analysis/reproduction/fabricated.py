"""Campaigns that never ran: their figures are chosen, so that claims must come out so or so."""

import numpy as np

from geswarm.analysis.reproduction import Plan, Results, studies
from geswarm.analysis.reproduction.results import foraged
from geswarm.ge import GenerationRecord
from geswarm.rules import load_preset, parse_text

WALK = parse_text("rule do p = 0.1, RANDOM_WALK")


def sample(mean, spread=10.0, runs=50):
    """Runs spread evenly around a mean."""
    collected = np.rint(mean + np.linspace(-spread, spread, runs)).astype(np.int64)
    return foraged(np.maximum(collected, 0), np.zeros(runs))


def fabricated(
    evolved=(120, 110, 105, 100, 95, 90, 85, 66, 65, 40),
    evo8=100.0,
    hand_coded=65.0,
    growth=lambda robots: robots / 4,
    at_zero=150.0,
    plan=None,
    rule_sets=None,
):
    """Results in which the best evolved rules, EVO 8 and hand-coded keep their order everywhere.

    Args:
        evolved: Mean collected of each evolved rule set.
        evo8: Mean of EVO 8.
        hand_coded: Mean of the hand-coded rules.
        growth: What a swarm of so many robots collects, relative to one of 4.
        at_zero: Mean of the hand-coded rules with perfect sensing; falls linearly to 0.16.
        plan: By default the paper's, for this number of runs.
        rule_sets: Evolved rule sets by name, in place of a random walk.
    """
    plan = plan or Plan(runs=len(evolved))
    names = [studies.evolved_name(seed) for seed in plan.seeds]
    means = {**dict(zip(names, evolved, strict=True)), "EVO 8": evo8, "hand-coded": hand_coded}
    best = max(names, key=lambda name: means[name])

    def over_zone_miss(case):
        if case.rules == "EVO 8":
            return evo8
        return at_zero + (hand_coded - at_zero) * case.scenario.zone_miss / 0.08

    others = studies.others(best)
    swarms = {
        kind: {
            case: sample(means[case.rules] * growth(case.scenario.robots)) for case in others[kind]
        }
        for kind in ("scalability", "flexibility")
    }
    return Results(
        plan=plan,
        histories={
            name: [GenerationRecord(at, 10.0 * at, 9.0, 5.0, 3, 90, 0.5) for at in (1, 2, 3)]
            for name in names
        },
        rule_sets={
            **dict.fromkeys(names, WALK),
            "EVO 8": load_preset("evo8"),
            "hand-coded": load_preset("hand-coded"),
            **(rule_sets or {}),
        },
        performance={case: sample(means[case.rules]) for case in studies.performance(names)},
        sensitivity={case: sample(over_zone_miss(case)) for case in others["sensitivity"]},
        agreement={case: sample(found.mean) for case, found in studies.argos().items()},
        **swarms,
    )
