import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.rules import FORAGING, ControlTable, RuleSet, Vocabulary, load_preset
from geswarm.sim import batch
from geswarm.sim.batch import EvaluationStopped, Simulation, evaluate
from geswarm.sim.scenario import load_scenario

TABLES = [ControlTable.compile(load_preset(name)) for name in ("hand-coded", "evo8")]
SHORT = load_scenario("flexibility-5").with_changes(duration=300.0)
SIMULATIONS = [Simulation(k % 2, 7, k // 6, k % 3) for k in range(24)]


def counts(result):
    return np.stack([result.collected, result.lost, result.picked], axis=1)


@pytest.fixture(scope="module")
def one_by_one():
    return np.concatenate([counts(evaluate(TABLES, SHORT, [s], workers=1)) for s in SIMULATIONS])


def test_results(one_by_one):
    result = evaluate(TABLES, SHORT, SIMULATIONS)
    assert result.collected.dtype == result.lost.dtype == result.picked.dtype == np.int64
    assert result.collected.min() > 0
    assert len(set(result.collected.tolist())) > 5
    np.testing.assert_array_equal(counts(result), one_by_one)


@given(st.permutations(range(24)), st.integers(1, 5), st.integers(1, 10**7))
@settings(max_examples=6)
def test_order_split_and_workers_do_not_matter(one_by_one, order, workers, chunk):
    before, batch._CHUNK_ROBOT_STEPS = batch._CHUNK_ROBOT_STEPS, chunk
    try:
        result = evaluate(TABLES, SHORT, [SIMULATIONS[k] for k in order], workers=workers)
    finally:
        batch._CHUNK_ROBOT_STEPS = before
    np.testing.assert_array_equal(counts(result), one_by_one[order])


def test_every_part_of_the_key_counts():
    keys = [(0, 1, 1, 1), (0, 2, 1, 1), (0, 1, 2, 1), (0, 1, 1, 2), (0, 2**62, 1, 1)]
    scenario = SHORT.with_changes(duration=2000.0)
    assert len(set(map(tuple, counts(evaluate(TABLES, scenario, keys))))) == len(keys)


def test_nothing_to_do():
    assert evaluate(TABLES, SHORT, []).collected.shape == (0,)
    assert evaluate([], SHORT, []).collected.shape == (0,)


def test_robots_without_rules_only_walk():
    result = evaluate([ControlTable.compile(RuleSet())], SHORT, [(0, 1, 0, 0)])
    assert result.collected[0] == result.lost[0] == 0
    assert 0 < result.picked[0] <= SHORT.robots


def test_stop_ends_it():
    stop = threading.Event()
    stop.set()
    for workers in (1, 2):
        with pytest.raises(EvaluationStopped):
            evaluate(TABLES, SHORT, SIMULATIONS, workers=workers, stop=stop.is_set)
    asked = iter([False, False, True, True, True, True])
    with pytest.raises(EvaluationStopped):
        evaluate(TABLES, SHORT, SIMULATIONS, workers=1, stop=lambda: next(asked))
    assert evaluate(TABLES, SHORT, SIMULATIONS[:2], stop=lambda: False).picked.shape == (2,)


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
    table = ControlTable(TABLES[0].probabilities, other)
    with pytest.raises(ValueError, match=r"tables\[1\]: expected the foraging vocabulary"):
        evaluate([TABLES[0], table], SHORT, SIMULATIONS)
