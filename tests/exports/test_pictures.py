"""State machines as pictures: SVG, Mermaid and DOT; their layout."""

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings

from geswarm.exports import EXPORTS, brief_svg, machine_svg
from geswarm.exports.geometry import Box
from geswarm.exports.layout import BRIEF, FULL, lay_out
from geswarm.rules import RuleSet, StateMachine, load_preset
from tests import strategies
from tests.exports.test_exports import CROWDED, EVO8, HAND_CODED, NASTY

SVG = "{http://www.w3.org/2000/svg}"


def test_mermaid():
    lines = EXPORTS["mermaid"](HAND_CODED).splitlines()
    assert lines[:9] == [
        "---",
        'title: "Hand-coded"',
        "---",
        "stateDiagram-v2",
        '    state "PHOTOTAXIS" as s0',
        '    state "ANTI-PHOTOTAXIS" as s1',
        '    state "RANDOM_WALK" as s2',
        "    [*] --> s2",
        "    s0 --> s1 : HAS_OBJECT~and~not~ON_NEST<br/>p~=~1,~at~once~·~R3".replace("~", "\u00a0"),
    ]
    arrows = [line.split()[:3] for line in lines[8:] if "-->" in line]
    pairs = StateMachine.of(HAND_CODED).between
    assert arrows == [[f"s{source}", "-->", f"s{target}"] for source, target in pairs]
    for entry in StateMachine.of(EVO8).transitions:
        assert EXPORTS["mermaid"](EVO8).replace("\u00a0", " ").count(entry.rate) >= 1
    assert 'title: "‹b› ＆"' in EXPORTS["mermaid"](RuleSet(name="<b> &"))


def test_dot():
    lines = EXPORTS["dot"](HAND_CODED).splitlines()
    assert lines[0] == "digraph rule_set {"
    assert '  s2 [label="RANDOM_WALK", color="#22b278", peripheries=2];' in lines
    label = r"  ON_NEST\l  p = 1, at once · R4\l  drop the object\l"
    assert f'  s1 -> s2 [label="{label}", color="#1f63de"];' in lines
    assert sum("->" in line for line in lines) == len(StateMachine.of(HAND_CODED).between)
    assert r'label="a\\\"b"' in EXPORTS["dot"](RuleSet(name='a\\"b'))


@pytest.mark.skipif(not shutil.which("dot"), reason="Graphviz is not installed")
def test_graphviz_draws_it():
    subprocess.run(["dot", "-Tsvg"], input=EXPORTS["dot"](NASTY), text=True, check=True)


@settings(max_examples=25, deadline=None)
@pytest.mark.parametrize("form", [FULL, BRIEF])
@given(rule_set=strategies.plain_rule_sets())
def test_nothing_in_a_picture_covers_anything_else(form, rule_set):
    machine = StateMachine.of(rule_set)
    layout = lay_out(machine, form)
    boxes = [arrow.label for arrow in layout.arrows if arrow.lines] + list(layout.states)
    for at, one in enumerate(boxes):
        assert all(min(one.overlap(other)) <= 0 for other in boxes[:at])
    for box in boxes:
        assert 0 <= box.x - box.width / 2 <= box.x + box.width / 2 <= layout.width
        assert 0 <= box.y - box.height / 2 <= box.y + box.height / 2 <= layout.height
    for arrow in layout.arrows:
        head = Box(*arrow.path[-1], 8, 8)
        for other in layout.arrows:
            texts = [other.label] if other.lines else []
            assert all(min(head.overlap(text)) <= 0 for text in texts)
            if other is not arrow and texts:
                points = [Box(x, y, 0, 0) for x, y in arrow.path]
                assert all(min(point.overlap(other.label)) <= 0 for point in points)
    drawn = [at for arrow in layout.arrows for at in arrow.transitions]
    assert sorted(drawn) == list(range(len(machine.transitions)))


@settings(max_examples=20, deadline=None)
@given(rule_set=strategies.plain_rule_sets())
def test_arrows_go_from_border_to_border_and_through_no_other_state(rule_set):
    machine = StateMachine.of(rule_set)
    layout = lay_out(machine)
    for arrow in layout.arrows:
        for end, state in ((arrow.path[0], arrow.source), (arrow.path[-1], arrow.target)):
            box = layout.states[state]
            assert not box.rounded_contains(end)
            assert box.rounded_contains(end, 9)
        for at, box in enumerate(layout.states):
            if at not in (arrow.source, arrow.target):
                assert not any(box.rounded_contains(point) for point in arrow.path)


