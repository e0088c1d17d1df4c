"""Scenarios as data: arenas of every form, terms on offer, measures, objectives."""

import math

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.sim.arena.file import ARENA_KEYS
from geswarm.sim.arena.geometry import corners, signed_area
from geswarm.sim.arena.model import (
    Arena,
    Band,
    Box,
    Disc,
    HalfPlane,
    Light,
    Patch,
    Polygon,
    regular,
)
from geswarm.sim.scenario import file as scenario_file
from geswarm.sim.scenario import model as scenario_module
from geswarm.sim.scenario.model import Scenario, ScenarioError, load_scenario, parse_scenario
from geswarm.sim.scenario.objective import Objective
from geswarm.sim.scenario.words import WORDS
from tests.sim.any_scenario import scenarios
from tests.sim.scenario_texts import PLAIN, arena, messages

PAPER = load_scenario("paper")


@pytest.fixture(scope="module", autouse=True)
def any_names():
    """Files may offer terms that there are not; `test_term_checks` looks at those."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scenario_module, "_term_problems", lambda _: ())
        yield


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
