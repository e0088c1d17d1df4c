"""Operators on the derivation tree: whatever they do, a sentence of the grammar comes out."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geswarm.ge.derivation import DerivationTrees, exact
from geswarm.ge.grammar import Grammar
from geswarm.ge.inverse import genome_of
from geswarm.ge.mapping import CODON_LIMIT, Mapper
from geswarm.ge.operators import random_genome
from tests.ge.test_mapping import grammars

seeds = st.integers(0, 2**32)
OPERATORS = ("redraw", "hoist", "insert")


def rng(seed=0):
    return np.random.default_rng(seed)


def is_exact(mapper, genome):
    """It maps without wrapping and every codon is read."""
    derivation = mapper.map(genome, 0)
    return derivation.phenotype is not None and derivation.used == len(genome)


def random_derivation(mapper, random):
    genome = random_genome(mapper, 300, random)
    return exact(genome, mapper.map(genome).used)


def is_codons(genome):
    return all(type(codon) is int and 0 <= codon < CODON_LIMIT for codon in genome)


@pytest.fixture(scope="module")
def trees(grammar):
    return DerivationTrees(grammar)


def sentence(mapper, genome):
    return mapper.map(genome, 0).phenotype


@given(genome=st.lists(st.integers(0, CODON_LIMIT - 1), min_size=1, max_size=40).map(tuple))
def test_exact_is_the_same_derivation_without_waste(mapper, genome):
    derivation = mapper.map(genome, 3)
    assume(derivation.phenotype is not None)
    lean = exact(genome, derivation.used)
    assert mapper.map(lean, 0) == derivation
    assert len(lean) == derivation.used


@given(grammar=grammars(), seed=seeds)
def test_operators_keep_genomes_valid_in_any_grammar(grammar, seed):
    mapper, trees, random = Mapper(grammar), DerivationTrees(grammar), rng(seed)
    parents = [tuple(trees.grow(grammar.start, 6, random)) for _ in range(2)]
    assume(all(1 <= len(parent) <= 300 for parent in parents))
    first, second = parents
    children = [getattr(trees, name)(first, random) for name in OPERATORS]
    children += [trees.swap(first, second, 400, random), trees.edit(first, 400, random)]
    for genome in (*parents, *children):
        assert is_codons(genome)
        assert is_exact(mapper, genome)


@given(seed=seeds, depth=st.integers(1, 12))
def test_a_rule_set_grows_to_the_depth(mapper, trees, seed, depth):
    genome = trees.grow_to(depth, rng(seed))
    assert is_exact(mapper, genome)
    deepest, depths = 0, {}
    for index, node in enumerate(trees.nodes(genome)):
        if not node.forced:
            depths[index] = depths.get(node.parent, 0) + 1
            deepest = max(deepest, depths[index])
    assert deepest >= depth
    assert deepest <= max(depth, 6)  # the shallowest rule set has some depth


@given(seed=seeds)
def test_nodes_are_the_derivation(mapper, trees, grammar, seed):
    genome = random_derivation(mapper, rng(seed))
    nodes = trees.nodes(genome)
    assert (nodes[0].name, nodes[0].begin, nodes[0].end) == ("S", 0, len(genome))
    choices = [node for node in nodes if not node.forced]
    assert [node.begin for node in choices] == list(range(len(genome)))
    for node in choices:
        assert node.alternative == genome[node.begin] % grammar.choices(node.name)
        parent = nodes[node.parent] if node.parent >= 0 else nodes[0]
        assert parent.begin <= node.begin < node.end <= parent.end


@given(seed=seeds)
def test_crossover_puts_a_stretch_of_the_other_in(mapper, trees, seed):
    random = rng(seed)
    first, second = (random_derivation(mapper, random) for _ in range(2))
    child = trees.swap(first, second, 1000, random)
    assert any(
        child == first[: a.begin] + second[b.begin : b.end] + first[a.end :]
        for a in trees.nodes(first)
        for b in trees.nodes(second)
        if a.name == b.name
    )


def test_too_long_children_are_refused(trees, grammar):
    long = genome_of(grammar, " ".join(["rule do p = 0.1, PHOTOTAXIS"] * 5))
    short = genome_of(grammar, "rule do p = 0.1, PHOTOTAXIS")
    for seed in range(50):
        assert len(trees.swap(short, long, len(short), rng(seed))) <= len(short)
        assert len(trees.edit(short, len(short), rng(seed))) <= len(short)


def test_redraw_keeps_what_still_fits(mapper, trees, grammar):
    text = "rule if ON_NEST == true do p = 0.1, PHOTOTAXIS do p = 0.05, DROP_OBJECT = true"
    genome = genome_of(grammar, text)
    changed = {sentence(mapper, trees.redraw(genome, rng(seed))) for seed in range(400)}
    assert text not in changed
    assert text.replace("0.1", "0.005") in changed  # a leaf
    assert text.replace("== true", "== false") in changed
    assert text.replace("if ON_NEST == true ", "") in changed  # a list that ends
    kept = [one for one in changed if one.startswith("rule if ON_NEST == true do p = 0.1, DROP")]
    assert kept  # another kind of action, with its probability


def test_hoist_removes_one_element_and_insert_adds_one(mapper, trees, grammar):
    rule = "rule if ON_NEST == {0} do p = 0.1, PHOTOTAXIS do p = {1}, RANDOM_WALK"
    rules = [rule.format("true", "0.05"), rule.format("false", "0.025")]
    genome = genome_of(grammar, " ".join(rules))
    shorter = {sentence(mapper, trees.hoist(genome, rng(seed))) for seed in range(200)}
    assert rules[1] in shorter
    assert " ".join([rules[0].replace("do p = 0.1, PHOTOTAXIS ", ""), rules[1]]) in shorter
    longer = {sentence(mapper, trees.insert(genome, rng(seed))) for seed in range(200)}
    assert any(one.endswith(" ".join(rules)) for one in longer)  # a rule in front
    assert any(one.count("rule") == 3 for one in longer)
    assert all(len(one) > len(" ".join(rules)) for one in longer)


def test_redraw_goes_to_the_next_number_more_often(mapper, trees, grammar):
    text = "rule do p = {}, PHOTOTAXIS"
    genome = genome_of(grammar, text.format("0.025"))
    drawn = [sentence(mapper, trees.redraw(genome, rng(seed))) for seed in range(4000)]
    counts = {p: drawn.count(text.format(p)) for p in ("0.001", "0.01", "0.05", "1")}
    # Half of the time one of 2, half of the time one of 7: 9 to 2.
    assert counts["0.01"] + counts["0.05"] > 3 * (counts["0.001"] + counts["1"])
    assert all(counts.values())


def test_a_grammar_without_choices_has_nothing_to_vary():
    trees = DerivationTrees(Grammar.parse("<s> ::= a <b>\n<b> ::= c"))
    assert trees.grow_to(5, rng()) == (0,)
    for name in OPERATORS:
        assert getattr(trees, name)((0,), rng()) == (0,)
    assert trees.swap((0,), (0,), 10, rng()) == (0,)


def test_explosive_grammars_grow_to_bounded_depth():
    grammar = Grammar.parse("<e> ::= <e> <e> <e> | <e> <e> | x")
    genomes = [DerivationTrees(grammar).grow("e", 4, rng(seed)) for seed in range(50)]
    assert max(map(len, genomes)) <= 3**4
