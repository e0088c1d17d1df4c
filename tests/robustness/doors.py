"""Every way into GESwarm by text or values: what goes in, what may come back.

A call takes one input and either returns or raises one of the allowed errors; whatever it checks
besides, it asserts.
"""

import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from hypothesis import strategies as st

from geswarm.app.panels.scenario_panel import VALUES
from geswarm.app.protocol.base import Request
from geswarm.app.protocol.pages import reader_of
from geswarm.app.protocol.reading import MessageError
from geswarm.evolution import RunConfig, RunConfigError
from geswarm.ge import Grammar, GrammarError, Mapper, Settings
from geswarm.rules import (
    FORMATS,
    ControlTable,
    RuleSetError,
    describe,
    format_json,
    format_text,
    format_yaml,
    load_preset,
    parse_text,
    read_rule_set,
)
from geswarm.rules.as_json import rule_set_to_json
from geswarm.sim import ScenarioError, load_scenario, parse_scenario, vocabulary_of
from geswarm.sim.controllers.encoding import scenario_numbers
from geswarm.sim.library.catalogue import catalogue
from geswarm.sim.scenario.checks import PARAMETERS
from geswarm.sim.scenario.words import WORDS
from tests.robustness import mutations
from tests.strategies import documented_rule_sets

EVO8 = load_preset("evo8")
PAPER = load_scenario("paper")
MINE = parse_text("""# my rules
name "mine"
origin run "runs/1", generation 3, fitness 1.5
# first
rule off if ON_NEST == false while RANDOM_WALK do p = 0.3, PHOTOTAXIS
""")
RULE_SETS = (EVO8, load_preset("hand-coded"), MINE)


class RefusedError(Exception):
    """The door said no in its own way, which is no exception."""


@dataclass(frozen=True)
class Door:
    """One way in.

    Attributes:
        name: For the report.
        call: Takes one input.
        allowed: What it may raise.
        raw: Makes an input from a random number generator, knowing nothing or an example.
        structured: Makes inputs of about the right shape.
        share: Of the inputs of the long run; less where each takes long.
    """

    name: str
    call: Callable[[Any], None]
    allowed: tuple[type[Exception], ...]
    raw: Callable[[Any], Any]
    structured: st.SearchStrategy[Any] = field(repr=False)
    share: float = 1.0


def text_inputs(*examples):
    """Random text now and then, else an example with something wrong."""

    def make(rng):
        if rng.random() < 0.2:
            return mutations.random_text(rng)
        if rng.random() < 0.1:
            return mutations.random_bytes(rng).decode("utf-8", "surrogateescape")
        return mutations.mutated_text(rng, examples)

    return make


def value_inputs(*examples):
    """Examples with values of another shape."""
    return lambda rng: json.dumps(mutations.mutated_value(rng, rng.choice(examples)))


def read_rules(suffix):
    def call(text):
        rule_set = read_rule_set(text, f"mine{suffix}")
        for write in FORMATS.values():
            assert read_rule_set(write(rule_set)) == rule_set
        json.dumps(rule_set_to_json(rule_set), allow_nan=False)
        assert len(describe(rule_set)) == len(rule_set.rules)
        assert np.isfinite(ControlTable.compile(rule_set).probabilities).all()

    return call


def read_grammar(text):
    grammar = Grammar.parse(text)
    mapper = Mapper(grammar)
    for genome in ((0,), (1, 2, 3, 5, 7, 11, 13), tuple(range(50))):
        phenotype, used = mapper.map(genome)
        assert used <= 4 * len(genome)
        assert phenotype is None or phenotype == phenotype.strip(" ")


def read_scenario(text):
    scenario = parse_scenario(text, "mine")
    assert parse_scenario(scenario.to_yaml(), "mine") == scenario
    assert np.isfinite(list(scenario_numbers(scenario).values())).all()


def read_own_terms(code):
    """A Python file beside a scenario."""
    Path("alone.py").write_text(code, "utf-8", "surrogateescape")
    Path("alone.yaml").write_text(_EXAMPLE["alone.yaml"])
    try:
        scenario = load_scenario("alone.yaml")
    except ScenarioError as error:
        assert all("alone.py" in line or ".yaml:" in line for line in str(error).splitlines())
        raise
    words = vocabulary_of(scenario)
    rule_set = read_rule_set(_EXAMPLE["alone.rules"], "alone.rules", words)
    assert len(describe(rule_set, words)) == len(rule_set.rules)
    assert [entry.about for entry in catalogue(scenario)]


