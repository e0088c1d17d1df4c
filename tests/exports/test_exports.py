import json
import random
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.evolution import rule_grammar
from geswarm.exports import (
    EXPORTS,
    format_argos_experiment,
    format_floor,
    format_markdown,
    to_automode,
)
from geswarm.exports.automode import _drawn_in_random_order
from geswarm.ge import Mapper
from geswarm.rules import (
    BehaviourChange,
    Rule,
    RuleSet,
    RuleSetError,
    StateMachine,
    load_preset,
    parse_json,
    parse_text,
    read_rule_set,
    save_rule_set,
)
from geswarm.rules.as_json import format_json, rule_from_json
from geswarm.sim import load_scenario
from tests import strategies

EVO8, HAND_CODED = load_preset("evo8"), load_preset("hand-coded")
CROWDED = parse_text(
    "rule if ON_NEST == true do p = 0.1, PHOTOTAXIS do p = 0.05, WANT_OBJECT = false "
    "rule if ON_SOURCE == true do p = 0.1, ANTI-PHOTOTAXIS do p = 0.05, WANT_OBJECT = true "
    "rule if HAS_OBJECT == true do p = 0.5, RANDOM_WALK do p = 0.05, DROP_OBJECT = true"
)
"""Six states and far more transitions than there is room for text."""
NASTY = RuleSet(
    (Rule(actions=(BehaviourChange(0.5, "PHOTOTAXIS"),), comment="5 % $x_1$ & <b>| {\\end} `q`"),),
    name='</svg>"--]] # ;:',
    comment="\"a\"\nb|c 中 é",
)  # fmt: skip


@given(strategies.documented_rule_sets)
def test_what_carries_enough_comes_back(rule_set):
    for form in ("yaml", "text", "json"):
        assert read_rule_set(EXPORTS[form](rule_set)) == rule_set
    assert parse_json(format_json(rule_set)) == rule_set


def test_forty_messy_rules_come_back_from_json():
    """Their state machine has hundreds of transitions, and files may be only so long."""
    mapper, rng = Mapper(rule_grammar()), np.random.default_rng(3)
    rules = []
    while len(rules) < 40:
        phenotype = mapper.map(rng.integers(0, 2**31, 200).tolist()).phenotype
        rules += parse_text(phenotype).rules if phenotype else ()
    rule_set = RuleSet(tuple(rules[:40]))
    document = EXPORTS["json"](rule_set)
    assert len(StateMachine.of(rule_set).transitions) > 200
    assert read_rule_set(document) == rule_set


def test_json_files_are_saved_and_read_like_the_others(tmp_path):
    path = tmp_path / "mine.json"
    save_rule_set(EVO8, path)
    assert json.loads(path.read_text())["schema"] == 2
    assert read_rule_set(path.read_text(), str(path)) == EVO8


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            "{",
            [":1: not valid JSON: Expecting property name enclosed in double quotes at column 2"],
        ),
        ("[" * 100_000, [": not valid JSON: it is nested too deeply or a number is too long"]),
        ("[]", [": expected a rule set, got []"]),
        ("{}", [': expected "rules" with a list of rules']),
        (
            '{"schema": 3, "rules": 5}',
            [": expected schema 2, got 3", ": rules: expected a list, got 5"],
        ),
        (
            '{"rules": [3, {"comment": 1}]}',
            [": rule 1: expected a rule, got 3", ": rule 2: comment: expected text, got 1"],
        ),
        (
            '{"rules": [{"actions": [{"p": "a", "behaviour": "X"}, 4], "behaviours": [1]}]}',
            [
                ": rule 1, behaviour 1: expected a behaviour, got 1",
                ": rule 1, action 1: p: expected a number, got 'a'",
                ": rule 1, action 2: expected an action, got 4",
            ],
        ),
        (
            '{"rules": [{"actions": [{"p": 2, "behaviour": "FOTOTAXIS"}]}]}',
            [
                ": rule 1, action 1: unknown behaviour 'FOTOTAXIS'; did you mean PHOTOTAXIS?",
                ": rule 1, action 1: probability must be between 0 and 1, got 2.0",
            ],
        ),
        (
            '{"rules": [], "origin": {"fitness": NaN}}',
            [": fitness: expected a finite number, got nan"],
        ),
        ('{"rules": [], "origin": 3}', [": origin: expected an object, got 3"]),
        (
            '{"ruels": [], "rules": [{"precondition": [], "enabled": true, "enabled": false}]}',
            [
                ": unknown key 'ruels'; did you mean rules?",
                ": rule 1: unknown key 'precondition'; did you mean preconditions?",
                ": rule 1: 'enabled' is given twice",
            ],
        ),
        (
            '{"rules": [{"preconditions": [{"name": "ON_NEST", "hold": true}], "actions": ['
            '{"p": 1, "p": 0, "behaviour": "PHOTOTAXIS"}, {"p": 1, "behavior": "PHOTOTAXIS"}]}]}',
            [
                ": rule 1, precondition 1: unknown key 'hold'; did you mean holds?",
                ": rule 1, action 1: 'p' is given twice",
                ": rule 1, action 2: unknown key 'behavior'; did you mean behaviour?",
            ],
        ),
        (
            '{"rules": [], "rules": [], "state_machine": 0, "origin": {"run": "a", "rnu": "b"}}',
            [": 'rules' is given twice", ": origin: unknown key 'rnu'; did you mean run?"],
        ),
        (
            '{"rules": [{"actions": [{"p": 1, "state": "WANT_OBJECT"}, '
            '{"p": 1, "behaviour": "PHOTOTAXIS", "state": "WANT_OBJECT", "value": true}]}]}',
            [
                ": rule 1, action 1: value: expected a truth, a number or a name, got nothing",
                ": rule 1, action 2: expected either behaviour, or state and value, got both",
            ],
        ),
    ],
)
def test_wrong_json_is_explained(text, messages):
    with pytest.raises(RuleSetError) as caught:
        read_rule_set(text, "x.json")
    assert [str(finding) for finding in caught.value.findings] == [f"x.json{m}" for m in messages]


