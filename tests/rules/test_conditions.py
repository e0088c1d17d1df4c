from itertools import chain, combinations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.rules.conditions import Condition, minimise

NAMES = ("A", "B", "C")
POINTS = range(8)


def percepts(point):
    return {name: bool(point >> bit & 1) for bit, name in enumerate(NAMES)}


def points_where(condition):
    return {point for point in POINTS if condition.holds(percepts(point))}


EVERY_TERM = [
    tuple((name, value) for name, value in zip(NAMES, values, strict=True) if value is not None)
    for values in product((None, False, True), repeat=3)
]


def shortest(holds, free):
    """(terms, literals) of the shortest expression, by trying them all."""
    fitting = [t for t in EVERY_TERM if points_where(Condition((t,))) <= holds | free]
    fitting = [t for t in fitting if not any(set(other) < set(t) for other in fitting)]  # no need
    sizes = chain.from_iterable(combinations(fitting, size) for size in range(5))
    found = [t for t in sizes if holds <= points_where(Condition(t))]
    fewest = min(map(len, found))
    return min((len(terms), sum(map(len, terms))) for terms in found if len(terms) == fewest)


@given(st.lists(st.sampled_from(["holds", "fails", "free"]), min_size=8, max_size=8))
def test_conditions_are_right_and_shortest(kinds):
    holds = {point for point in POINTS if kinds[point] == "holds"}
    free = {point for point in POINTS if kinds[point] == "free"}
    fails = set(POINTS) - holds - free
    condition = minimise(sorted(holds), fails, NAMES)
    assert holds <= points_where(condition) <= holds | free
    length = (len(condition.terms), sum(map(len, condition.terms)))
    assert length == shortest(holds, free)
    assert condition == minimise(sorted(holds, reverse=True), fails, NAMES)


@pytest.mark.parametrize(
    ("holds", "free", "expected"),
    [
        ([], [], "never"),
        ([0, 1, 2, 3, 4, 5, 6, 7], [], "always"),
        ([5], [1, 3, 6, 7], "A"),
        ([4, 6], [3, 7], "C and not A"),
        ([0], [], "not A and not B and not C"),
        ([1, 2, 3], [], "A and not C or B and not C"),
    ],
)
def test_conditions_in_words(holds, free, expected):
    fails = set(POINTS) - {*holds, *free}
    assert str(minimise(holds, fails, NAMES)) == expected


def test_thresholds_are_denied_as_people_write_it():
    names = ("NEIGHBOURS >= 3", "COLOUR == red")
    assert str(minimise([0], [1, 2, 3], names)) == "NEIGHBOURS < 3 and COLOUR != red"


@given(st.sets(st.integers(0, 2**12 - 1), max_size=60), st.sets(st.integers(0, 2**12 - 1)))
def test_conditions_over_many_names_are_right(holds, fails):
    names = tuple(f"N{bit}" for bit in range(12))
    condition = minimise(holds, fails - holds, names)
    for point in holds | fails:
        values = {name: bool(point >> bit & 1) for bit, name in enumerate(names)}
        assert condition.holds(values) == (point in holds)
