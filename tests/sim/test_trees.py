"""Behaviour trees as control tables and as they run."""

from collections import defaultdict
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.automode import (
    Action,
    Behaviour,
    Check,
    Control,
    Tree,
    read_machines,
    read_trees,
    tick,
)
from geswarm.automode.modules import FLOORS
from geswarm.evaluation import evaluate_rule_sets
from geswarm.sim import evaluate, load_scenario, parts_of
from geswarm.sim.controllers.machines import ControllerError, chance_of
from geswarm.sim.controllers.trees import instances_of, outcomes_of
from tests.automode.machines import behaviours, conditions

AAC = load_scenario("epuck-aac")
PARTS = parts_of(AAC)
FLOOR_VALUES = {"grey": 0, "black": 1, "white": 2}
RESTS = (  # on black with 0.5 it rests, and goes on by chance; else it explores
    "--nroot 3 --nchildroot 1 --n0 0 --nchild0 2 "
    "--n00 3 --nchild00 2 --n000 6 --c000 0 --p000 0.5 --n001 5 --a001 1 --p001 0.05 "
    "--n01 5 --a01 0 --rwm01 5 --p01 0"
)


LEAVES = st.one_of(
    st.builds(Action, behaviours, st.sampled_from([0.0, 0.25, 1.0])), st.builds(Check, conditions)
)


def controls(nodes):
    several = st.lists(nodes, min_size=1, max_size=3).map(tuple)
    return st.one_of(
        st.builds(Control, st.sampled_from(range(4)), several),
        st.builds(Control, st.just(4), st.tuples(nodes)),
    )


TREES = st.builds(Tree, controls(st.recursive(LEAVES, controls, max_leaves=6)))


def tree_of(text):
    (tree,) = read_trees(text)
    return tree


def code_of(floor, heard):
    return FLOOR_VALUES[floor] + 3 * heard


def by_ticks(tree, readings):
    """How probable each sequence of behaviours is, from the tree alone."""
    ways = {((), ()): 1.0}
    for floor, heard in readings:
        found = defaultdict(float)
        chance = partial(chance_of, floor, heard)
        for (path, memory), p in ways.items():
            for then, share in tick(tree, memory, chance).items():
                does = str(then.executed.term) if then.executed else "STOP"
                found[(*path, does), then.memory] += p * float(share)
        ways = found
    return sequences(ways)


def by_table(tree, readings):
    terms = instances_of(tree, PARTS)
    number = len(terms)
    table = outcomes_of(tree, PARTS, number).reshape(PARTS.codes, number, number, PARTS.states, 2)
    assert table.sum(axis=(2, 3, 4))[:, : number - 1] == pytest.approx(1.0) or number == 1
    ways = {((), PARTS.first_instance): 1.0}
    for floor, heard in readings:
        found = defaultdict(float)
        for (path, here), p in ways.items():
            row = table[code_of(floor, heard), here].sum(axis=(1, 2))
            for to in np.nonzero(row)[0]:
                found[(*path, str(terms[to])), int(to)] += p * row[to]
        ways = found
    return sequences(ways)


def sequences(ways):
    found = defaultdict(float)
    for (path, _), p in ways.items():
        found[path] += p
    return found


@settings(max_examples=40)
@given(TREES, st.data())
def test_a_table_does_what_ticks_do(tree, data):
    try:
        instances_of(tree, PARTS)
    except ControllerError as error:
        assert "at most 32 different pairs" in str(error)
        return
    reading = st.tuples(st.sampled_from(FLOORS), st.integers(0, 6))
    readings = data.draw(st.lists(reading, min_size=3, max_size=3))
    wanted, found = by_ticks(tree, readings), by_table(tree, readings)
    for path in wanted.keys() | found.keys():
        assert found[path] == pytest.approx(wanted[path], abs=1e-9)


def test_memory_and_behaviour_are_an_instance():
    tree = tree_of(RESTS)
    terms = sorted(map(str, instances_of(tree, PARTS)))
    assert terms == ["EXPLORATION(5)", "STOP", "STOP"]  # the start, resting, exploring
    readings = [("grey", 0), ("black", 0), ("white", 0)]
    found = by_table(tree, readings)
    # It rests, or has succeeded with that and executes nothing, which is to stand, too.
    assert found["EXPLORATION(5)", "STOP", "STOP"] == pytest.approx(0.5 * 0.95)
    assert dict(found) == pytest.approx(dict(by_ticks(tree, readings)))


def test_a_behaviour_starts_afresh_after_another_one():
    tree = tree_of(RESTS)
    terms = instances_of(tree, PARTS)
    number = len(terms)
    table = outcomes_of(tree, PARTS, number).reshape(PARTS.codes, number, number, PARTS.states, 2)
    for here in range(number):
        for to in range(number):
            stays = table[:, here, to].sum(axis=(0, 1))
            if terms[here] != terms[to]:
                assert stays[0] == 0.0


def test_trees_and_machines_that_explore_do_the_same():
    (tree,) = read_trees("--nroot 0 --nchildroot 1 --n0 5 --a0 0 --rwm0 5 --p0 0")
    (machine,) = read_machines("--nstates 1 --s0 0 --rwm0 5")
    short = AAC.with_changes(duration=60.0)
    one, other = evaluate_rule_sets([tree, machine], short, runs=64, seed=3)
    error = np.hypot(one.fitness.std(), other.fitness.std()) / 8
    assert abs(one.mean - other.mean) < 3.0 * error


def test_results_do_not_depend_on_what_runs_beside():
    both = [tree_of(RESTS), *read_machines("--nstates 1 --s0 0 --rwm0 5")]
    short = AAC.with_changes(duration=10.0)
    runs = [(table, 4, 0, k) for k in range(6) for table in (0, 1)]
    together = evaluate(both, short, runs, workers=2).fitness
    for table in (0, 1):
        alone = evaluate(both[table : table + 1], short, [(0, 4, 0, k) for k in range(6)])
        np.testing.assert_array_equal(together[table::2], alone.fitness)


def test_what_comes_to_too_much_is_told():
    steps = tuple(Action(Behaviour(4, 1.0 + k / 10), 0.5) for k in range(4))
    remembers = Control(3, steps)
    with pytest.raises(ControllerError, match="at most 32 different pairs of memory and behaviour"):
        instances_of(Tree(Control(2, (remembers,) * 4)), PARTS)
