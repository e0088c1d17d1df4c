"""`geswarm bench --scenario S`; what is timed is held by `geswarm bench`, here by a clock."""

import json

import pytest

from geswarm import costs
from geswarm.cli import main
from geswarm.sim import load_scenario


@pytest.fixture
def ran(monkeypatch):
    """What was to run, each taking a second for every term on offer."""
    ran = []

    def runner(scenario, rule_set):
        ran.append((scenario, rule_set))
        terms = (scenario.preconditions, scenario.behaviours, scenario.measures)
        return lambda: sum(map(len, terms))

    monkeypatch.setattr(costs, "_runner", runner)
    monkeypatch.setattr(costs, "_cpu_seconds", lambda run: run())
    return ran


def test_each_term_is_left_out_in_turn(ran):
    said = []
    found = costs.measure_costs(load_scenario("aac"), said.append)
    assert found.rules == "aac"
    names = [each.name for each in found.terms]
    scenario = load_scenario("aac")
    assert names == [*scenario.preconditions, *scenario.behaviours, *scenario.measures]
    needed = [each.name for each in found.terms if each.without is None]
    assert needed == ["RANDOM_WALK", "on_black"]
    per_term = found.nanoseconds / 12
    assert all(
        found.nanoseconds - each.without == pytest.approx(per_term)
        for each in found.terms
        if each.without is not None
    )
    assert len(said) == 2 + len(names)


def test_rules_lose_what_is_not_on_offer(ran):
    costs.measure_costs(load_scenario("aac"))
    by_terms = {frozenset(scenario.behaviours): rules for scenario, rules in ran}
    without_stop = by_terms[frozenset(load_scenario("aac").behaviours) - {"STOP"}]
    texts = [str(element) for rule in without_stop.rules for element in rule.actions]
    assert len(without_stop.rules) == 3
    assert all("STOP" not in text for text in texts)


def test_as_a_table_and_as_json(ran, capsys):
    assert main(["bench", "--scenario", "xor", "--json"]) == 0
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    assert (document["scenario"], document["robots"], document["rules"]) == ("xor", 20, "xor")
    assert document["side_by_side"] is True
    floor = next(each for each in document["terms"] if each["name"] == "FLOOR")
    assert floor["kind"] == "precondition"
    assert floor["ns_without"] + floor["costs_ns"] == pytest.approx(document["ns_per_robot_step"])
    assert "xor without FLOOR" in captured.err
    assert main(["bench", "--scenario", "xor"]) == 0
    table = capsys.readouterr().out
    assert "ns per robot and control step" in table
    assert "ATTRACTION" in table
    assert main(["bench", "--scenario", "moon"]) == 2


@pytest.mark.parametrize("robots", [4, 200])
def test_simulations_side_by_side_and_large_swarms_are_timed(robots, monkeypatch):
    monkeypatch.setattr(costs, "_ROBOT_STEPS", 1000)
    monkeypatch.setattr(costs, "_REPEATS", 1)
    monkeypatch.setattr(costs, "_KINDS", {})
    paper = load_scenario("paper").with_changes(robots=robots, width=40.0)
    found = costs.measure_costs(paper)
    assert found.rules == "hand-coded"
    assert found.nanoseconds > 0
