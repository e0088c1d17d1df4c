"""The next run as it is planned."""

from dataclasses import asdict

import pytest

from geswarm.app.state.plan import RunPlan, RunPlanError, preset_of
from geswarm.ge import PRESETS, Settings
from geswarm.rules import RuleSet, apply_edit, load_preset, parse_text
from geswarm.sim import load_scenario

PAPER = load_scenario("paper")
EVO8 = load_preset("evo8")


def frozen(plan, rule_set):
    return [rule_set.rules.index(rule) for rule in plan.frozen_rules(rule_set)]


def test_a_preset_fills_all_values_and_changes_are_told():
    plan = RunPlan().with_value("mutation", 0.2).with_preset("modern", PAPER)
    assert plan.values == asdict(Settings.preset("modern"))
    assert plan.changed(PAPER) == []
    plan = plan.with_value("mutation", 0.2).with_value("seed", 7)
    assert plan.changed(PAPER) == ["mutation"]
    config = plan.config(PAPER, EVO8)
    assert (config.settings.mutation, config.seed, config.frozen) == (0.2, 7, ())
    assert config.settings.selection == PRESETS["modern"]["selection"]


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("population", 1, "expected a whole number >= 2, got 1"),
        ("population", "many", "expected a whole number >= 2, got 'many'"),
        ("generations", 10**30, "expected at most"),
        ("mutation", 1.5, "expected a probability in [0, 1], got 1.5"),
        ("selection", "luck", "expected roulette or tournament, got 'luck'"),
        ("share_evaluations", "", "expected True or False, got ''"),
        ("seed", -1, "expected a whole number from 0"),
        ("seed", 1.5, "expected a whole number from 0"),
        ("seed", True, "expected a whole number from 0"),
    ],
)
def test_what_cannot_be_used_is_told_at_its_name(name, value, message):
    plan = RunPlan().with_value(name, value)
    findings = plan.findings(PAPER, EVO8)
    assert list(findings) == [name]
    assert message in findings[name]
    with pytest.raises(RunPlanError, match=f"^{name}: expected"):
        plan.config(PAPER, EVO8)


@pytest.mark.parametrize(("name", "value"), [("luck", 1), ("seed", None), ("seed", [1])])
def test_what_is_no_value_is_refused(name, value):
    with pytest.raises(RunPlanError, match=name):
        RunPlan().with_value(name, value)
    with pytest.raises(RunPlanError, match="preset"):
        RunPlan().with_preset("luck", PAPER)


def test_frozen_rules_stay_frozen_while_the_table_is_edited():
    plan = RunPlan().freezing(EVO8.rules[0], True).freezing(EVO8.rules[2], True)
    assert frozen(plan, EVO8) == [0, 2]
    for edit, expected in (
        ({"do": "move_rule", "rule": 2, "to": 0}, [0, 1]),
        ({"do": "remove", "rule": 2, "part": "actions", "at": 0}, [0, 2]),
        ({"do": "set_comment", "rule": 2, "comment": "other words"}, [0, 2]),
        ({"do": "remove_rule", "rule": 0}, [1]),
        ({"do": "set_enabled", "rule": 2, "enabled": False}, [0]),
    ):
        edited = apply_edit(EVO8, edit)
        assert frozen(plan.following(EVO8, edited), edited) == expected, edit
    assert frozen(plan.freezing(EVO8.rules[0], False), EVO8) == [2]


def test_frozen_rules_come_first_in_what_enters_the_first_generation():
    plan = RunPlan().freezing(EVO8.rules[2], True)
    assert plan.first(PAPER, EVO8) is None
    first = plan.with_value("from_table", True).first(PAPER, EVO8)
    assert first.rules == tuple(EVO8.rules[i] for i in (2, 0, 1, 3))


def test_rules_that_cannot_enter_are_a_finding():
    odd = parse_text("rule do p = 0.15, RANDOM_WALK")
    findings = RunPlan().with_value("from_table", True).findings(PAPER, odd)
    assert "the nearest is 0.1" in findings["from_table"]
    assert RunPlan().with_value("from_table", True).findings(PAPER, RuleSet())["from_table"]
    assert RunPlan().findings(PAPER, odd) == {}


def test_the_nearest_preset_is_told_whatever_the_sizes():
    assert preset_of(Settings(population=7, generations=3)) == ("paper", [])
    assert preset_of(Settings.preset("modern", mutation=0.1)) == ("modern", ["mutation"])
