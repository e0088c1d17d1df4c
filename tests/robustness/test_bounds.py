"""What is too much, too deep, too long or out of its range is refused by one clear line."""

import importlib
import math

import pytest

from geswarm.ge import Grammar, GrammarError, Settings, SettingsError
from geswarm.rules import RuleSetError, apply_edit, load_preset, load_rule_set, read_rule_set
from geswarm.rules.control_table import apply_rule
from geswarm.rules.edits import EditError
from geswarm.sim import ScenarioError, load_scenario, parse_scenario
from geswarm.sim.scenario.checks import PARAMETERS

PAPER = load_scenario("paper")
EVO8 = load_preset("evo8")
REFUSALS = (RuleSetError, ScenarioError, GrammarError, SettingsError, EditError)
LONGEST = 300  # characters of a message
simplify = importlib.import_module("geswarm.rules.simplify")  # not the function of that name


def one_line(call, *arguments, **options):
    """Why a call is refused."""
    with pytest.raises(REFUSALS) as caught:
        call(*arguments, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < LONGEST
    return message


def doubling(levels, anchor, alias):
    """A text that stands for a value of 2 ** levels parts."""
    lines = [f"a0: {anchor}0 [x]"]
    for level in range(1, levels):
        lines.append(f"a{level}: {anchor}{level} [{alias}{level - 1}, {alias}{level - 1}]")
    return "\n".join(lines)


BOMB = doubling(60, "&b", "*b")
MERGES = "robots: &b0 {x: 1}\n" + "\n".join(
    f"r{level}: &b{level} {{<<: [*b{level - 1}, *b{level - 1}]}}" for level in range(1, 60)
)
DEEP = "[" * 10_000
RULE = "rule do p = 1, PHOTOTAXIS\n"
ELEMENTS = "rule" + " if ON_NEST == true" + " and ON_NEST == true" * 1000 + " do p = 1, PHOTOTAXIS"


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("x.yaml", BOMB, "x.yaml:2: not valid YAML: aliases are not read"),
        ("x.yaml", f"? {BOMB}", "x.yaml:2: not valid YAML"),
        ("x.yaml", f"rules: {DEEP}", "x.yaml: nested too deeply"),
        ("x.yaml", "rules: [" + "{}, " * 10_000 + "]", "x.yaml: expected at most 1000 rules"),
        ("x.yaml", "rules:\n" + "- do: p = 1, PHOTOTAXIS\n" * 10_000, "at most 200000 characters"),
        ("x.yaml", "rules: []\norigin: {fitness: .nan}", "origin fitness: expected a number"),
        ("x.yaml", "rules: []\norigin: {generation: 0x" + "f" * 9999 + "}", "a whole number"),
        ("x.yaml", "rules: []\n? " + "x" * 9999 + "\n: 1", "x.yaml:2: unknown key 'xxx"),
        ("x.yaml", "rules: []\nname: !!int ''\norigin: {generation: !!int ''}", "a whole number"),
        ("x.rules", RULE * 5000, "x.rules: expected at most 1000 rules in all, got 5000"),
        ("x.rules", RULE * 10_000, "x.rules: expected at most 200000 characters, got more"),
        ("x.rules", ELEMENTS, "expected at most 1000 preconditions, behaviours and actions"),
        ("x.rules", "rule do " + '"' + '\\"' * 90_000, "x.rules:1: rule 1, action 1: expected p ="),
        ("x.rules", "rule if " + "Q" * 90_000 + " == true", "unknown precondition 'QQQ"),
        ("x.rules", 'origin generation 1, fitness 1e999 rule do p = 1, PHOTOTAXIS', "finite"),
        ("x.rules", f"name {DEEP}", "name: expected a text in double quotes, got '[[["),
        ("x.json", DEEP, "not valid JSON: it is nested too deeply"),
        ("x.json", '{"rules": [' + "{}, " * 10_000 + "{}]}", "at most 1000 rules in all"),
        ("x.json", f'{{"rules": [{{"actions": [{{"p": {10**400}, "behaviour": "PHOTOTAXIS"}}]}}]}}',
         "rule 1, action 1: probability must be between 0 and 1"),
        ("x.json", '{"rules": ' + "9" * 9999 + "}", "a number is too long"),
    ],
)  # fmt: skip
def test_rule_sets(name, text, expected):
    assert expected in one_line(read_rule_set, text, name)


