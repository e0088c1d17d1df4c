"""What pages and Python say to one another: read strictly, and written for both sides at once."""

import ast
import json
import re
from collections import Counter
from pathlib import Path

import pytest

import geswarm
from geswarm.app.panels.evolution_page import EvolutionPage
from geswarm.app.panels.experiments_page import ExperimentsPage
from geswarm.app.panels.rule_page import RulePage
from geswarm.app.protocol.base import Message, Request
from geswarm.app.protocol.edits import Edit
from geswarm.app.protocol.javascript import written
from geswarm.app.protocol.pages import MODULES, kinds_of, reader_of
from geswarm.app.protocol.reading import MessageError
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.session import Session
from geswarm.rules import BehaviourChange, Rule, StateChange, Term, load_preset
from geswarm.sim import load_scenario

ROOT = Path(geswarm.__file__).resolve().parent.parent
STATIC = ROOT / "static"
PAGES = [page for page in MODULES if page != "common"]


@pytest.mark.parametrize("page", MODULES)
def test_the_javascript_side_is_what_would_be_written(page):
    committed = (STATIC / page / "protocol.js").read_text(encoding="utf-8")
    assert committed == written(page), "run: python -m app.protocol"


@pytest.mark.parametrize("page", MODULES)
def test_pages_ask_for_nothing_that_is_not_known_and_for_all_that_is(page):
    scripts = [path for path in (STATIC / page).glob("*.js") if path.name != "protocol.js"]
    text = "".join(path.read_text(encoding="utf-8") for path in scripts)
    for name, base in (("request", Request), ("edits", Edit)):
        used = set(re.findall(rf"\b{name}\.(\w+)\(", text))
        known = {re.sub(r"_(\w)", lambda m: m[1].upper(), kind) for kind in kinds_of(page, base)}
        assert used == known


@pytest.mark.parametrize("page", PAGES)
def test_pages_know_what_to_do_with_everything_that_they_are_told(page):
    main = (STATIC / page / "main.js").read_text(encoding="utf-8")
    handlers = main[main.index("const handlers = {") :]
    known = set(re.findall(r"^  (\w+)[:(]", handlers[: handlers.index("\n};")], re.MULTILINE))
    assert known == {*kinds_of(page, Message), "notice"}


@pytest.mark.parametrize("page", PAGES)
def test_types_that_scripts_name_are_written(page):
    known = set(re.findall(r"@typedef .*\} (\w+)", written(page)))
    for path in (STATIC / page).glob("*.js"):
        named = re.findall(r'"\./protocol\.js"\)\.(\w+)', path.read_text(encoding="utf-8"))
        assert set(named) <= known, path.name


def test_a_name_of_the_dashboard_means_one_thing():
    names = Counter()
    own = set()
    for folder in ("app", "geswarm"):
        for path in (ROOT / folder).rglob("*.py"):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            found = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
            names.update(found)
            own |= found if folder == "app" else set()
    assert [name for name in own if names[name] > 1] == []


def test_everything_that_pages_ask_for_is_carried_out():
    session = Session(load_scenario("paper"), load_preset("evo8"), EvolutionThread(workers=1))
    try:
        carried_out = {
            "rules": RulePage(session)._carry_out,
            "evolution": EvolutionPage(session).carry_out,
            "experiments": ExperimentsPage(session).carry_out,
        }
    finally:
        session.close()
    for page, known in carried_out.items():
        assert set(known) == set(kinds_of(page, Request).values())


def edit(**fields):
    return {"type": "edit", "version": 1, "edit": fields}


ACTION = {"p": 0.5, "behaviour": {"name": "RANDOM_WALK", "arguments": []}}
CHANGE = {"p": 1, "state": "DROP_OBJECT", "operation": "=", "value": True}


def read(page, message):
    return reader_of(page, watched=page != "rules").read(json.dumps(message))


def test_edits_hold_what_rules_are_made_of():
    place = {"rule": 0, "part": "actions", "at": 1}
    element = read("rules", edit(do="set", **place, element=ACTION)).edit.element
    assert element == BehaviourChange(0.5, Term("RANDOM_WALK"))
    element = read("rules", edit(do="add", **place, element=CHANGE)).edit.element
    assert element == StateChange(1.0, "DROP_OBJECT", True)
    assert read("rules", edit(do="add_rule", at=0, rule={"actions": [ACTION]})).edit.rule == Rule(
        actions=(BehaviourChange(0.5, Term("RANDOM_WALK")),)
    )


@pytest.mark.parametrize(
    ("page", "message", "why"),
    [
        ("rules", {}, "unknown message None; expected one of edit, undo"),
        ("rules", {"type": "watch"}, "unknown message 'watch'; expected one of edit"),
        ("rules", {"type": "undo", "version": 1, "vrsion": 2}, "did you mean version?"),
        ("rules", {"type": "key", "key": "Q"}, "key.key: expected one of P, O, X, F, R, got 'Q'"),
        ("rules", edit(do="dance"), "edit.edit.do: expected one of set_name, add_rule"),
        (
            "rules",
            edit(do="move_rule", rule=-1, to=0),
            "edit.edit.rule: expected a whole number >=",
        ),
        ("rules", edit(do="move_rule", rule=0, to=True), "expected a whole number, got True"),
        ("rules", edit(do="remove_rule", rule=0, at=1), "unknown field 'at'"),
        ("rules", edit(do="add_rule", at=0, rule={"action": []}), "did you mean actions?"),
        (
            "rules",
            edit(do="set", rule=0, part="behaviours", at=0, element=ACTION),
            "expected one of the behaviours, got BehaviourChange",
        ),
        ("rules", edit(do="set_comment", rule=0, comment="x" * 10_001), "at most 10000 characters"),
        ("evolution", {"type": "freeze", "rule": 1.5, "on": True}, "a whole number, got 1.5"),
        ("evolution", {"type": "freeze", "rule": 1, "on": 1}, "expected true or false, got 1"),
        ("evolution", {"type": "plan", "name": "seed", "value": None}, "plan.value: expected"),
        ("evolution", {"type": "open", "name": "x" * 256}, "open.name: expected text of at most"),
        ("experiments", {"type": "choice", "name": "run", "value": 1}, "against, runs, seed, got"),
        ("experiments", {"type": "draft", "name": "runs", "value": 10**300}, "at most 255"),
    ],
)
def test_what_is_refused_is_told_with_place_and_expectation(page, message, why):
    with pytest.raises(MessageError) as caught:
        read(page, message)
    assert why in str(caught.value)
    assert "\n" not in str(caught.value)
