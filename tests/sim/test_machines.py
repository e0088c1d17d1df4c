"""State machines with AutoMoDe's meaning, as control tables and as they run."""

import numpy as np
import pytest

from geswarm.automode import read_machines
from geswarm.automode.modules import crowded_chance
from geswarm.sim import evaluate, load_scenario, parts_of
from geswarm.sim.controllers.machines import instances_of, outcomes_of


def machine_of(text):
    (machine,) = read_machines(text)
    return machine


AAC = load_scenario("epuck-aac")
PARTS = parts_of(AAC)
TEXT = (
    "--nstates 3 --s0 0 --rwm0 4 --n0 2 --n0x0 0 --c0x0 0 --p0x0 0.3 --n0x1 1 --c0x1 5 --p0x1 0.2 "
    "--s1 1 --n1 1 --n1x0 1 --c1x0 3 --p1x0 2 --w1x0 1.5 --s2 4 --att2 4.6"
)


def code_of(floor, heard):
    return floor + 3 * heard


def test_outcomes_are_a_states_transitions_once_it_is_no_longer_new():
    machine = machine_of(TEXT)
    terms = instances_of(machine, PARTS)
    assert terms == tuple(s.behaviour.term for s in machine.states for _ in range(2))
    table = outcomes_of(machine, PARTS, 6).reshape(PARTS.codes, 6, 6, PARTS.states, 2)
    assert table.sum(axis=(2, 3, 4)) == pytest.approx(np.ones((PARTS.codes, 6)))
    # Just entered: nothing is looked at. Later: black and fixed, in both orders.
    for state in range(3):
        assert (table[:, 2 * state, 2 * state + 1, 0, 0] == 1.0).all()
    on_black, on_grey = code_of(1, 0), code_of(0, 0)
    assert table[on_black, 1, 2, 0, 1] == pytest.approx(0.3 * (1 + 0.8) / 2)
    assert table[on_black, 1, 4, 0, 1] == pytest.approx(0.2 * (1 + 0.7) / 2)
    assert table[on_grey, 1, [2, 4], 0, 1] == pytest.approx([0.0, 0.2])
    for heard in range(5):
        expected = crowded_chance(2, 1.5, heard)
        assert table[code_of(2, heard), 3, 4, 0, 1] == pytest.approx(expected)
    assert (table[:, 5, 5, 0, 0] == 1.0).all()


def test_behaviours_that_there_are_not_are_refused():
    aac = parts_of(load_scenario("aac"))
    with pytest.raises(ValueError, match="EXPLORATION is not on offer"):
        instances_of(machine_of("--nstates 1 --s0 0 --rwm0 5"), aac)


def test_results_do_not_depend_on_what_runs_beside():
    machines = [machine_of(TEXT), machine_of("--nstates 1 --s0 0 --rwm0 5")]
    short = AAC.with_changes(duration=20.0)
    runs = [(table, 4, 0, k) for k in range(20) for table in (0, 1)]
    together = evaluate(machines, short, runs, workers=2).fitness
    for table in (0, 1):
        alone = evaluate(machines[table : table + 1], short, [(0, 4, 0, k) for k in range(20)])
        np.testing.assert_array_equal(together[table::2], alone.fitness)