def read_config(text):
    config = RunConfig.from_yaml(text)
    assert RunConfig.from_yaml(config.to_yaml()) == config


def as_utf8(text):
    """As much of a text as can come over a socket."""
    return text.encode("utf-8", "replace").decode()


_READER = reader_of("rules", watched=False)


def read_message(raw):
    assert isinstance(_READER.read(raw), Request)


def change_scenario(change):
    """What the scenario panel does with a number that was typed."""
    value, number = change
    PAPER.with_changes(**value.change(PAPER, number))


def typed_numbers(rng):
    """A number of the panel, and what may be typed into it."""
    numbers = (rng.uniform(-1, 1) * 10 ** rng.randint(-320, 308), rng.randint(-(2**63), 2**63))
    special = (rng.randint(-3, 300), math.nan, math.inf, -math.inf)
    return rng.choice(VALUES), rng.choice((*numbers, *special))


_README = Path(__file__).parents[2] / "README.md"
_EXAMPLE = dict(
    re.findall(r"```\w*\n# (alone\.\w+)\n(.*?)```", _README.read_text("utf-8"), re.DOTALL)
)
_YAML_VALUES = mutations.json_objects(("schema", "name", "comment", "origin", "rules"))
_CONFIG = RunConfig(PAPER, Settings(population=4), 3, EVO8.rules[:1]).to_yaml()
GRAMMAR = """# arithmetic
<e> ::= <e> <op> <e> | "(" <e> ")" | x | 1.0
<op> ::= + | '*'
<words> ::= a b | "" | 'if x:\\n  y  "\\\\\\"' | <1st>
  z
<1st> ::= ü
"""
_SCENARIOS = (
    "extends: paper\nrobots: 8\narena: {width: 8.4, length: 4.2}\nzone_miss: 0.02\n",
    "random_walk: [1, 2]\nduration: 10\n",
    PAPER.to_yaml(),
    load_scenario("aac").to_yaml(),
    "extends: homing\narena: {walls: [{from: [0, 0], to: [1, 0], thickness: 0.05}]}\n",
)
_MESSAGES = ('{"type": "edit", "edit": {"do": "remove_rule", "rule": 0}}', '{"type": "undo"}')
_NUMBERS = st.floats() | st.integers(-(2**63), 2**63)


@cache
def doors():
    """What needs nothing but an input."""
    values_as_yaml = _YAML_VALUES.map(lambda tree: yaml.safe_dump(tree, allow_unicode=True))
    keys = [*PARAMETERS, *WORDS, "arena", "extends"]
    scenario_trees = mutations.json_objects(keys).map(yaml.safe_dump)
    return (
        Door("rules, YAML", read_rules(".yaml"), (RuleSetError,),
             text_inputs(*map(format_yaml, RULE_SETS)),
             values_as_yaml | documented_rule_sets.map(format_yaml)),
        Door("rules, text", read_rules(".rules"), (RuleSetError,),
             text_inputs(*map(format_text, RULE_SETS)),
             st.text(max_size=60) | documented_rule_sets.map(format_text)),
        Door("rules, JSON as text", read_rules(".json"), (RuleSetError,),
             text_inputs(*map(format_json, RULE_SETS)),
             _YAML_VALUES.map(json.dumps) | documented_rule_sets.map(format_json)),
        Door("rules, JSON as values", read_rules(".json"), (RuleSetError,),
             value_inputs(*map(rule_set_to_json, RULE_SETS)),
             mutations.json_values.map(json.dumps)),
        Door("grammar", read_grammar, (GrammarError,), text_inputs(GRAMMAR), st.text(max_size=60)),
        Door("scenario", read_scenario, (ScenarioError,), text_inputs(*_SCENARIOS), scenario_trees),
        Door("own terms", read_own_terms, (ScenarioError, RuleSetError),
             lambda rng: mutations.mutated_text(
                 rng, [_EXAMPLE["alone.py"]], mutations.PYTHON_WORDS),
             st.sampled_from(mutations.PYTHON_WORDS), share=0.05),
        Door("config of a run", read_config, (RunConfigError,), text_inputs(_CONFIG),
             mutations.json_objects(yaml.safe_load(_CONFIG)).map(yaml.safe_dump)),
        Door("number in the scenario panel", change_scenario, (ScenarioError,),
             typed_numbers,
             st.tuples(st.sampled_from(VALUES), _NUMBERS)),
        Door("message, as received", read_message, (MessageError,),
             lambda rng: as_utf8(text_inputs(*_MESSAGES)(rng)),
             mutations.json_values.map(json.dumps) | st.binary(max_size=60)),
    )  # fmt: skip
