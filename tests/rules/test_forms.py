"""Text, YAML and JSON forms: exact round trips, and errors that say where."""

import pytest
from hypothesis import given

from geswarm.rules import (
    RuleSet,
    RuleSetError,
    format_table,
    format_text,
    format_yaml,
    library,
    load_preset,
    load_rule_set,
    parse_text,
    parse_yaml,
    preset_names,
    read_rule_set,
    save_rule_set,
)
from geswarm.rules.as_json import rule_from_json, rule_set_to_json
from tests.strategies import documented_rule_sets


@given(documented_rule_sets)
def test_text_and_yaml_round_trip_exactly(rule_set):
    assert parse_text(format_text(rule_set)) == rule_set
    assert parse_yaml(format_yaml(rule_set)) == rule_set
    assert read_rule_set(format_text(rule_set)) == rule_set
    assert read_rule_set(format_yaml(rule_set)) == rule_set


@given(documented_rule_sets)
def test_rules_round_trip_through_json(rule_set):
    rules = tuple(map(rule_from_json, rule_set_to_json(rule_set)["rules"]))
    assert rules == rule_set.rules


@pytest.mark.parametrize("name", preset_names())
def test_presets_are_written_as_they_stand(name):
    rule_set = load_preset(name)
    path = library._PRESETS / f"{name}.yaml"
    assert format_yaml(rule_set) == path.read_text(encoding="utf-8")


def test_evo8_is_the_papers_table_2():
    expected = """
rule while PHOTOTAXIS do p = 0.05, RANDOM_WALK
rule if ON_NEST == true while RANDOM_WALK or ANTI-PHOTOTAXIS
  do p = 1, PHOTOTAXIS do p = 1, DROP_OBJECT = true
rule if HAS_OBJECT == true while RANDOM_WALK or PHOTOTAXIS do p = 0.1, ANTI-PHOTOTAXIS
rule if ON_NEST == true and HAS_OBJECT == true while RANDOM_WALK or PHOTOTAXIS
  do p = 1.0, PHOTOTAXIS do p = 0.001, ANTI-PHOTOTAXIS
"""
    assert without_comments(load_preset("evo8")) == parse_text(expected).rules


def test_hand_coded_is_the_papers_table_1():
    expected = """
rule if ON_SOURCE == false and HAS_OBJECT == false do p = 1, PHOTOTAXIS
rule if ON_SOURCE == true and HAS_OBJECT == false while PHOTOTAXIS
  do p = 1, RANDOM_WALK do p = 1, WANT_OBJECT = true
rule if HAS_OBJECT == true while RANDOM_WALK or PHOTOTAXIS do p = 1, ANTI-PHOTOTAXIS
rule if ON_NEST == true and HAS_OBJECT == true while RANDOM_WALK or ANTI-PHOTOTAXIS
  do p = 1, RANDOM_WALK do p = 1, DROP_OBJECT = true
"""
    assert without_comments(load_preset("hand-coded")) == parse_text(expected).rules


def without_comments(rule_set):
    return tuple(
        type(rule)(rule.preconditions, rule.behaviours, rule.actions) for rule in rule_set.rules
    )


def test_comments_stay_with_their_rule():
    rule_set = parse_text(
        '# about all\nname "x"\n# first\nrule do p=1, PHOTOTAXIS  # why\n'
        "# second\nrule off # off since\n  # inside\n  do p=1, RANDOM_WALK\n# end"
    )
    assert rule_set.comment == "about all"
    assert [rule.comment for rule in rule_set.rules] == [
        "first\nwhy",
        "second\noff since\ninside\nend",
    ]
    assert [rule.enabled for rule in rule_set.rules] == [True, False]


def messages(parse, text):
    with pytest.raises(RuleSetError) as error:
        parse(text, "my.rules")
    return str(error.value).split("\n")