def test_json_holds_the_state_machine():
    document = json.loads(EXPORTS["json"](HAND_CODED))
    assert [rule_from_json(rule) for rule in document["rules"]] == list(HAND_CODED.rules)
    machine = document["state_machine"]
    assert machine["step_seconds"] == 0.1
    assert machine["states"][2] == {
        "behaviour": {"name": "RANDOM_WALK", "arguments": []},
        "internal": {},
        "initial": True,
    }
    assert machine["transitions"][2] == {
        "source": 0,
        "target": 2,
        "condition": [{"ON_NEST": True, "HAS_OBJECT": True}],
        "when": "ON_NEST and HAS_OBJECT",
        "probability": 1.0,
        "mean_wait": 0.1,
        "effects": {"DROP_OBJECT": True},
        "restarts": False,
        "rules": [3, 4],
    }


def test_markdown():
    lines = format_markdown(EVO8).splitlines()
    assert lines[4:7] == [
        "| | Preconditions | Behaviours | Actions | Comment |",
        "| --- | --- | --- | --- | --- |",
        "| R1 | ε | `PHOTOTAXIS` | `p = 0.05, RANDOM_WALK` | The switch to random walk for object "
        "exploration is probabilistic and can happen any time |",
    ]


@given(strategies.documented_rule_sets)
def test_markdown_rows_stay_rows(rule_set):
    lines = format_markdown(rule_set).splitlines()
    first = lines.index("| --- | --- | --- | --- | --- |") + 1
    assert len(lines) - first == len(rule_set.rules)
    for line in lines[first:]:
        assert len(re.findall(r"(?<!\\)(?:\\\\)*\|", line)) == 6


def test_english():
    assert EXPORTS["english"](HAND_CODED).splitlines() == [
        "Hand-coded",
        "The behaviour that the paper's authors wrote by hand (Table 1).",
        "",
        "R1. When away from the source and not holding an object, go to the light.",
        "R2. When at the source and not holding an object, while going to the light, "
        "start walking at random and start picking up objects.",
        "R3. When holding an object, while walking at random or going to the light, "
        "go away from the light.",
        "R4. When in the nest and holding an object, while walking at random or going away from "
        "the light, start walking at random and drop the object.",
    ]


class Texts(HTMLParser):
    def __init__(self, html):
        super().__init__()
        self.tags, self.text = set(), ""
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)

    def handle_data(self, data):
        self.text += data


@given(strategies.documented_rule_sets)
def test_notebooks_show_rule_sets_with_every_text_escaped(rule_set):
    shown = Texts(rule_set._repr_html_())
    assert shown.tags <= {"table", "caption", "tbody", "tr", "th", "td", "br"}
    for rule in rule_set.rules:
        assert rule.comment.replace("\n", "") in shown.text


def test_automode_command_lines():
    assert to_automode(EVO8).command == (
        "--fsm-config --nstates 3 --s0 0 --rwm0 50 --n0 1 --n0x0 0 --c0x0 2 --p0x0 1 "
        "--s1 2 --n1 2 --n1x0 0 --c1x0 0 --p1x0 0.05 --n1x1 0 --c1x1 1 --p1x1 0.05 "
        "--s2 3 --n2 1 --n2x0 1 --c2x0 2 --p2x0 1"
    )
    simple = parse_text(
        "rule if ON_SOURCE == true while RANDOM_WALK do p = 0.5, ANTI-PHOTOTAXIS "
        "rule if ON_NEST == true while ANTI-PHOTOTAXIS do p = 0.25, PHOTOTAXIS "
        "rule while PHOTOTAXIS do p = 0.1, RANDOM_WALK"
    )
    assert to_automode(simple).command == (
        "--fsm-config --nstates 3 --s0 0 --rwm0 50 --n0 1 --n0x0 1 --c0x0 0 --p0x0 0.5 "
        "--s1 2 --n1 1 --n1x0 0 --c1x0 5 --p1x0 0.1 "
        "--s2 3 --n2 2 --n2x0 0 --c2x0 2 --p2x0 0.0282202 --n2x1 1 --c2x1 2 --p2x1 0.22822"
    )
    assert to_automode(simple).warnings == ()


