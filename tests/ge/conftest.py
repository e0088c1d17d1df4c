import pytest

from geswarm.evolution.grammar import geswarm_grammar
from geswarm.ge.grammar import Grammar
from geswarm.ge.mapping import Mapper

VOCABULARY = {
    "P_name": ["ON_NEST", "ON_SOURCE", "HAS_OBJECT"],
    "B_name": ["PHOTOTAXIS", "ANTI-PHOTOTAXIS", "RANDOM_WALK"],
    "IS_name": ["WANT_OBJECT", "DROP_OBJECT"],
    "value": ["0.001", "0.005", "0.01", "0.025", "0.05", "0.075", "0.1", "1.0"],
}


@pytest.fixture(scope="session")
def vocabulary() -> dict[str, list[str]]:
    return VOCABULARY


@pytest.fixture(scope="session")
def grammar() -> Grammar:
    return geswarm_grammar(VOCABULARY)


@pytest.fixture(scope="session")
def mapper(grammar) -> Mapper:
    return Mapper(grammar)