def test_text_errors_name_line_rule_and_element_all_at_once():
    assert messages(
        parse_text,
        "rule if ON_NST == true and HAS_OBJECT = true\n  while RANDOM-WALK\n"
        "  do p = 2, PHOTOTAXIS do RANDOM_WALK\nrule\n  do p = 1, WANT_OBJECT\n"
        "  if ON_NEST == true\n",
    ) == [
        "my.rules:1: rule 1, precondition 1: unknown precondition 'ON_NST'; did you mean ON_NEST?",
        "my.rules:1: rule 1, precondition 2: expected NAME == true or NAME == false, "
        "got 'HAS_OBJECT = true'",
        "my.rules:2: rule 1, behaviour 1: unknown behaviour 'RANDOM-WALK'; "
        "did you mean RANDOM_WALK?",
        "my.rules:3: rule 1, action 1: probability must be between 0 and 1, got 2.0",
        "my.rules:3: rule 1, action 2: expected p = NUMBER, BEHAVIOUR or p = NUMBER, STATE = true, "
        "got 'RANDOM_WALK'",
        "my.rules:5: rule 2, action 1: WANT_OBJECT is an internal state: "
        "write WANT_OBJECT = true or = false",
        "my.rules:6: rule 2: if must stand before do",
    ]


def test_yaml_errors_name_line_rule_and_element_all_at_once():
    assert messages(
        parse_yaml,
        "schema: 2\nname: x\nruls: []\nrules:\n- if: [ON_NEST == maybe]\n  while: [WALK]\n"
        "  do:\n  - p = nan, PHOTOTAXIS\n  enabled: perhaps\n- 5\n",
    ) == [
        "my.rules:3: unknown key 'ruls'; did you mean rules?",
        "my.rules:1: schema: expected schema 1, got 2",
        "my.rules:9: rule 1, enabled: expected true or false, got 'perhaps'",
        "my.rules:5: rule 1, precondition 1: expected true or false, got 'maybe'",
        "my.rules:6: rule 1, behaviour 1: unknown behaviour 'WALK'; did you mean RANDOM_WALK?",
        "my.rules:8: rule 1, action 1: probability must be between 0 and 1, got nan",
        "my.rules:10: rule 2: expected a rule with the keys comment, enabled, if, while, do",
    ]


def test_what_is_given_twice_is_refused_at_every_level():
    assert messages(
        parse_yaml,
        "name:\nname: x\norigin: {run: a, run: b}\nrules:\n- do: []\n"
        "  do:\n  - p = 1, PHOTOTAXIS\n",
    ) == [
        "my.rules:2: name is given twice",
        "my.rules:6: rule 1: do is given twice",
        "my.rules:3: run is given twice",
    ]
    assert messages(
        parse_text, 'name "a"\nname "b"\norigin run "a", run "b"\nrule do p = 1, PHOTOTAXIS'
    ) == ["my.rules:2: name is given twice", "my.rules:3: origin: run is given twice"]


@pytest.mark.parametrize(
    "text",
    ["", "   ", "rules", "rule rule if", "\0", "name", 'name "x', "if", "p = 1", "rule do" * 50],
)
def test_no_text_gives_anything_but_a_rule_set_error(text):
    for parse in (parse_text, parse_yaml):
        try:
            parse(text)
        except RuleSetError as error:
            assert error.findings


def test_yaml_bombs_and_deep_nesting_are_refused():
    bomb = "a: &a [x]\n" + "".join(f"b{i}: [*a, *a]\n" for i in range(50))
    for text in (bomb, "[" * 5000, "rules: " + "[" * 3000 + "]" * 3000, "x" * 2_000_000):
        with pytest.raises(RuleSetError):
            parse_yaml(text)


def test_files_and_presets_are_found(tmp_path, monkeypatch):
    rule_set = load_preset("evo8")
    for name in ("mine.yaml", "mine.rules"):
        save_rule_set(rule_set, tmp_path / name)
        assert load_rule_set(str(tmp_path / name)) == rule_set
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.rules", "mine.yaml"]
    with pytest.raises(RuleSetError, match=r"evo9: neither a file .* nor a preset \(aac, "):
        load_rule_set("evo9")
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RuleSetError, match="not a text file"):
        load_rule_set(str(tmp_path / "binary"))
    with pytest.raises(RuleSetError, match="neither a file"):
        load_rule_set(str(tmp_path))


def test_table_looks_like_table_2():
    lines = format_table(load_preset("evo8")).split("\n")
    assert "P4  ON_NEST == true   HAS_OBJECT == true" in lines
    assert "A4  behaviour   p = 1       B ← PHOTOTAXIS" in lines
    assert "P1  ε" in lines
    assert format_table(RuleSet())
