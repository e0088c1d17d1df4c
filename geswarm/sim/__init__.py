"""The simulator: scenarios, batch evaluation and the interactive world.

Many runs to their end, each with random numbers of its own:

>>> from geswarm.rules import ControlTable, StateMachine, load_rule_set
>>> from geswarm.sim import Simulation, World, evaluate, load_scenario, vocabulary_of
>>> evo8, hand_coded = load_rule_set("evo8"), load_rule_set("hand-coded")
>>> short = load_scenario("paper").with_changes(duration=1000.0)
>>> runs = [Simulation(table, seed=1, replicate=n) for table in (0, 1) for n in range(20)]
>>> result = evaluate([ControlTable.compile(rules) for rules in (evo8, hand_coded)], short, runs)
>>> first, second = result.fitness.reshape(2, 20)
>>> bool(first.mean() > second.mean())
True

One run to look into; new rules take over while it goes on:

>>> world = World(short, evo8, seed=1)
>>> world.step(3000)
>>> world.time, world.state.x.shape
(300.0, (4,))
>>> machine = StateMachine.of(evo8)
>>> taken = machine.times_taken(world.decisions)
>>> print(machine.describe(machine.transitions[taken.argmax()]))
PHOTOTAXIS to RANDOM_WALK when not ON_NEST and not HAS_OBJECT: p = 0.05, 2 s
>>> world.set_rules(hand_coded)
>>> world.step(3000)
>>> world.time
600.0

Any scenario, with words, measures and an objective of its own:

>>> aac = load_scenario("aac")
>>> by_hand = load_rule_set(aac.reference, vocabulary_of(aac))
>>> result = evaluate([by_hand], aac, [Simulation(0, seed=1, replicate=n) for n in range(20)])
>>> aac.objective.label, bool(result.fitness.mean() > 6000)
('on_black (robot-steps)', True)
"""

from geswarm.rules.model import CONTROL_STEP
from geswarm.sim.batch import BatchResult, EvaluationStopped, Simulation, Stop, can_run, evaluate
from geswarm.sim.controllers.machines import ControllerError
from geswarm.sim.controllers.tables import Controller, require_runnable
from geswarm.sim.cores import available_cores
from geswarm.sim.library.vocabulary import TermError, parts_of, vocabulary_of
from geswarm.sim.scenario.model import (
    Scenario,
    ScenarioError,
    load_scenario,
    parse_scenario,
    scenario_about,
    scenario_names,
)
from geswarm.sim.scenario.objective import Objective, ObjectiveError
from geswarm.sim.startup import is_compiled, warm_up
from geswarm.sim.world import NEEDS_RESET, World, WorldState, can_go_on

__all__ = [
    "CONTROL_STEP",
    "NEEDS_RESET",
    "BatchResult",
    "Controller",
    "ControllerError",
    "EvaluationStopped",
    "Objective",
    "ObjectiveError",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "Stop",
    "TermError",
    "World",
    "WorldState",
    "available_cores",
    "can_go_on",
    "can_run",
    "evaluate",
    "is_compiled",
    "load_scenario",
    "parse_scenario",
    "parts_of",
    "require_runnable",
    "scenario_about",
    "scenario_names",
    "vocabulary_of",
    "warm_up",
]
