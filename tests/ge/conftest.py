import pytest

from geswarm.evolution import rule_grammar
from geswarm.ge.grammar import Grammar
from geswarm.ge.mapping import Mapper


@pytest.fixture(scope="session")
def grammar() -> Grammar:
    """One with everything that grammars have: the paper's."""
    return rule_grammar()


@pytest.fixture(scope="session")
def mapper(grammar) -> Mapper:
    return Mapper(grammar)
