"""What machines and trees do in a step, against other ways to work it out."""

from fractions import Fraction
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.automode import (
    START,
    Situation,
    Ticked,
    next_situations,
    read_machines,
    read_trees,
    tick,
)
from geswarm.automode.modules import FLOORS, crowded_chance
from geswarm.automode.steps import first_true
from tests.automode.machines import AAC, machines, trees

fractions = st.fractions(0, 1, max_denominator=12)


def by_priorities(chances):
    """Each condition draws a priority from [0, 1]: the true one with the least is the first.

    It is so with p times the integral of the probability that no other is true and before it.
    """
    found = {}
    for at, (target, p) in enumerate(chances):
        polynomial = [Fraction(1)]
        for other, (_, q) in enumerate(chances):
            if other != at:  # times (1 - q t)
                shifted = [Fraction(0), *(-q * each for each in polynomial)]
                polynomial = [
                    a + b for a, b in zip([*polynomial, Fraction(0)], shifted, strict=True)
                ]
        area = sum(each / (k + 1) for k, each in enumerate(polynomial))
        found[target] = found.get(target, Fraction(0)) + p * area
    return {target: p for target, p in found.items() if p}


@given(st.lists(st.tuples(st.integers(0, 3), fractions), max_size=4))
def test_a_random_order_is_a_random_priority_of_each(chances):
    assert first_true(chances, permutations(range(len(chances)))) == by_priorities(chances)


def test_two_conditions():
    (machine,) = read_machines(AAC)
    a, b = Fraction(1, 4), Fraction(1, 3)
    chance = {2: a, 3: b}
    found = next_situations(machine, Situation(1, False), lambda each: chance[each.number])
    assert found == {
        Situation(0, True): a * (1 - b / 2),
        Situation(2, True): b * (1 - a / 2),
        Situation(1, False): (1 - a) * (1 - b),
    }


@given(machines(), st.sampled_from(FLOORS), st.integers(0, 25))
def test_nothing_is_looked_at_in_the_first_step(machine, floor, neighbours):
    for number in range(len(machine.states)):
        here = Situation(number, True)
        found = next_situations(machine, here, lambda each: each.chance(floor, neighbours))
        assert found == {Situation(number, False): 1}
    assert Situation(0, True) == START


@given(machines(), st.sampled_from(FLOORS), st.integers(0, 25))
def test_distributions_sum_to_one(machine, floor, neighbours):
    for number in range(len(machine.states)):
        here = Situation(number, False)
        found = next_situations(machine, here, lambda each: each.chance(floor, neighbours))
        assert sum(found.values()) == pytest.approx(1)
        assert all(p > 0 for p in found.values())


def test_neighbour_counts():
    assert crowded_chance(3, 2, 3) == 0.5
    assert crowded_chance(3.9, 2, 3) == 0.5  # AutoMoDe keeps xi in a whole number
    assert crowded_chance(10, 20, 0) == pytest.approx(1.4e-87, rel=0.02)
    assert crowded_chance(1, 20, 60) == 1
    (machine,) = read_machines(AAC)
    inverted = machine.states[2].transitions[0].condition
    assert inverted.chance("grey", 3) == 1 - crowded_chance(2, 10, 3)


def ticked(text, memory=(), obstacle=False, **chances):
    """By the numbers of the behaviours that are executed (-1: none) and the memory."""
    (tree,) = read_trees(text)
    found = tick(tree, memory, lambda each: Fraction(str(each.p)), obstacle)
    return {
        (-1 if each.executed is None else each.executed.number, each.memory): p
        for each, p in found.items()
    }


def leaf(name, behaviour, success="0"):
    return f"--n{name} 5 --a{name} {behaviour} --p{name} {success}"


def check(name, p):
    return f"--n{name} 6 --c{name} 5 --p{name} {p}"


def test_a_selector_asks_until_one_does_not_fail():
    text = f"--nroot 0 --nchildroot 2 {check(0, 0.25)} {leaf(1, 2)}"
    assert ticked(text) == {(-1, ()): Fraction(1, 4), (2, ()): Fraction(3, 4)}


def test_a_sequence_asks_until_one_does_not_succeed():
    text = f"--nroot 2 --nchildroot 3 {check(0, 0.25)} {leaf(1, 2, '0.5')} {leaf(2, 3)}"
    assert ticked(text) == {
        (-1, ()): Fraction(3, 4),
        (2, ()): Fraction(1, 8),
        (3, ()): Fraction(1, 8),
    }


def test_nodes_with_a_star_go_on_where_they_were():
    text = f"--nroot 3 --nchildroot 3 {check(0, 0.25)} {leaf(1, 2, '0.5')} {leaf(2, 3)}"
    assert ticked(text)[2, (((), 1),)] == Fraction(1, 8)
    assert ticked(text, memory=(((), 1),)) == {
        (2, (((), 1),)): Fraction(1, 2),
        (3, (((), 2),)): Fraction(1, 2),
    }


def test_a_star_is_remembered_while_another_branch_runs():
    inner = f"--n1 3 --nchild1 2 {leaf('10', 2, '0.5')} {leaf('11', 3)}"
    text = f"--nroot 0 --nchildroot 2 --n0 2 --nchild0 2 {check('00', 0.5)} {leaf('01', 1)} {inner}"
    before = (((1,), 1),)
    assert ticked(text, before) == {(1, before): Fraction(1, 2), (3, before): Fraction(1, 2)}


def test_a_selector_with_a_star_has_succeeded_where_all_failed():
    failing = f"{check('00', 0)} {check('01', 0)}"
    star = f"--nroot 2 --nchildroot 2 --n0 1 --nchild0 2 {failing} {leaf(1, 4)}".replace(
        "--a1 4", "--a1 4 --att1 2"
    )
    assert ticked(star) == {(4, ()): 1}
    assert ticked(star.replace("--n0 1", "--n0 0")) == {(-1, ()): 1}


def test_negation_and_obstacles():
    text = f"--nroot 2 --nchildroot 2 --n0 4 --nchild0 1 {check('00', 0.25)} {leaf(1, 6)}"
    assert ticked(text) == {(-1, ()): Fraction(1, 4), (6, ()): Fraction(3, 4)}
    assert ticked(text, obstacle=True) == {(-1, ()): 1}
    running = f"--nroot 4 --nchildroot 1 {leaf(0, 7)}"
    assert ticked(running, obstacle=True) == {(7, ()): 1}


@given(trees, st.booleans())
def test_ticks_sum_to_one_and_remember_what_there_is(tree, obstacle):
    memories = {()}
    for _ in range(2):
        for memory in list(memories)[:3]:
            found = tick(tree, memory, lambda _: 0.5, obstacle)
            assert sum(found.values()) == pytest.approx(1)
            assert all(isinstance(each, Ticked) for each in found)
            memories |= {each.memory for each in found}
