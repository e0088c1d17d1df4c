"""Ranking under noise: how much there is, and whom it puts behind whom."""

import numpy as np
import pytest

from geswarm.ge.individual import Individual
from geswarm.ge.ranking import CODON_COST, noise_of, ranked


def individual(key, fitness, told, used=10):
    return Individual(1, key, (0,), "s", used, fitness=fitness, told=told)


@pytest.mark.parametrize("told", [1, 5, 40])
@pytest.mark.parametrize("deviation", [0.0, 11.0])
def test_the_noise_follows_from_evaluating_again(told, deviation):
    rng = np.random.default_rng(1)
    worth = rng.normal(100, 20, 2000)
    means = worth + rng.normal(0, deviation / np.sqrt(told), 2000)
    before = [individual(key, mean, told) for key, mean in enumerate(means)]
    values = (worth + rng.normal(0, deviation, 2000)).tolist()
    assert noise_of(before, values) == pytest.approx(deviation, rel=0.05)


def test_without_evaluations_there_is_no_noise():
    assert noise_of([], []) == 0.0


def test_few_evaluations_count_less_than_many():
    lucky, proven, better = (
        individual(*one) for one in ((0, 118.0, 1), (1, 110.0, 25), (2, 125, 1))
    )
    order = ranked([lucky, proven, better], noise=11.0, parsimony=False)
    assert [one.key for one in order] == [2, 1, 0]
    order = ranked([lucky, proven, better], noise=0.0, parsimony=False)
    assert [one.key for one in order] == [2, 0, 1]


def test_codons_have_their_price_under_parsimony():
    small = individual(0, 100.0, 1, used=10)
    large = individual(1, 100.0 + 150 * CODON_COST * 100, 1, used=210)
    assert ranked([small, large], 0.0, parsimony=True)[0] is small
    assert ranked([small, large], 0.0, parsimony=False)[0] is large
    twin = individual(2, 100.0, 1, used=9)
    assert ranked([small, twin], 0.0, parsimony=True)[0] is twin
    assert ranked([small, twin], 0.0, parsimony=False)[0] is small


def test_codons_cost_losers_too():
    small, large = individual(0, -100.0, 1, used=10), individual(1, -100.0, 1, used=210)
    assert ranked([large, small], 0.0, parsimony=True)[0] is small
    better = individual(2, -100.0 + 150 * CODON_COST * 100, 1, used=210)
    assert ranked([better, small], 0.0, parsimony=True)[0] is small
    assert ranked([better, small], 0.0, parsimony=False)[0] is better
