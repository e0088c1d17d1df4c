"""The missions of the field for e-pucks: what they are."""

import math
from pathlib import Path

import pytest

from geswarm.evaluation import evaluate_rule_sets
from geswarm.exports.arena_picture import arena_picture
from geswarm.rules import load_preset, parse_text
from geswarm.sim import load_scenario, scenario_names, vocabulary_of

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
