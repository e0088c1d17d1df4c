"""The missions of the field for e-pucks: what they are, and that they agree with the real stack.

`missions_reference.json` holds objectives of small machines in argos3-epuck 48 with reference model
1.2, but cfa's by its definition.
"""

import json
import math
from pathlib import Path

import pytest

from geswarm.automode import read_machines
from geswarm.evaluation import evaluate_rule_sets
from geswarm.exports.arena_picture import arena_picture
from geswarm.rules import load_preset, parse_text
from geswarm.sim import evaluate, load_scenario, scenario_names, vocabulary_of

REFERENCE = json.loads(Path(__file__).with_name("missions_reference.json").read_text())
MISSIONS = [name for name in scenario_names() if load_scenario(name).body == "e-puck"]
GUIDE = Path(__file__).parents[2] / "static" / "guide"
RUNS = 48


@pytest.mark.parametrize("name", MISSIONS)
def test_each_mission_has_rules_by_hand_and_is_in_the_guide(name):
    scenario = load_scenario(name)
    assert scenario.reference == name
    assert load_preset(name, vocabulary_of(scenario)).scenario == name
    assert f"| `{name}` | ![{name}]({name}.svg) |" in (GUIDE / "missions.md").read_text()
    assert (GUIDE / f"{name}.svg").read_text() == arena_picture(scenario)


@pytest.mark.long
@pytest.mark.parametrize("name", MISSIONS)
def test_rules_by_hand_are_better_than_exploration(name):
    scenario = load_scenario(name)
    words = vocabulary_of(scenario)
    exploring = parse_text("rule while STOP do p = 1, EXPLORATION(5)", "", words)
    both = [load_preset(name, words), exploring]
    by_hand, other = evaluate_rule_sets(both, scenario, runs=30, seed=0)
    better = by_hand.mean - other.mean if scenario.objective.maximise else other.mean - by_hand.mean
    assert better > 2.0 * math.hypot(by_hand.fitness.std(), other.fitness.std()) / math.sqrt(30)


@pytest.mark.long
@pytest.mark.parametrize(
    "case", REFERENCE, ids=[f"{each['scenario']}: {each['controller']}" for each in REFERENCE]
)
def test_objectives_agree_with_the_real_stack(case):
    scenario = load_scenario(case["scenario"])
    machines = read_machines(case["machine"])
    found = evaluate(machines, scenario, [(0, 7, 0, run) for run in range(RUNS)]).fitness
    error = math.hypot(case["sd"] / math.sqrt(case["runs"]), found.std() / math.sqrt(RUNS))
    assert found.mean() == pytest.approx(case["mean"], rel=0.1, abs=2.0 * error)
