"""State machines of many states: placed by Graphviz, or listed."""

import re
import shutil
from xml.etree import ElementTree

import pytest

from geswarm.exports import brief_svg, graphviz, machine_svg
from geswarm.exports.layout import MOST_STATES
from geswarm.rules import StateMachine, parse_text
from geswarm.sim import parse_scenario, vocabulary_of

SCENARIO = parse_scenario(
    "extends: xor\nbehaviours: [STOP, RANDOM_WALK]\ninitial_behaviour: STOP\n"
    "registers: [HUNGER(0..5)]\n"
)
RULES = """name "Many"
rule if NEIGHBOURS > 3 do p = 0.1, HUNGER += 1
rule if HUNGER == 5 do p = 0.1, RANDOM_WALK do p = 0.1, HUNGER = 0
rule if HUNGER < 2 do p = 0.1, STOP
"""
needs_dot = pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")


@pytest.fixture(scope="module")
def machine():
    words = vocabulary_of(SCENARIO)
    machine = StateMachine.of(parse_text(RULES, vocabulary=words), words)
    assert len(machine.states) > MOST_STATES
    return machine


@pytest.fixture
def without_dot(monkeypatch):
    monkeypatch.setattr(graphviz.shutil, "which", lambda _: None)


def groups(svg, name):
    tree = ElementTree.fromstring(svg)
    return [each for each in tree.iter() if each.get("class") == name]


def frames(svg):
    """Left, top, right and bottom of each state."""
    rows = [group.find("*[@class='body']") for group in groups(svg, "state")]
    values = [[float(row.get(key)) for key in ("x", "y", "width", "height")] for row in rows]
    return [(x, y, x + width, y + height) for x, y, width, height in values]


def lie_apart(boxes):
    return all(
        one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
        for at, one in enumerate(boxes)
        for other in boxes[:at]
    )


@needs_dot
@pytest.mark.parametrize("draw", [machine_svg, brief_svg])
def test_graphviz_places_states_and_arrows(draw, machine):
    svg = draw(machine)
    assert len(groups(svg, "state")) == len(machine.states)
    assert lie_apart(frames(svg))
    arrows = groups(svg, "arrow")
    assert len(arrows) == len(machine.between)
    boxes = frames(svg)
    for arrow in arrows:
        line = arrow[0].get("d")
        x, y = map(float, re.match(r"M([\d.-]+) ([\d.-]+)", line).groups())
        west, north, east, south = boxes[int(arrow.get("data-source"))]
        assert west - 10 < x < east + 10
        assert north - 10 < y < south + 10
    assert len(groups(svg, "transition")) == (
        len(machine.transitions) if draw is machine_svg else 0
    )


@pytest.mark.parametrize("draw", [machine_svg, brief_svg])
def test_without_graphviz_everything_is_listed(draw, machine, without_dot):
    svg = draw(machine)
    assert lie_apart(frames(svg))
    assert groups(svg, "arrow") == []
    assert len(groups(svg, "transition")) == len(machine.transitions)
    texts = [each.text for each in ElementTree.fromstring(svg).iter() if each.text]
    assert "→ STOP, HUNGER = 1" in texts


@pytest.mark.parametrize("output", ["", "graph 1 1 1\nnode s0 x y\n", "edge s0 s1 4 1 1\n"])
def test_graphviz_that_fails_is_as_none(output, monkeypatch, tmp_path):
    fake = tmp_path / "dot"
    fake.write_text(f"#!/bin/sh\ncat > /dev/null\nprintf '{output}'\n")
    fake.chmod(0o755)
    monkeypatch.setattr(graphviz.shutil, "which", lambda _: str(fake))
    assert graphviz.place([(10.0, 10.0), (10.0, 10.0)], [(0, 1)]) is None
