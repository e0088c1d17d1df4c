"""Scenarios as data: arenas of every form, terms on offer, measures, objectives."""

import math

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.sim import scenario as scenario_module
from geswarm.sim import scenario_file
from geswarm.sim.arena import Arena, Band, Box, Disc, HalfPlane, Light, Patch, Polygon, regular
from geswarm.sim.arena_file import ARENA_KEYS
from geswarm.sim.arena_geometry import corners, signed_area
from geswarm.sim.objective import Objective
from geswarm.sim.scenario import Scenario, ScenarioError, load_scenario, parse_scenario
from geswarm.sim.scenario_words import WORDS
from tests.sim.any_scenario import scenarios

PAPER = load_scenario("paper")
PLAIN = """
extends: nothing
robots: 3
duration: 10
preconditions: []
behaviours: [STOP]
measures: [idle]
objective: idle
"""


@pytest.fixture(scope="module", autouse=True)
def any_names():
    """Files may offer terms that there are not; `test_term_checks` looks at those."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scenario_module, "_term_problems", lambda _: ())
        yield


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


@given(scenarios())
@settings(max_examples=100)
def test_what_is_written_is_read_again(scenario):
    assert parse_scenario(scenario.to_yaml(), "any") == scenario
    assert hash(parse_scenario(scenario.to_yaml(), "any")) == hash(scenario)
    assert (scenario.width, scenario.length) == (
        2 * scenario.arena.half_width, 2 * scenario.arena.half_length,
    )  # fmt: skip


@given(scenarios(), st.sampled_from(["width", "length", "nest", "source", "light"]))
def test_a_number_of_an_arena_changes_where_there_is_one(scenario, key):
    try:
        changed = scenario.with_changes(**{key: getattr(scenario, key) + 1e-3})
    except ScenarioError as error:
        assert error.findings
    else:
        assert getattr(changed, key) == pytest.approx(getattr(scenario, key) + 1e-3)


def test_paper_writes_itself_briefly_and_all_else_in_full():
    assert len(PAPER.to_yaml().splitlines()) == 18
    assert "extends: nothing" in PAPER.with_changes(reference="").to_yaml()
    assert "extends" not in PAPER.with_changes(zone_miss=0.5, width=9.0).to_yaml()


def test_outlines():
    assert arena("{rectangle: [3, 2]}").outline == arena("{width: 3, length: 2}").outline
    assert arena("{rectangle: [3, 2]}").outline == Box(0, 0, 3, 2)
    assert arena("{circle: 1.2}").outline == Disc(0, 0, 1.2)
    assert arena("{regular: {corners: 6, radius: 2}}").outline == regular(6, 2)
    assert arena("{regular: {corners: 6, radius: 2, turn: 10}}").outline == regular(6, 2, 10)
    square = arena("{regular: {corners: 4, apothem: 1}}").outline
    assert square.points[0] == pytest.approx((-1, 1))
    dodecagon = arena("{regular: {corners: 12, side: 0.66}}").outline
    first, second = dodecagon.points[:2]
    assert math.dist(first, second) == pytest.approx(0.66)
    clockwise = arena("{polygon: [[0, 0], [0, 2], [2, 2], [2, 0]]}").outline
    assert clockwise == Polygon(((0, 0), (2, 0), (2, 2), (0, 2)))
    assert signed_area(corners(clockwise)) == 4


def test_everything_in_an_arena():
    found = arena("""
        circle: 2
        floor: white
        obstacles: [{box: {at: [1, 0], size: [0.1, 0.2], angle: 30}}]
        walls: [{from: [0, -0.5], to: [0, 0.5], thickness: 0.05}]
        patches:
          - {disc: {at: [0, 1], radius: 0.3}, floor: black, area: black}
          - {half_plane: {side: south, at: -1}, area: nest}
          - {band: {side: west, depth: 0.5}, floor: red}
        lights: [{at: [0, -3], height: 0.75, intensity: 5}, {beyond: 10}]
        start: {area: nest}
    """)
    assert found == Arena(
        outline=Disc(0, 0, 2),
        obstacles=(Box(1, 0, 0.1, 0.2, 30), Box(0, 0, 1, 0.05, 90)),
        patches=(
            Patch(Disc(0, 1, 0.3), "black", "black"),
            Patch(HalfPlane("south", -1), "", "nest"),
            Patch(Band("west", 0.5), "red"),
        ),
        lights=(Light(0, -3, 0.75, 5), Light(y=10, beyond=True)),
        start=HalfPlane("south", -1),
        floor="white",
    )
    assert found.areas == ("black", "nest")
    assert not found.banded


def test_what_is_inherited_and_what_is_replaced(tmp_path):
    wider = parse_scenario("arena: {width: 6}\nnest: 1")
    assert wider.arena.outline == Box(0, 0, 6, 4.2)
    assert wider.arena.start == Band("south", 1) == wider.arena.patches[0].shape
    round_one = parse_scenario("arena: {circle: 3}")
    assert round_one.arena.outline == Disc(0, 0, 3)
    assert round_one.arena.patches == PAPER.arena.patches
    disc = parse_scenario("arena: {patches: [{disc: {at: [0, -1], radius: 0.6}, area: nest}]}")
    assert disc.arena.start == Disc(0, -1, 0.6)
    assert [patch.area for patch in disc.arena.patches] == ["source", "nest"]
    near = parse_scenario("arena: {lights: [{at: [0, 3], height: 1}]}")
    assert near.arena.lights == (Light(0, 3, 1),)
    assert near.light == 0
    assert parse_scenario("light: 7").light == 7
    (tmp_path / "base.yaml").write_text("extends: aac\nnumbers: {one: 1, two: 2}\n")
    mine = tmp_path / "mine.yaml"
    mine.write_text("extends: base.yaml\nnumbers: {two: 3}\narena: {rectangle: [3, 3]}\n")
    found = load_scenario(mine)
    assert found.numbers == (("one", 1.0), ("two", 3.0))
    assert found.arena.patches == load_scenario("aac").arena.patches
    mine.write_text("extends: aac\narena: {width: 3}\n")
    with pytest.raises(ScenarioError, match=r"mine.yaml:2: arena: width: expected both a width"):
        load_scenario(mine)
    found = arena("{circle: 2, patches: [{band: {side: south, depth: 1}, area: nest}]}", nest=0.5)
    assert found.patches == (Patch(Band("south", 0.5), "", "nest"),)


def test_objectives_and_words():
    tree = "objective: {minimise: lost + 2 * picked, unit: objects}\nreference: ''\n"
    found = parse_scenario(tree + "probabilities: [0.5, 1]\navoidance_range: 0.3")
    assert found.objective == Objective("lost + 2 * picked", maximise=False, unit="objects")
    assert (found.reference, found.probabilities, found.avoidance_range) == ("", (0.5, 1.0), 0.3)
    assert parse_scenario(f"{PLAIN}\narena: {{circle: 1}}").initial_behaviour == "STOP"


def test_own_terms_are_named_by_files_only(tmp_path):
    (tmp_path / "mine.py").write_text("")
    path = tmp_path / "mine.yaml"
    path.write_text("terms: mine.py\nnumbers: {my_gain: 2}\n")
    scenario = load_scenario(path)
    assert scenario.terms == (tmp_path / "mine.py").resolve()
    assert scenario.numbers == (("my_gain", 2.0),)
    copy = tmp_path / "elsewhere" / "mine.yaml"
    copy.parent.mkdir()
    copy.write_text(scenario.to_yaml())
    assert load_scenario(copy) == scenario
    assert parse_scenario("terms: mine.py", folder=tmp_path).terms == scenario.terms
    (message,) = messages("terms: mine.py")
    assert message.startswith("mine:1: terms: terms of one's own are code")
    (message,) = messages(f"extends: {path}")
    assert "mine.yaml:1: terms: terms of one's own are code" in message
    for wrong in ("other.py", "a" * 5000, '"\\0"', ".", "4", "[1]"):
        path.write_text(f"robots: 5\nterms: {wrong}\n")
        with pytest.raises(ScenarioError, match=r"mine.yaml:2: terms: (there is no|expected)"):
            load_scenario(path)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{circle: 0}", "arena: circle: expected more than 0 and at most 10000 m, got 0"),
        ("{circle: wide}", "arena: circle: expected a number, got the text 'wide'"),
        ("{cirle: 1, circle: 2}", "unknown key arena: 'cirle'; did you mean circle?"),
        ("{circle: 1, rectangle: [1, 1]}", "arena: rectangle: expected one outline, there is circ"),
        ("{circle: 1, width: 1}", "arena: width: expected one outline, there is circle already"),
        ("{rectangle: 3}", "arena: rectangle: expected two numbers [width, length]"),
        ("{rectangle: [3, 0.1]}", "arena: rectangle: expected more than 0.17"),
        ("{length: 3}", "arena: length: expected both a width and a length"),
        ("{floor: grey}", "extends: expected an arena with an outline, such as"),
        ("{regular: {corners: 2, side: 1}}", "arena: regular: corners: expected at least 3"),
        ("{regular: {corners: 5}}", "arena: regular: expected one of side, radius, apothem"),
        ("{regular: {side: 1}}", "arena: regular: expected corners, too"),
        ("{regular: {corners: 5, sides: 1}}", "unknown key arena: regular: 'sides'; did you mean"),
        ("{polygon: [[0, 0], [1, 1]]}", "arena: polygon: expected 3 to 64 corners, got 2"),
        ("{polygon: [[0, 0], [1, 1], [2, x]]}", "arena: polygon: corner 3: expected a number"),
        ("{polygon: [[0, 0], [1, 1], [1]]}", "arena: polygon: corner 3: expected a place [x, y]"),
        ("{polygon: [[0, 0], [2, 2], [2, 0], [0, 2]]}", "arena: polygon: expected sides that do"),
        ("{polygon: [[0, 0], [1, 1], [2, 2]]}", "arena: polygon: expected sides that do not"),
        ("{polygon: [[0, 0], [0, 0], [2, 2], [2, 0]]}", "arena: polygon: expected sides that"),
        ("{circle: 1, floor: pink}", "arena: floor: expected grey, black, white, red, green, blue"),
        ("{circle: 1, obstacles: 1}", "arena: obstacles: expected a list of obstacles, got 1"),
        ("{circle: 1, obstacles: [{}]}", "arena: obstacles 1: expected one of box, disc, got none"),
        ("{circle: 1, obstacles: [1]}", "arena: obstacles 1: expected {box: ..., disc: ...}, got"),
        ("{circle: 1, obstacles: [{dsc: 1}]}", "unknown key arena: obstacles 1: 'dsc'; did you"),
        (
            "{circle: 1, obstacles: [{disc: {at: [0, 0]}}]}",
            "arena: obstacles 1: disc: expected rad",
        ),
        (
            "{circle: 1, obstacles: [{disc: {at: [5, 0], radius: 1}}]}",
            "arena: obstacles 1: lies outside the arena",
        ),
        (
            "{circle: 1, walls: [{from: [0, 0], to: [0, 0], thickness: 1}]}",
            "arena: walls 1: expected ends that are not at the same place",
        ),
        (
            "{circle: 1, walls: [{from: [5, 0], to: [6, 0], thickness: 1}]}",
            "arena: walls 1: lies outside the arena",
        ),
        (
            "{circle: 1, obstacles: [" + "{disc: {at: [0, 0], radius: 0.1}}, " * 65 + "]}",
            "arena: obstacles: expected at most 64 obstacles, got 65",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 0], radius: 1}}]}",
            "arena: patches 1: expected a f",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 0], radius: 1}, area: No-1}]}",
            "arena: patches 1: area: expected a name of lower-case letters",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 9], radius: 1}, area: a}]}",
            "arena: patches 1: lies outside the arena",
        ),
        (
            "{circle: 1, patches: [{band: {side: up, depth: 1}, area: a}]}",
            "arena: patches 1: band: side: expected south, north, west or east, got the text 'up'",
        ),
        (
            "{circle: 1, patches: ["
            + "".join(f"{{band: {{side: west, depth: 1}}, area: a{n}}}, " for n in range(7))
            + "]}",
            "arena: patches: expected at most 6 areas, got 7",
        ),
        ("{circle: 1, lights: [{at: [0, 0], beyond: 3}]}", "arena: lights 1: expected either at"),
        ("{circle: 1, lights: [{at: [0]}]}", "arena: lights 1: at: expected a place [x, y], got a"),
        ("{circle: 1, lights: [{beyond: -1}]}", "arena: lights 1: expected at least 0 and"),
        (
            "{circle: 1, lights: [{at: [0, 0], intensity: 0}]}",
            "arena: lights 1: intensity: expected more than 0",
        ),
        ("{circle: 1, start: {area: home}}", "arena: start: expected an area of one patch, home"),
        (
            "{circle: 1, start: {disc: {at: [3, 3], radius: 1}}}",
            "arena: start: lies outside the arena",
        ),
        ("{circle: 0.1}", "robots: 3 do not fit where they start, which has room for about 1"),
        (
            "{circle: 1, obstacles: [{box: {at: [0, 0], size: [3, 3]}}]}",
            "robots: 3 do not fit where they start, which has room for about 0",
        ),
    ],
)
def test_wrong_arenas(text, expected):
    assert why_not(text).removeprefix("extends: nothing").startswith(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("preconditions: [on_nest]", "preconditions 1: expected a name of capitals"),
        ("preconditions: 4", "preconditions: expected a list of names, got 4"),
        ("preconditions: [A, B, A]", "preconditions: A is given twice"),
        ("behaviours: []", "behaviours: expected 1 to 64 names, got 0"),
        ("behaviours: [STOP]", "behaviours: expected one of STOP, got 'RANDOM_WALK'"),
        ("initial_behaviour: HOP", "initial_behaviour: expected one of PHOTOTAXIS, ANTI-PHOTO"),
        ("initial_behaviour:", "initial_behaviour: expected a"),
        ("measures: [picked]", "measures: there is no measure 'collected'; known are picked, rob"),
        ("measures: [robots]", "measures 1: expected another name, robots has a meaning already"),
        ("measures: [max]", "measures 1: expected another name, max has a meaning already"),
        ("objective: gathered", "objective: there is no measure 'gathered'; known are picked"),
        ("objective: 2", "objective: expected an expression over measures, got 2"),
        ("objective: picked +", "objective: expected an expression over measures such as"),
        ("objective: {unit: x}", "objective: expected either maximise or minimise"),
        ("objective: {maximize: lost}", "unknown key objective: 'maximize'; did you mean maximise"),
        ("objective: {minimise: lost, unit: [1]}", "objective: unit: expected a unit of at most"),
        ("probabilities: [0.5, 0.1]", "probabilities: expected ascending probabilities, got 0.1"),
        ("probabilities: [2]", "probabilities: expected more than 0 and at most 1, got 2"),
        ("probabilities: 1", "probabilities: expected a list of 1 to 64 probabilities, got 1"),
        ("reference: ../x", "reference: expected the name of a rule set, got the text '../x'"),
        ("numbers: [1]", "numbers: expected {name: number}, got a list"),
        ("numbers: {Gain: 1}", "numbers: Gain: expected a name of lower-case letters"),
        ("numbers: {gain: x}", "numbers: gain: gain: expected a number, got the text 'x'"),
        ("avoidance_range: 0", "avoidance_range: expected at least 1e-06"),
        ("avoidance_range:", "avoidance_range: expected a"),
        (
            "arena: {circle: 3}\nmax_speed: 0.85",
            "max_speed: expected less than 0.85 m/s, or robots",
        ),
        ("objects: 0", "objects: expected at least 1 and at most 200000, got 0"),
        ("extends: aac\nobjects: 1", "objects: objects lie in the area called source"),
        ("extends: aac\nnest: x", "nest: expected a number, got the text 'x'"),
    ],
)
def test_wrong_words(text, expected):
    shown = [message.split(": ", 1)[1] for message in messages(text)]
    assert any(message.startswith(expected) for message in shown), shown
    assert all(len(message) < 300 for message in shown)


def test_lines_of_what_is_wrong():
    assert messages(
        PLAIN.strip() + "\narena:\n  circle: 2\n  patches:\n    - disc: {at: [0, 0], radius: -1}\n"
        "      floor: black\n    - disc:\n        at: [0, 0]\n        radius: 1\n"
        "      floor: blak\n      aria: x\n"
    ) == [
        "mine:11: arena: patches 1: disc: radius: expected more than 0 and at most 10000 m, got -1",
        "mine:17: unknown key arena: patches 2: 'aria'; did you mean area?",
        "mine:16: arena: patches 2: floor: expected grey, black, white, red, green, blue or "
        "yellow, got the text 'blak'",
    ]


def test_nothing_needs_all_that_has_no_default():
    assert messages("extends: nothing\nrobots: 4") == [
        "mine:1: extends: expected duration, preconditions, behaviours, measures, objective, too",
        "mine:1: extends: expected an arena with an outline, such as {width: 4, length: 3}",
    ]


def test_changes_of_what_an_arena_has_not():
    aac = load_scenario("aac")
    for key in ("width", "length"):
        with pytest.raises(ScenarioError, match=f"aac: arena: {key}: the arena is no rectangle"):
            aac.with_changes(**{key: 3})
    with pytest.raises(ScenarioError, match="aac: nest: the arena has no nest that is a band in"):
        aac.with_changes(nest=3)
    with pytest.raises(ScenarioError, match="aac: light: the arena has no single light beyond"):
        aac.with_changes(light=3)
    assert PAPER.with_changes(nest=1).arena.start == Band("south", 1)


@pytest.mark.parametrize(
    "wrong",
    [
        None,
        Arena(Band("south", 1)),
        Arena(Disc(0, 0, math.nan)),
        Arena(Disc(1, 0, 2)),
        Arena(Box(0, 0, 1, 1, 45)),
        Arena(Box(0, 0, "wide", 1)),
        Arena(Polygon(((0, 0), (1, 1)))),
        Arena(Disc(0, 0, 2), obstacles=(HalfPlane("south", 0),)),
        Arena(Disc(0, 0, 2), patches=(Patch(Band("up", 1), "black"),)),
        Arena(Disc(0, 0, 2), patches=(Patch(Band("south", 1), "pink"),)),
        Arena(Disc(0, 0, 2), patches=(Patch(Band("south", 1)),)),
        Arena(Disc(0, 0, 2), lights=(Light(height=-1),)),
        Arena(Disc(0, 0, 2), floor="pink"),
    ],
)
def test_wrong_arenas_from_python(wrong):
    with pytest.raises(ScenarioError, match="expected"):
        load_scenario("aac").with_changes(arena=wrong)


junk = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 3) | st.floats() | st.sampled_from(
        ["a", "nest", "south", "black", "", "A", "picked", "\n"]
    ),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(
        st.sampled_from(["at", "radius", "disc", "box", "size", "band", "side", "depth", "floor",
                         "area", "polygon", "beyond", "x", "corners", "from", "to", "thickness",
                         "maximise", "unit", "\n" * 50]),
        inner,
        max_size=4,
    ),
    max_leaves=12,
)  # fmt: skip


@given(
    st.dictionaries(st.sampled_from(ARENA_KEYS), junk, max_size=4),
    st.dictionaries(st.sampled_from([*WORDS, "nest", "extends"]), junk, max_size=3),
)
@settings(max_examples=200)
def test_whatever_a_file_says_it_loads_or_explains(in_arena, beside):
    try:
        found = parse_scenario(yaml.safe_dump({"arena": in_arena, **beside}))
    except ScenarioError as error:
        assert error.findings
        assert all("\n" not in str(each) and len(str(each)) < 400 for each in error.findings)
    else:
        assert parse_scenario(found.to_yaml()) == found


def test_the_scenarios_that_come_along():
    aac = load_scenario("aac")
    assert (aac.robots, aac.duration, aac.objects, aac.rab_range) == (20, 120.0, 0, 0.5)
    assert aac.arena.areas == ("black", "white")
    assert aac.avoidance_range == 0.25
    assert load_scenario("aggregation").objective.expression == "max_group / robots"
    assert load_scenario("xor").arena.areas == ("west", "east")
    homing = load_scenario("homing")
    assert homing.arena.areas == ("home",)
    assert all(y >= 0.6 - 1e-9 for _, y in homing.arena.start.points)
    for name in ("aac", "aggregation", "xor", "homing"):
        scenario = load_scenario(name)
        assert scenario.reference == name
        assert not scenario.arena.banded
        apothem = max(y for _, y in scenario.arena.outline.points)
        assert apothem == pytest.approx(1.2316, abs=1e-4)
    assert scenario_file.built_in_names()[0] == "paper"
    assert isinstance(aac, Scenario)
