"""The simulator: scenarios, batch evaluation and the interactive world."""

from geswarm.sim.batch import BatchResult, EvaluationStopped, Simulation, evaluate
from geswarm.sim.footbot import CONTROL_STEP
from geswarm.sim.scenario import (
    Scenario,
    ScenarioError,
    load_scenario,
    parse_scenario,
    scenario_names,
)
from geswarm.sim.world import World, WorldState

__all__ = [
    "CONTROL_STEP",
    "BatchResult",
    "EvaluationStopped",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "World",
    "WorldState",
    "evaluate",
    "load_scenario",
    "parse_scenario",
    "scenario_names",
]