def test_a_file_without_end_is_not_read_to_its_end():
    assert "200000 characters" in one_line(load_rule_set, "/dev/zero")


@pytest.mark.parametrize(
    ("edit", "expected"),
    [
        ({"do": "paste_rules", "at": 0, "text": RULE * 1000}, "expected at most 1000 rules"),
        ({"do": "remove_rule", "rule": 10**4299}, "there is no rule"),
        ({"do": "set_comment", "rule": 0, "comment": "x" * 10_001}, "at most 10000 characters"),
        ({"do": "x" * 10_000}, "unknown edit 'xxx"),
    ],
)
def test_edits(edit, expected):
    assert expected in one_line(apply_edit, EVO8, edit)


def test_simplifying_tries_each_piece_a_few_times(monkeypatch):
    tried = []

    def counting(*arguments):
        tried.append(arguments)
        return apply_rule(*arguments)

    monkeypatch.setattr(simplify, "apply_rule", counting)
    actions = 300
    rule_set = read_rule_set("rule" + " do p = 1, PHOTOTAXIS" * actions)
    assert len(simplify.simplify(rule_set).rule_set.rules[0].actions) == 1
    assert len(tried) < 5 * actions


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (BOMB, "aliases are not read"),
        (MERGES, "aliases are not read"),
        (f"robots: {DEEP}", "nested too deeply"),
        ("robots: 1000000000", "robots: expected at least 1 and at most 200000, got 1000000000"),
        ("robots: 1" + "0" * 400, "got a number of more than 15 digits"),
        ("robots: 500", "500 do not fit in the nest, which has room for 216"),
        ("nest: 5", "5 m deep, but the arena is 4.2 m long"),
        ("source: 3", "nest and source overlap"),
        ("arena: {width: 0.1}", "arena: width: expected more than 0.17"),
        ("proximity_range: 1.0e-320", "proximity_range: expected at least 1e-06"),
        ("robots: !!int ''", "robots: cannot be understood"),
        ("light: " + "x" * 9999, "light: expected a number, got the text 'xxx"),
        ("? " + "x" * 9999 + "\n: 1", "unknown key 'xxx"),
        ("extends: " + "x" * 9999, "there is no scenario or file 'xxx"),
        ("# " + "x" * 200_000, "at most 200000 characters"),
    ],
)
def test_scenarios(text, expected):
    assert expected in one_line(parse_scenario, text)


@pytest.mark.parametrize("key", PARAMETERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1, 10**400, 1e300, True, None])
def test_every_number_out_of_its_range(key, value):
    pair = (value, value) if key == "random_walk" else value
    assert ": expected " in one_line(PAPER.with_changes, **{key: pair})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<a> ::= <a> x | x <a>", "<a> never ends"),
        ("<a> ::= x | <b>\n<b> ::= x <b>", "grammar:2: <b> never ends"),
        ("<a> ::= " + "b " * 9000, "grammar:1: <a> expands to more than 10000 symbols"),
        ("<a> ::= b " * 3000, "at most 20000 characters"),
        ("".join(f"<{chr(97 + i % 26)}{i}>::=x\n" for i in range(1001)), "at most 1000 rules"),
    ],
)
def test_grammars(text, expected):
    assert expected in one_line(Grammar.parse, text)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"population": 10**9}, "population: expected at most 1000000, got 1000000000"),
        ({"evaluations": 10**18}, "evaluations: expected at most 1000000"),
        ({"population": 10_000, "evaluations": 1000}, "evaluations: expected at most 1000000 in"),
        ({"max_wraps": 10**9}, "max_wraps: expected at most 1000000"),
        ({"population": -5}, "population: expected a whole number >= 2, got -5"),
        ({"crossover": math.nan}, "crossover: expected a probability in [0, 1], got nan"),
        ({"scaling": math.inf}, "scaling: expected a power in [0, 100], got inf"),
        ({"elitism": 1.0}, "elitism: expected a fraction of the population in [0, 1), got 1.0"),
    ],
)
def test_settings(changes, expected):
    assert expected in one_line(Settings, **changes)
