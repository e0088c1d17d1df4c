import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from geswarm.rules import (
    FORAGING,
    ControlTable,
    RuleSet,
    Space,
    Vocabulary,
    load_preset,
    parse_text,
)
from geswarm.sim import batch
from geswarm.sim.batch import EvaluationStopped, Simulation, evaluate, runs_side_by_side
from geswarm.sim.scenario.model import load_scenario

TABLES = [ControlTable.compile(load_preset(name)) for name in ("hand-coded", "evo8")]
SHORT = load_scenario("flexibility-5").with_changes(duration=300.0)
SIMULATIONS = [Simulation(k % 2, 7, k // 6, k % 3) for k in range(24)]


def counts(result):
    return np.stack([result.measures[name] for name in ("collected", "lost", "picked")], axis=1)


@pytest.fixture(scope="module")
def one_by_one():
    return np.concatenate([counts(evaluate(TABLES, SHORT, [s], workers=1)) for s in SIMULATIONS])


def test_results(one_by_one):
    result = evaluate(TABLES, SHORT, SIMULATIONS)
    assert list(result.measures) == ["picked", "collected", "lost"]
    assert {values.dtype for values in result.measures.values()} == {np.dtype(np.float64)}
    np.testing.assert_array_equal(result.fitness, result.measures["collected"])
    assert result.fitness.min() > 0
    assert len(set(result.fitness.tolist())) > 5
    np.testing.assert_array_equal(counts(result), one_by_one)


@given(st.permutations(range(24)), st.integers(1, 5), st.integers(1, 10**7))
@settings(max_examples=6, deadline=None)
def test_order_segments_and_workers_do_not_matter(one_by_one, order, workers, segment):
    before, batch._ROBOT_STEPS_PER_CALL = batch._ROBOT_STEPS_PER_CALL, max(segment, 10_000)
    try:
        result = evaluate(TABLES, SHORT, [SIMULATIONS[k] for k in order], workers=workers)
    finally:
        batch._ROBOT_STEPS_PER_CALL = before
    np.testing.assert_array_equal(counts(result), one_by_one[order])


@pytest.mark.parametrize("simulations", [1, 15, 16, 17, 63, 64, 65, 200, 300])
@pytest.mark.parametrize("workers", [1, 2, 3, 64])
def test_shares(simulations, workers):
    shares = [range(simulations)[share] for share in batch._shares(simulations, workers)]
    assert [number for share in shares for number in share] == list(range(simulations))
    assert all(0 < len(share) <= 64 for share in shares)
    assert all(len(share) % 16 == 0 for share in shares[:-1])


def test_neighbours_in_a_full_group_do_not_matter():
    scenario = SHORT.with_changes(duration=60.0)
    simulations = [Simulation(k % 2, k) for k in range(64)]
    together = counts(evaluate(TABLES, scenario, simulations, workers=1))
    backwards = counts(evaluate(TABLES, scenario, simulations[::-1], workers=1))
    narrow = counts(evaluate(TABLES, scenario, simulations[37:51], workers=1))
    np.testing.assert_array_equal(together, backwards[::-1])
    np.testing.assert_array_equal(together[37:51], narrow)


def test_large_swarms_run_one_by_one():
    scenario = SHORT.with_changes(robots=70, width=14.0, objects=40, duration=30.0)
    assert runs_side_by_side(SHORT)
    for unsuited in (
        scenario,
        SHORT.with_changes(objects=200),
        SHORT.with_changes(max_speed=3.0, turn_gain=20.0),
        SHORT.with_changes(max_speed=1e-4),
    ):
        assert not runs_side_by_side(unsuited)
    simulations = SIMULATIONS[:4]
    result = counts(evaluate(TABLES, scenario, simulations, workers=2))
    assert result[:, 2].min() > 0
    single = [counts(evaluate(TABLES, scenario, [simulation])) for simulation in simulations]
    np.testing.assert_array_equal(result, np.concatenate(single))


@pytest.mark.parametrize("rules", [0, 1])
def test_both_ways_of_running_collect_alike(rules, monkeypatch):
    simulations = [Simulation(rules, seed) for seed in range(120)]
    scenario = SHORT.with_changes(duration=1000.0)
    together = evaluate(TABLES, scenario, simulations)
    monkeypatch.setattr(batch, "runs_side_by_side", lambda _: False)
    apart = evaluate(TABLES, scenario, simulations)
    for name in ("collected", "picked"):
        one, other = together.measures[name], apart.measures[name]
        assert stats.ttest_ind(one, other).pvalue > 1e-3
        assert stats.ks_2samp(one, other).pvalue > 1e-3


def test_every_part_of_the_key_counts():
    keys = [(0, 1, 1, 1), (0, 2, 1, 1), (0, 1, 2, 1), (0, 1, 1, 2), (0, 2**62, 1, 1)]
    scenario = SHORT.with_changes(duration=2000.0)
    assert len(set(map(tuple, counts(evaluate(TABLES, scenario, keys))))) == len(keys)


def test_nothing_to_do():
    assert evaluate(TABLES, SHORT, []).fitness.shape == (0,)
    assert evaluate([], SHORT, []).measures["collected"].shape == (0,)


def test_robots_without_rules_only_walk():
    result = evaluate([ControlTable.compile(RuleSet())], SHORT, [(0, 1, 0, 0)])
    (counted,) = counts(result)
    assert counted[0] == counted[1] == 0
    assert 0 < counted[2] <= SHORT.robots


def test_stop_ends_it():
    stop = threading.Event()
    stop.set()
    for workers in (1, 2):
        with pytest.raises(EvaluationStopped):
            evaluate(TABLES, SHORT, SIMULATIONS, workers=workers, stop=stop.is_set)
    assert evaluate(TABLES, SHORT, SIMULATIONS[:2], stop=lambda: False).fitness.shape == (2,)


@pytest.mark.parametrize(
    ("simulations", "message"),
    [
        ([(0, 1, 0, 0), (2, 1, 0, 0)], r"simulations\[1\]: expected a table from 0 to 1, got 2"),
        ([(0, -1, 0, 0)], r"simulations\[0\]: expected seed, individual, replicate in"),
        ([(0, 2**63, 0, 0)], r"got \(9223372036854775808, 0, 0\)"),
        ([(0, 1)], r"got \(1,\)"),
    ],
)
def test_bad_simulations(simulations, message):
    with pytest.raises(ValueError, match=message):
        evaluate(TABLES, SHORT, simulations)


def test_bad_workers_and_vocabulary():
    with pytest.raises(ValueError, match="workers: expected at least 1, got 0"):
        evaluate(TABLES, SHORT, SIMULATIONS, workers=0)
    other = Vocabulary(
        FORAGING.preconditions, FORAGING.behaviours[::-1], FORAGING.internal_states, (), "x"
    )
    table = ControlTable(TABLES[0].probabilities, Space(other, (), (), ()))
    with pytest.raises(
        ValueError,
        match=r"tables\[1\]: expected the vocabulary of foraging, got one with RANDOM_WALK",
    ):
        evaluate([TABLES[0], table], SHORT, SIMULATIONS)


@pytest.mark.parametrize("robots", [5, 100])
def test_stop_ends_a_long_simulation(robots):
    asked = iter([False, False, True])
    scenario = SHORT.with_changes(robots=robots, width=20.0, duration=1e7)
    with pytest.raises(EvaluationStopped):
        evaluate(TABLES, scenario, SIMULATIONS[:1], workers=1, stop=lambda: next(asked))


def test_a_result_does_not_depend_on_what_else_is_evaluated():
    """Tables with few outcomes beside tables with many: each draws as if it were alone."""
    scenario = load_scenario("paper").with_changes(duration=300.0)
    many = parse_text(
        "rule do p = 0.1, PHOTOTAXIS do p = 0.1, RANDOM_WALK do p = 0.1, ANTI-PHOTOTAXIS "
        "do p = 0.5, DROP_OBJECT = true do p = 0.1, WANT_OBJECT = false "
        "do p = 0.1, WANT_OBJECT = true"
    )
    sets = [
        load_preset("hand-coded"),
        load_preset("evo8"),
        many,
        parse_text("rule do p = 1, PHOTOTAXIS"),
    ]
    tables = [ControlTable.compile(rule_set) for rule_set in sets]
    simulations = [(table, 3, 0, run) for table in range(len(tables)) for run in range(9)]
    together = evaluate(tables, scenario, simulations)
    for number, table in enumerate(tables):
        alone = evaluate([table], scenario, [(0, 3, 0, run) for run in range(9)])
        share = slice(9 * number, 9 * number + 9)
        np.testing.assert_array_equal(counts(alone), counts(together)[share])
