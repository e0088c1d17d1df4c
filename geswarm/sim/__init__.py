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
from geswarm.sim.startup import is_compiled, warm_up
from geswarm.sim.world import NEEDS_RESET, World, WorldState

__all__ = [
    "CONTROL_STEP",
    "NEEDS_RESET",
    "BatchResult",
    "EvaluationStopped",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "World",
    "WorldState",
    "evaluate",
    "is_compiled",
    "load_scenario",
    "parse_scenario",
    "scenario_names",
    "warm_up",
]