def test_what_finds_no_room_at_its_arrow_stands_in_a_list_under_its_number():
    machine = StateMachine.of(CROWDED)
    layout = lay_out(machine)
    root = ElementTree.fromstring(machine_svg(machine))
    groups = [group for group in root.iter(f"{SVG}g") if group.get("class") == "transition"]
    assert len(groups) == len(machine.transitions)
    assert min(arrow.label.y for arrow in layout.arrows) > max(box.y for box in layout.states)
    badges = sum(element.get("class") == "badge" for element in root.iter(f"{SVG}circle"))
    assert badges == 2 * len(layout.arrows)
    numbers = [text.text for text in root.iter(f"{SVG}text") if (text.text or "").isdigit()]
    counted = [str(number) for number in range(1, len(layout.arrows) + 1)]
    assert sorted(numbers) == sorted(2 * counted)
    for arrow in layout.arrows:
        assert (arrow.badge.x, arrow.badge.y) in arrow.path


@pytest.mark.parametrize("preset", ["evo8", "hand-coded"])
def test_the_pictures_of_the_readme_are_what_the_command_draws(preset):
    folder = Path(__file__).parents[2] / "static" / "pictures"
    picture = (folder / f"state-machine-{preset}.svg").read_text(encoding="utf-8")
    assert picture == EXPORTS["svg"](load_preset(preset))


def test_the_picture_says_what_the_machine_says():
    machine = StateMachine.of(EVO8)
    root = ElementTree.fromstring(machine_svg(machine))
    space = {"s": "http://www.w3.org/2000/svg"}
    states = root.findall(".//s:g[@class='state']/s:text", space)
    assert [state.text for state in states] == [state.label for state in machine.states]
    groups = root.findall(".//s:g[@class='transition']", space)
    shown = {int(group.get("data-transition")): group for group in groups}
    assert sorted(shown) == list(range(len(machine.transitions)))
    for at, transition in enumerate(machine.transitions):
        rows = [row.text for row in shown[at].findall("s:text", space)]
        rules = " ".join(f"R{number}" for number in transition.rules)
        assert rows[:2] == [str(transition.condition), f"{transition.rate} · {rules}"]
        assert rows[2:] == list(machine.effects(transition))
    assert machine._repr_html_() == EXPORTS["svg"](EVO8)


def test_the_brief_picture_leaves_text_out_where_there_is_too_much():
    for rule_set in (EVO8, HAND_CODED, CROWDED, RuleSet()):
        machine = StateMachine.of(rule_set)
        groups = list(ElementTree.fromstring(brief_svg(machine)).iter(f"{SVG}g"))
        of_kind = {
            kind: [group for group in groups if group.get("class") == kind]
            for kind in ("state", "arrow", "transition")
        }
        assert len(of_kind["state"]) == len(machine.states)
        drawn = " ".join(arrow.get("data-transitions") for arrow in of_kind["arrow"]).split()
        assert sorted(map(int, drawn)) == list(range(len(machine.transitions)))
        assert len(of_kind["transition"]) == (0 if rule_set is CROWDED else len(drawn))
    (text,) = of_kind["state"][0].iter(f"{SVG}text")
    assert text.text == "RANDOM_WALK"
    brief = brief_svg(StateMachine.of(EVO8))
    assert ">p = 0.0959 · R3 R4<" in brief
    assert ">not WANT_OBJECT<" in brief_svg(StateMachine.of(CROWDED))


@pytest.mark.parametrize("preset", ["evo8", "hand-coded", "evolved"])
def test_another_probability_takes_no_text_off_the_brief_picture(preset):
    rule_set = load_preset(preset)
    for at, rule in enumerate(rule_set.rules):
        for where, action in enumerate(rule.actions):
            actions, rules = list(rule.actions), list(rule_set.rules)
            actions[where] = replace(action, p=0.05)
            rules[at] = replace(rule, actions=tuple(actions))
            layout = lay_out(StateMachine.of(RuleSet(tuple(rules))), BRIEF)
            assert all(arrow.lines for arrow in layout.arrows)


def test_nothing_moves_in_the_brief_picture_for_the_digits_of_a_probability():
    rules = EVO8.rules
    layouts = []
    for p in (0.05, 0.0512, 0.3):
        action = replace(rules[0].actions[0], p=p)
        changed = RuleSet((replace(rules[0], actions=(action,)), *rules[1:]))
        layouts.append(lay_out(StateMachine.of(changed), BRIEF))
    places = [[*layout.states, *(arrow.label for arrow in layout.arrows)] for layout in layouts]
    assert places[0] == places[1] == places[2]


def test_text_in_the_picture_is_escaped():
    root = ElementTree.fromstring(EXPORTS["svg"](NASTY))
    titles = [entry.text for entry in root.iter(f"{SVG}text")]
    assert NASTY.name in titles
