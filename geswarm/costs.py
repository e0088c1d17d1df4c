"""`geswarm bench --scenario S`: how fast a scenario is, and what each of its terms costs."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numba
import numpy as np

from geswarm.bench import Report, processor
from geswarm.rules import RuleSet, RuleSetError, Vocabulary, load_rule_set
from geswarm.sim import Scenario, ScenarioError, parts_of, vocabulary_of
from geswarm.sim.batch import Group, runs_side_by_side
from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.kernels.state import LANES
from geswarm.sim.swarm import Swarm
from geswarm.sim.terms.parts import PartsError

Run: TypeAlias = Callable[[], None]

_REPEATS = 7
_ROBOT_STEPS = 2_000_000
"""Of one repeat: about a tenth of a second."""
_KINDS = {
    "preconditions": "precondition",
    "behaviours": "behaviour",
    "registers": "register",
    "measures": "measure",
}


@dataclass(frozen=True)
class Cost:
    """What a term costs.

    Attributes:
        name: As the scenario offers it.
        kind: "precondition", "behaviour", "register" or "measure".
        without: Nanoseconds per robot and control step without it; None if the scenario cannot do
            without.
    """

    name: str
    kind: str
    without: float | None


@dataclass(frozen=True)
class Costs:
    """How fast a scenario is.

    Attributes:
        scenario: Which.
        rules: Name of the rule set that ran; empty for one without rules.
        nanoseconds: Per robot and control step, processor time of one thread.
        terms: Of each term on offer.
    """

    scenario: Scenario
    rules: str
    nanoseconds: float
    terms: tuple[Cost, ...]

    def document(self) -> dict[str, Any]:
        """As JSON values."""
        return {
            "scenario": self.scenario.name,
            "robots": self.scenario.robots,
            "side_by_side": runs_side_by_side(self.scenario),
            "rules": self.rules or None,
            "ns_per_robot_step": self.nanoseconds,
            "terms": [
                {
                    "name": each.name,
                    "kind": each.kind,
                    "ns_without": each.without,
                    "costs_ns": None if each.without is None else self.nanoseconds - each.without,
                }
                for each in self.terms
            ],
            "cpu": processor(),
            "numba": numba.__version__,
        }


def measure_costs(scenario: Scenario, progress: Report | None = None) -> Costs:
    """Measure a scenario with all its terms, and with each one left out.

    The reference rule set runs, without what a scenario with fewer terms does not offer. Kernels
    take turns, and the least time of several repeats counts. Every kernel is compiled on first use,
    which takes seconds to minutes.

    Args:
        scenario: Which.
        progress: Called with a line before each kernel, and before measuring.
    """
    report = progress or (lambda _: None)
    rule_set = _reference(scenario)
    report(f"{scenario.name} with all terms")
    runs: list[Run] = [_runner(scenario, rule_set)]
    left_out: list[tuple[str, str, int | None]] = []
    for key, name in _terms(scenario):
        report(f"{scenario.name} without {name}")
        smaller = _without(scenario, key, name)
        left_out.append((name, _KINDS[key], None if smaller is None else len(runs)))
        if smaller is not None:
            runs.append(_runner(smaller, _reduced(rule_set, vocabulary_of(smaller))))
    report("measuring")
    times = np.array([[_cpu_seconds(run) for run in runs] for _ in range(_REPEATS)]).min(axis=0)
    found = 1e9 * times / (_steps(scenario) * scenario.robots * _lanes(scenario))
    terms = [
        Cost(name, kind, None if at is None else float(found[at])) for name, kind, at in left_out
    ]
    named = scenario.reference if rule_set.rules else ""
    return Costs(scenario, named, float(found[0]), tuple(terms))


def _terms(scenario: Scenario) -> Iterator[tuple[str, str]]:
    for key in _KINDS:
        yield from ((key, name) for name in getattr(scenario, key))


def _reference(scenario: Scenario) -> RuleSet:
    """The scenario's reference rule set, or none."""
    try:
        return load_rule_set(scenario.reference, vocabulary_of(scenario))
    except RuleSetError:
        return RuleSet()


def _without(scenario: Scenario, key: str, name: str) -> Scenario | None:
    """The scenario without one of its terms; None if it cannot be without."""
    others = tuple(each for each in getattr(scenario, key) if each != name)
    try:
        smaller = scenario.with_changes(**{key: others})
        parts_of(smaller)
    except (ScenarioError, PartsError):
        return None
    return smaller


def _reduced(rule_set: RuleSet, vocabulary: Vocabulary) -> RuleSet:
    """The rules without what a vocabulary does not have."""
    rules = []
    for rule in rule_set.rules:
        behaviours = tuple(b for b in rule.behaviours if not vocabulary.behaviour_error(b))
        if rule.behaviours and not behaviours:
            continue
        known = tuple(p for p in rule.preconditions if not vocabulary.precondition_error(p))
        actions = tuple(a for a in rule.actions if not a.error(vocabulary))
        rules.append(replace(rule, preconditions=known, behaviours=behaviours, actions=actions))
    return replace(rule_set, rules=tuple(rules))


def _runner(scenario: Scenario, rule_set: RuleSet) -> Run:
    """What simulates so many steps, compiled and begun."""
    parts, steps = parts_of(scenario), _steps(scenario)
    controllers = compile_controllers([rule_set], fails(scenario, parts), parts)
    if runs_side_by_side(scenario):
        simulations = np.array([(0, lane, 0, 0) for lane in range(LANES)])
        group, done = Group(controllers, scenario, simulations), [0]

        def run_group() -> None:
            group.run(done[0], steps)
            done[0] += steps

        run_group()
        return run_group
    swarm = Swarm(scenario, rules=False)
    swarm.start(0, 0, 0)
    controller = controllers.for_lanes(np.zeros(LANES, dtype=np.int64))

    def run_swarm() -> None:
        swarm.run(controller, steps)

    run_swarm()
    return run_swarm


def _steps(scenario: Scenario) -> int:
    """Control steps of one repeat."""
    return max(5, _ROBOT_STEPS // (scenario.robots * _lanes(scenario)))


def _lanes(scenario: Scenario) -> int:
    """Simulations that run at once."""
    return LANES if runs_side_by_side(scenario) else 1


def _cpu_seconds(work: Run) -> float:
    """How long this thread works in a call."""
    before = time.thread_time()
    work()
    return time.thread_time() - before
