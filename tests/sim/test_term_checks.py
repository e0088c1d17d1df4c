"""Scenarios whose terms are wrong are refused by name, with file and line."""

from dataclasses import replace

import pytest

from geswarm.app.state.references import references_of
from geswarm.rules import format_yaml, load_rule_set
from geswarm.sim import ScenarioError, load_scenario, parse_scenario, scenario_names, vocabulary_of

AAC = "extends: aac\n"
XOR = "extends: xor\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            AAC + "preconditions: [ON_BLCK]",
            "x.yaml:2: preconditions 1: unknown precondition ON_BLCK; did you mean ON_BLACK?",
        ),
        (
            AAC + "preconditions: [SEES_OBJECT]",
            "x.yaml:2: preconditions 1: SEES_OBJECT needs objects, but the scenario has none",
        ),
        (
            AAC + "measures: [on_black, collected]",
            "x.yaml:2: measures 2: collected counts objects, but the scenario has none",
        ),
        (
            XOR + "preconditions: [LIGHT]",
            "x.yaml:2: preconditions 1: LIGHT needs a light, but the arena has none",
        ),
        (
            XOR + "behaviours: [PHOTOTAXIS, RANDOM_WALK]",
            "x.yaml:2: behaviours 1: PHOTOTAXIS needs a light, but the arena has none",
        ),
        (
            XOR + "behaviours: [RANDOM_WALK, STAND]",
            "x.yaml:2: behaviours 2: unknown behaviour STAND; known are PHOTOTAXIS, ",
        ),
        (
            AAC + "objective: {maximise: robots * 2}",
            "x.yaml:2: objective: expected at least one measure in it; counted are on_black",
        ),
        (
            AAC + "objective: {maximise: on_white}",
            "x.yaml:2: objective: there is no measure 'on_white'; known are on_black, robots",
        ),
        (
            "registers: [WANT_OBJECT]",
            "x.yaml:1: registers: objects need WANT_OBJECT and DROP_OBJECT, got WANT_OBJECT",
        ),
        (
            XOR + "registers: [HUNGER(1..5)]",
            "x.yaml:2: registers 1: HUNGER(1..5): expected a counter such as HUNGER(0..7)",
        ),
        (
            XOR + 'registers: ["A(0..5)", "B(0..3)"]',
            "x.yaml:2: registers: B: expected one counter",
        ),
        (
            XOR + 'behaviours: [RANDOM_WALK, "RANDOM_WALK(shortest, longest)"]',
            "x.yaml:2: behaviours 2: RANDOM_WALK(shortest, longest): rules could not tell it from",
        ),
        (
            XOR + 'behaviours: ["RANDOM_WALK(shortest, longest)"]',
            "x.yaml:2: behaviours: expected one of ",
        ),
    ],
)
def test_what_is_wrong_is_told_by_name_with_its_line(text, message):
    with pytest.raises(ScenarioError) as error:
        parse_scenario(text, "x.yaml")
    assert message in str(error.value)


def test_a_name_in_a_list_is_told_with_its_own_line():
    text = AAC + "preconditions:\n- FLOOR\n- FLUR\nbehaviours:\n- STOP\n- STOP\n"
    with pytest.raises(ScenarioError) as error:
        parse_scenario(text, "x.yaml")
    assert [str(finding) for finding in error.value.findings] == [
        "x.yaml:7: behaviours 2: STOP is given twice"
    ]
    with pytest.raises(ScenarioError) as error:
        parse_scenario(text.replace("- STOP\n", "- RANDOM_WALK\n", 1), "x.yaml")
    assert "x.yaml:4: preconditions 2: unknown precondition FLUR" in str(error.value)


def test_the_reference_may_be_a_file_beside_the_scenario(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(AAC + "reference: rules.yaml\n")
    with pytest.raises(ScenarioError, match=r"2: reference: there is no file 'rules\.yaml'"):
        load_scenario(path)
    rules = load_rule_set("aac", vocabulary_of(load_scenario("aac")))
    (tmp_path / "rules.yaml").write_text(format_yaml(replace(rules, name="Mine")))
    scenario = load_scenario(path)
    assert scenario.reference == str(tmp_path / "rules.yaml")
    assert load_rule_set(scenario.reference, vocabulary_of(scenario)).name == "Mine"
    assert list(references_of(scenario)) == ["rules"]
    assert parse_scenario(scenario.to_yaml(), scenario.name) == scenario


def test_everything_is_told_at_once():
    with pytest.raises(ScenarioError) as error:
        parse_scenario(AAC + "preconditions: [A, B]\nbehaviours: [RANDOM_WALK, C]", "x")
    assert [(each.place.line, each.message.split(";")[0]) for each in error.value.findings] == [
        (2, "unknown precondition A"),
        (2, "unknown precondition B"),
        (3, "unknown behaviour C"),
    ]


@pytest.mark.parametrize("name", scenario_names())
def test_scenarios_that_come_with_it_are_right(name):
    assert vocabulary_of(load_scenario(name)).behaviours


def test_registers_and_behaviours_may_be_declared_with_what_is_in_parentheses():
    scenario = parse_scenario(
        XOR + 'registers: ["MODE(red, green)", HUNGER(0..5), FLAG]\ninitial_behaviour: STOP\n'
        'behaviours: [STOP, "RANDOM_WALK(shortest, longest)"]\n'
    )
    words = vocabulary_of(scenario)
    assert [each.values for each in words.internal_states] == [
        ("red", "green"),
        tuple(range(6)),
        (False, True),
    ]
    assert len(words.behaviour_names["RANDOM_WALK"].arguments) == 2
    assert parse_scenario(scenario.to_yaml(), scenario.name) == scenario


@pytest.mark.parametrize(
    ("code", "message"),
    [("1 / 0\n", "mine.py, line 1: ZeroDivisionError"), ("a b\n", "mine.py, line 1: SyntaxError")],
)
def test_own_terms_that_cannot_be_loaded_name_both_files(code, message, tmp_path):
    (tmp_path / "mine.py").write_text(code)
    path = tmp_path / "mine.yaml"
    path.write_text(AAC + "terms: mine.py\n")
    with pytest.raises(ScenarioError) as error:
        load_scenario(path)
    assert f"{path}:2: terms: " in str(error.value)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("x.mean(axis=0)", ""),
        ("x.mean()", "mine.py, line 4: spread: expected 2 numbers for 2 simulations of 3 robots"),
        ("x.mean(axis=7)", "mine.py, line 6: spread raised AxisError"),
    ],
)
def test_measures_of_places_are_tried(code, message, tmp_path):
    (tmp_path / "mine.py").write_text(
        "from geswarm.sim.terms import Places, places_measure\n\n\n@places_measure(unit='m')\n"
        f"def spread(x: Places, y: Places, arena: object) -> Places:\n    return {code}\n"
    )
    path = tmp_path / "mine.yaml"
    path.write_text(AAC + "terms: mine.py\nmeasures: [spread]\nobjective: spread\n")
    if not message:
        assert load_scenario(path).measures == ("spread",)
        return
    with pytest.raises(ScenarioError) as error:
        load_scenario(path)
    assert message in str(error.value)
