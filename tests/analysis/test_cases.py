"""Cases run together give what each gives alone."""

import doctest

import numpy as np
import pytest

import geswarm.analysis
from geswarm.analysis.cases import Case, contrasts, run_cases
from geswarm.evaluation import Evaluation, evaluate_rule_sets
from geswarm.rules import load_preset
from geswarm.sim import EvaluationStopped, load_scenario

SHORT = load_scenario("paper").with_changes(duration=100.0)
CROWD = SHORT.with_changes(name="crowd", robots=8)
RULES = {"evo8": load_preset("evo8"), "hand-coded": load_preset("hand-coded")}


def test_each_case_gives_what_it_gives_alone_and_the_order_is_kept():
    cases = [Case(rules, scenario) for rules in RULES for scenario in (SHORT, CROWD)]
    told = []
    samples = run_cases(cases, RULES, 5, 3, on_progress=lambda *work: told.append(work))
    assert list(samples) == cases
    for case, found in samples.items():
        (alone,) = evaluate_rule_sets([RULES[case.rules]], case.scenario, 5, 3)
        assert found.fitness.tolist() == alone.fitness.tolist()
        assert found.measures["lost"].tolist() == alone.measures["lost"].tolist()
    assert told == [(2 * 5 * 4, 120), (2 * 5 * 4 + 2 * 5 * 8, 120)]


def test_stop_ends_it():
    with pytest.raises(EvaluationStopped):
        run_cases([Case("evo8", SHORT)], RULES, 5, 3, stop=lambda: True)


def test_contrasts_are_corrected_for_the_whole_family():
    values = {"low": range(50), "high": range(100, 150), "same": range(50)}
    cases = {name: Case(name, SHORT) for name in values}
    samples = {
        cases[name]: Evaluation(SHORT.objective, np.array(fitness), {})
        for name, fitness in values.items()
    }
    pairs = [(cases["high"], cases["low"]), (cases["same"], cases["low"])]
    first, second = contrasts(samples, pairs)
    assert (first.comparison.winner, second.comparison.winner) == (1, 0)
    assert first.p_holm == pytest.approx(2 * first.comparison.p_value)
    assert second.p_holm == second.comparison.p_value == 1.0


def test_the_example_of_the_package_is_true():
    result = doctest.testmod(geswarm.analysis)
    assert result.attempted >= 8
    assert result.failed == 0
