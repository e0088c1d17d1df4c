import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from geswarm.ge.grammar import Grammar
from geswarm.ge.mapping import CODON_LIMIT, Mapper
from geswarm.ge.operators import (
    INITIAL_CODONS,
    mutate,
    random_genome,
    roulette,
    single_point_crossover,
)

genomes = st.lists(st.integers(0, CODON_LIMIT - 1), min_size=1, max_size=50).map(tuple)
seeds = st.integers(0, 2**32)


def rng(seed=0):
    return np.random.default_rng(seed)


@given(seed=seeds)
def test_a_random_genome_is_a_derivation_and_a_tail(mapper, seed):
    genome = random_genome(mapper, 1000, rng(seed))
    phenotype, used = mapper.map(genome, 0)
    assert phenotype is not None
    assert len(genome) == max(used, INITIAL_CODONS)
    assert len(random_genome(mapper, 50, rng(seed))) <= 50


def test_random_derivations_have_the_papers_number_of_rules(mapper):
    # Production 2 continues the list with probability 1/2: two rules on average.
    random = rng(3)
    phenotypes = [mapper.map(random_genome(mapper, 1000, random)).phenotype for _ in range(2000)]
    rules = [phenotype.split().count("rule") for phenotype in phenotypes]
    assert np.mean(rules) == pytest.approx(2.0, abs=4 * np.sqrt(2 / 2000))


def test_a_grammar_that_grows_without_end_is_refused():
    mapper = Mapper(
        Grammar.parse("<s> ::= <s> <s> <s> <s> <s> | <s> <s> <s> | <t>\n<t> ::= x <s> | y")
    )
    with pytest.raises(ValueError, match="within 3 choices") as caught:
        random_genome(Mapper(Grammar.parse("<s> ::= <b> <b> <b> <b>\n<b> ::= 0 | 1")), 3, rng())
    assert "larger max_codons" in str(caught.value)
    assert random_genome(mapper, 1000, rng())


@given(first=genomes, second=genomes, seed=seeds, limit=st.integers(1, 120))
def test_crossover_exchanges_tails(first, second, seed, limit):
    children = single_point_crossover(first, second, limit, rng(seed))
    assert all(1 <= len(child) <= limit for child in children)
    points = [
        (a, b)
        for a in range(len(first))
        for b in range(len(second))
        if children == ((first[:a] + second[b:])[:limit], (second[:b] + first[a:])[:limit])
    ]
    assert points
    if limit >= len(first) + len(second):
        assert sorted(children[0] + children[1]) == sorted(first + second)


@given(genome=genomes, seed=seeds, rate=st.floats(0, 1))
def test_mutation_keeps_codons_valid(genome, seed, rate):
    mutant = mutate(genome, rate, rng(seed))
    assert len(mutant) == len(genome)
    assert all(type(codon) is int and 0 <= codon < CODON_LIMIT for codon in mutant)
    assert mutate(genome, 0.0, rng(seed)) == genome


def test_mutation_rate_is_per_codon_over_the_whole_chromosome():
    genome, random = (0,) * 200, rng(5)
    changed = np.zeros(200)
    for _ in range(2000):
        changed += np.array(mutate(genome, 0.05, random)) != 0
    assert stats.binomtest(int(changed.sum()), 200 * 2000, 0.05).pvalue > 1e-4
    assert stats.chisquare(changed).pvalue > 1e-4


def test_roulette_is_proportional_to_fitness():
    fitness = [0, 1, 2, 3, 0, 10, 0.5, 0]
    counts = np.bincount(roulette(fitness, 50_000, rng(7)), minlength=8)
    assert counts[[0, 4, 7]].sum() == 0
    shares = np.array([1, 2, 3, 10, 0.5])
    assert stats.chisquare(counts[[1, 2, 3, 5, 6]], shares / shares.sum() * 50_000).pvalue > 1e-4


def test_roulette_without_any_fitness_is_uniform():
    counts = np.bincount(roulette([0.0] * 5, 20_000, rng(8)), minlength=5)
    assert stats.chisquare(counts).pvalue > 1e-4


@pytest.mark.parametrize("fitness", [[float("nan"), 1], [1, float("inf")], [-float("inf"), 1]])
def test_roulette_refuses_what_is_no_share(fitness):
    with pytest.raises(ValueError, match=r"fitness\[\d\]: expected a finite number, got"):
        roulette(fitness, 1, rng())


def test_roulette_of_losses_counts_from_the_greatest_one():
    fitness = [-4.0, -1.0, -3.0, -4.0, 2.0]
    counts = np.bincount(roulette(fitness, 50_000, rng(9)), minlength=5)
    assert counts[[0, 3]].sum() == 0
    shares = np.array([3.0, 1.0, 6.0])
    assert stats.chisquare(counts[[1, 2, 4]], shares / shares.sum() * 50_000).pvalue > 1e-4
    assert set(roulette([-2.0] * 3, 100, rng(9))) == {0, 1, 2}


def test_roulette_of_nobody():
    with pytest.raises(ValueError, match="at least one"):
        roulette([], 1, rng())


@given(fitness=st.lists(st.floats(0, 1e300), min_size=1, max_size=20), seed=seeds)
def test_roulette_never_draws_a_zero_among_others(fitness, seed):
    drawn = roulette(fitness, 20, rng(seed))
    assert all(0 <= index < len(fitness) for index in drawn)
    if any(fitness):
        assert all(fitness[index] > 0 for index in drawn)


@given(fitness=st.lists(st.floats(-1e308, 1e308), min_size=1, max_size=20), seed=seeds)
def test_roulette_draws_of_any_fitness_and_never_the_worst(fitness, seed):
    drawn = roulette(fitness, 20, rng(seed))
    least = min(0.0, *fitness)
    if max(fitness) > least:
        assert all(fitness[index] > least for index in drawn)