def test_automode_says_what_it_leaves_out():
    warnings = to_automode(EVO8).warnings
    assert len(warnings) == len(StateMachine.of(EVO8).transitions)
    wanting = parse_text("rule if ON_NEST == true do p = 0.1, WANT_OBJECT = false")
    assert any("WANT_OBJECT" in warning for warning in to_automode(wanting).warnings)
    loops = parse_text("rule do p = 0.1, PHOTOTAXIS rule do p = 0.1, RANDOM_WALK")
    assert any("self-loop" in warning for warning in to_automode(loops).warnings)
    floors = parse_text("rule if ON_NEST == true do p = 0.1, PHOTOTAXIS")
    assert to_automode(floors).warnings == ()


@given(st.floats(0.001, 1), st.floats(0.001, 1))
def test_two_conditions_drawn_in_random_order_come_to_the_wanted_probabilities(a, b):
    if a + b > 1:
        a, b = a / (a + b), b / (a + b)
    drawn = _drawn_in_random_order({0: a, 1: b})
    assert all(0 <= p <= 1 for p in drawn.values())
    assert drawn[0] * (1 - drawn[1] / 2) == pytest.approx(a, abs=1e-9)
    assert drawn[1] * (1 - drawn[0] / 2) == pytest.approx(b, abs=1e-9)


@given(strategies.plain_rule_sets(), st.randoms())
def test_automode_reads_its_command_line_as_meant(rule_set, rng):
    """Parsed as AutoMoDe does: the words of each state, then of each of its transitions."""
    words = to_automode(rule_set).command.split()
    options = dict(zip(words[1::2], words[2::2], strict=True))
    assert words[0] == "--fsm-config"
    assert len(options) == (len(words) - 1) / 2
    count = int(options["--nstates"])
    machine = StateMachine.of(rule_set)
    assert count == len(machine.states)
    assert options["--s0"] == "0"
    for state in range(count):
        assert options[f"--s{state}"] in ("0", "2", "3")
        for at in range(int(options.get(f"--n{state}", 0))):
            assert 0 <= int(options[f"--n{state}x{at}"]) < count - 1
            assert options[f"--c{state}x{at}"] in ("0", "1", "2", "5")
            assert 0 <= float(options[f"--p{state}x{at}"]) <= 1


def test_argos_experiment():
    scenario = load_scenario("flexibility-5")
    root = ElementTree.fromstring(format_argos_experiment(scenario, "a&b.lua", "floor.ppm"))
    assert root.find("framework/experiment").attrib["length"] == "5000"
    assert root.find(".//lua_controller/params").get("script") == "a&b.lua"
    assert root.find(".//distribute/entity").get("quantity") == "5"
    assert root.find(".//foot-bot").get("rab_range") == "0.5"
    inner = {box.get("id"): box.find("body").get("position").split(",") for box in root.iter("box")}
    assert float(inner["wall_east"][0]) - 0.05 == pytest.approx(scenario.width / 2)
    assert float(inner["wall_north"][1]) - 0.05 == pytest.approx(scenario.length / 2)
    x, y, height = map(float, root.find(".//light").get("position").split(","))
    assert (x, y) == (0, pytest.approx(scenario.length / 2 + scenario.light))
    assert height / (scenario.light + scenario.length) > 0.147 / 0.085  # over robots that touch
    south_west, north_east = (
        [float(value) for value in root.find(".//distribute/position").get(end).split(",")]
        for end in ("min", "max")
    )
    assert south_west[1] == pytest.approx(-scenario.length / 2 + 0.085)
    assert north_east[1] == pytest.approx(-scenario.length / 2 + scenario.nest)


def test_argos_floor_has_the_zones_of_the_scenario():
    scenario = load_scenario("paper")
    kind, size, deepest, *pixels = format_floor(scenario).splitlines()
    rows = int(size.split()[1])
    assert (kind, size, deepest) == ("P3", "1 440", "255")
    assert len(pixels) == rows == 440

    def shade(y):
        """As ARGoS looks it up: the picture covers the arena with its walls, north is up."""
        from_south = (y + 2.2) / 4.4 * rows
        return pixels[rows - 1 - int(from_south)].split()[0]

    rng = random.Random(1)
    for _ in range(200):
        y = rng.uniform(-2.1, 2.1)
        if min(abs(y + 0.6), abs(y - 0.1)) > 0.01:
            assert shade(y) == ("255" if y < -0.6 else "0" if y > 0.1 else "128")
