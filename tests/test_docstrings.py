"""The examples in docstrings do what they say."""

import doctest

import pytest

import geswarm.ge
import geswarm.rules
import geswarm.rules.exports
import geswarm.rules.state_machine
import geswarm.sim


@pytest.mark.parametrize(
    "module",
    [
        geswarm.rules,
        geswarm.rules.exports,
        geswarm.rules.state_machine,
        geswarm.sim,
        geswarm.ge,
    ],
    ids=lambda module: module.__name__,
)
def test_docstring_examples_are_true(module):
    results = doctest.testmod(module)
    assert results.failed == 0 < results.attempted
