"""Text as editors save it: the same text, or one line that says what it is instead."""

import io
import sys
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.analysis.reproduction import Campaign
from geswarm.ge import Grammar, GrammarError
from geswarm.plain_text import NotTextError, decode, read_stream
from geswarm.rules import (
    FORMATS,
    RuleSetError,
    load_preset,
    load_rule_set,
    parse_json,
    parse_text,
    parse_yaml,
)
from geswarm.sim import ScenarioError, load_scenario

MARK = b"\xef\xbb\xbf"
LINE_ENDS = (b"\n", b"\r\n", b"\r")
EDITORS = [(mark, end) for mark in (b"", MARK) for end in LINE_ENDS]
characters = st.characters(exclude_characters="\r\0", exclude_categories=["Cs"])
texts = st.text(characters).map(lambda text: text.lstrip("\ufeff"))


def saved(text, editor):
    mark, line_end = editor
    return mark + text.encode().replace(b"\n", line_end)


@given(texts, st.sampled_from(EDITORS))
def test_a_text_is_the_same_from_every_editor(text, editor):
    data = saved(text, editor)
    assert decode(data) == text
    assert read_stream(io.BytesIO(data), len(text)) == text


@given(texts, st.integers(0, 30))
def test_of_a_long_stream_enough_is_read(text, most):
    read = read_stream(io.BytesIO(MARK + text.encode()), most)
    assert text.startswith(read)
    assert len(read) > most or read == text


@given(st.binary())
def test_bytes_are_text_or_refused(data):
    try:
        text = decode(data)
    except NotTextError as error:
        assert "UTF-8" in str(error)
    else:
        assert "\r" not in text


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b'name "F\xf6rder"', "not a text file, not UTF-8 at byte 7 (invalid start byte)"),
        (MARK + b"ab\xe9", "not a text file, not UTF-8 at byte 5 (unexpected end of data)"),
        ("rule ö".encode("utf-16"), "UTF-16, expected UTF-8"),
        (b"\xfe\xff" + "rule ö".encode("utf-16-be"), "UTF-16, expected UTF-8"),
        ("rule ö".encode("utf-16-le"), "UTF-16, expected UTF-8"),
        ("rule ö".encode("utf-16-be"), "UTF-16, expected UTF-8"),
        ("rule ö".encode("utf-32"), "UTF-32, expected UTF-8"),
        (b"\xff\xfe\xfd", "not a text file, not UTF-8 at byte 0 (invalid start byte)"),
    ],
)
def test_what_is_no_utf_8_is_named(data, reason):
    with pytest.raises(NotTextError) as caught:
        decode(data)
    assert str(caught.value) == reason


def typed(monkeypatch, data):
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(data)))


@pytest.mark.parametrize("editor", EDITORS)
@pytest.mark.parametrize("form", FORMATS)
def test_rule_sets_of_every_editor_are_read(tmp_path, monkeypatch, form, editor):
    rule_set = load_preset("evo8")
    data = saved(FORMATS[form](rule_set), editor)
    path = tmp_path / f"mine.{form}"
    path.write_bytes(data)
    typed(monkeypatch, data)
    assert load_rule_set(str(path)) == load_rule_set("-") == rule_set
    parse = {"text": parse_text, "yaml": parse_yaml, "json": parse_json}[form]
    assert parse(data.decode().removeprefix("\ufeff")) == rule_set


@pytest.mark.parametrize("line_end", LINE_ENDS)
def test_errors_name_the_line_of_the_editor(tmp_path, line_end):
    for name, text in (("a.rules", "rule\n\n  do x"), ("a.json", '{\n"rules":\n}')):
        (tmp_path / name).write_bytes(text.encode().replace(b"\n", line_end))
        with pytest.raises(RuleSetError, match=f"{name}:3: "):
            load_rule_set(str(tmp_path / name))


@pytest.mark.parametrize("editor", EDITORS)
def test_grammars_scenarios_and_plans_of_every_editor_are_read(tmp_path, editor):
    (tmp_path / "mine.bnf").write_bytes(saved('<a> ::= x\n  y # z\n<b> ::= "a"\n', editor))
    assert Grammar.load(tmp_path / "mine.bnf").rules == {"a": (("x", "\n", "y"),), "b": (("a",),)}
    (tmp_path / "mine.yaml").write_bytes(saved("extends: paper\nrobots: 8\n", editor))
    assert load_scenario(tmp_path / "mine.yaml").robots == 8
    plan = Campaign.at(tmp_path / "campaign", seed=3).plan
    (tmp_path / "campaign/campaign.yaml").write_bytes(saved(plan.to_yaml(), editor))
    assert Campaign.at(tmp_path / "campaign").plan == plan


def test_files_in_utf_16_are_named_everywhere(tmp_path, monkeypatch):
    path = tmp_path / "mine"
    path.write_bytes("rule do p = 1, PHOTOTAXIS".encode("utf-16"))
    typed(monkeypatch, path.read_bytes())
    for read, reference, error in (
        (load_rule_set, str(path), RuleSetError),
        (load_rule_set, "-", RuleSetError),
        (load_scenario, path, ScenarioError),
        (Grammar.load, path, GrammarError),
    ):
        with pytest.raises(error, match="UTF-16, expected UTF-8"):
            read(reference)


def test_standard_input_that_is_closed_is_refused(monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(RuleSetError, match="it is closed"):
        load_rule_set("-")


def test_standard_input_may_be_replaced_by_text(monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO("\ufeffrule\r\n  do p = 1, PHOTOTAXIS\r\n"))
    assert load_rule_set("-") == parse_text("rule do p = 1, PHOTOTAXIS")
