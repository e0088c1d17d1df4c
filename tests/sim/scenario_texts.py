"""Scenario files as texts, and what is told about them."""

import pytest
import yaml

from geswarm.sim.scenario.model import ScenarioError, parse_scenario

PLAIN = """
extends: nothing
robots: 3
duration: 10
preconditions: []
behaviours: [STOP]
measures: [idle]
objective: idle
"""


def arena(text, **more):
    tree = yaml.safe_load(PLAIN) | {"arena": yaml.safe_load(text)} | more
    return parse_scenario(yaml.safe_dump(tree), "mine").arena


def messages(text):
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(text, "mine")
    return [str(finding) for finding in caught.value.findings]


def why_not(arena_text, **more):
    tree = yaml.safe_load(PLAIN) | more
    text = f"arena: {arena_text}\n{yaml.safe_dump(tree)}"
    message, *_ = messages(text)
    assert message.startswith("mine:")
    return message.split(": ", 1)[1]
