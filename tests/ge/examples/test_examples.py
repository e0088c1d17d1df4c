"""The engine solves what has nothing to do with robots."""

import pytest

from geswarm.ge import Grammar, Mapper, genome_of
from tests.ge.examples import ant, regression


def test_the_trail_is_koza_s():
    assert len(ant.FOOD) == 89
    solution = (
        "if food { move } else { left if food { move } else { right right "
        "if food { move } else { left move } } }"
    )
    grammar = Grammar.load(ant.GRAMMAR)
    assert Mapper(grammar).map(genome_of(grammar, solution)).phenotype == solution
    assert ant.food_eaten(solution) == 89
    assert ant.food_eaten("move") == 3


def test_formulas_are_joined_as_the_grammar_says():
    grammar = Grammar.load(regression.GRAMMAR)
    formula = "((2.5 * (x * x)) - 0.7)"
    assert Mapper(grammar).map(genome_of(grammar, formula)).phenotype == formula
    assert regression.fitness(formula) == pytest.approx(1.0)


@pytest.mark.slow
@pytest.mark.long
def test_the_ant_finds_all_food():
    best, generations = ant.solve(seed=0)
    assert best.fitness == 89
    assert generations < 40


@pytest.mark.slow
@pytest.mark.long
def test_the_formula_is_found():
    best, generations = regression.solve(seed=0)
    assert best.fitness == pytest.approx(1.0)
    assert generations < 60
