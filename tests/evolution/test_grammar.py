"""The grammar of a vocabulary: the paper's choice points, and every kind of term."""

from dataclasses import replace

import numpy as np
import pytest

from geswarm.evolution import rule_grammar
from geswarm.ge import Mapper, genome_of
from geswarm.rules import FORAGING, format_text, parse_text
from tests.rules.test_terms import GATHERING


def test_choice_points_are_the_papers():
    grammar = rule_grammar()
    assert grammar.warnings == ()
    assert {name: grammar.choices(name) for name in grammar.rules} == {
        "S": 1,
        "Rs": 2,
        "R": 1,
        "Ps": 2,
        "more-Ps": 2,
        "Bs": 2,
        "more-Bs": 2,
        "As": 2,
        "P": 2,
        "B": 1,
        "A": 2,
        "A_B": 1,
        "A_IS": 1,
        "new_value": 2,
        "P_name": 3,
        "B_name": 3,
        "IS_name": 2,
        "value": 8,
    }


@pytest.mark.parametrize(
    "vocabulary", [FORAGING, GATHERING, replace(GATHERING, internal_states=())]
)
def test_sentences_are_rule_sets_and_have_genomes(vocabulary):
    grammar, rng = rule_grammar(vocabulary), np.random.default_rng(1)
    assert grammar.warnings == ()
    mapper, found = Mapper(grammar), set()
    for _ in range(100):
        phenotype = mapper.map(rng.integers(0, 2**31, 200).tolist()).phenotype
        if phenotype is not None:
            rule_set = parse_text(phenotype, vocabulary=vocabulary)
            written = " ".join(format_text(rule_set).removeprefix('name ""').split())
            assert written == phenotype
            assert mapper.map(genome_of(grammar, written)).phenotype == phenotype
            found |= {entry.percept.name for rule in rule_set.rules for entry in rule.preconditions}
    assert found == set(vocabulary.percepts)
