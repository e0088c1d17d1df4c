import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.sim.arena.model import Arena, Band, Box, Light, Patch
from geswarm.sim.scenario.checks import PARAMETERS
from geswarm.sim.scenario.model import (
    Scenario,
    ScenarioError,
    load_scenario,
    parse_scenario,
    scenario_names,
)
from geswarm.sim.scenario.objective import Objective

PAPER = load_scenario("paper")


def messages(text):
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(text, "mine")
    return [str(finding) for finding in caught.value.findings]


def test_paper_is_as_reported():
    nest = Band("south", 1.5)
    arena = Arena(
        outline=Box(0.0, 0.0, 4.2, 4.2),
        patches=(Patch(nest, "white", "nest"), Patch(Band("north", 2.0), "black", "source")),
        lights=(Light(y=100.0, beyond=True),),
        start=nest,
    )
    assert Scenario(
        name="paper", robots=4, objects=5, duration=5000.0, arena=arena, zone_miss=0.08,
        grip_reach=0.12, object_margin=0.10, random_walk=(5.0, 15.0), max_speed=0.10,
        turn_gain=2.0, proximity_range=0.10, rab_range=0.5, avoidance_gain=1.0,
        preconditions=("ON_NEST", "ON_SOURCE", "HAS_OBJECT"),
        behaviours=("PHOTOTAXIS", "ANTI-PHOTOTAXIS", "RANDOM_WALK"),
        registers=("WANT_OBJECT", "DROP_OBJECT"), initial_behaviour="RANDOM_WALK",
        measures=("picked", "collected", "lost"),
        objective=Objective("collected", unit="objects"), reference="hand-coded",
    ) == PAPER  # fmt: skip
    assert (PAPER.width, PAPER.length) == (4.2, 4.2)
    assert (PAPER.nest, PAPER.source, PAPER.light) == (1.5, 2.0, 100.0)
    assert PAPER.arena.banded
    assert PAPER.steps == 50_000
    assert PAPER.robots / PAPER.width / PAPER.length == pytest.approx(0.23, abs=0.005)


def test_names():
    assert scenario_names() == [
        "paper",
        "aac",
        "aggregation",
        "cfa",
        "directional-gate",
        "epuck-aac",
        "epuck-aggregation",
        "epuck-homing",
        "epuck-xor",
        *(f"flexibility-{n}" for n in (5, 10, 20)),
        "foraging-automode",
        "grid-exploration",
        "guided-shelter",
        "homing",
        "ideal-sensing",
        "lcn",
        "sca",
        *(f"scalability-{n}" for n in (5, 10, 20)),
        "spc",
        "xor",
    ]
    assert [load_scenario(name).name for name in scenario_names()] == scenario_names()


@pytest.mark.parametrize(("robots", "many", "few"), [(5, 6, 3), (10, 12, 6), (20, 25, 12)])
def test_larger_swarms(robots, many, few):
    assert load_scenario(f"scalability-{robots}") == PAPER.with_changes(
        name=f"scalability-{robots}", robots=robots, objects=many, width=4.2 * robots / 4
    )
    assert load_scenario(f"flexibility-{robots}") == PAPER.with_changes(
        name=f"flexibility-{robots}",
        robots=robots,
        objects=few,
        width=4.2 * robots / 8,
        length=2.1,
        nest=0.75,
        source=1.0,
    )


def test_ideal_sensing():
    ideal = PAPER.with_changes(name="ideal-sensing", zone_miss=0)
    assert load_scenario("ideal-sensing") == ideal


def test_a_file_gives_what_differs(tmp_path):
    (tmp_path / "base.yaml").write_text("extends: flexibility-5\nrobots: 7\narena: {width: 3}\n")
    mine = tmp_path / "mine.yaml"
    mine.write_text("extends: base.yaml\nrandom_walk: [1, 2]\n")
    expected = load_scenario("flexibility-5").with_changes(
        name="mine", robots=7, width=3.0, random_walk=(1.0, 2.0)
    )
    assert load_scenario(mine) == load_scenario(str(mine)) == expected
    assert parse_scenario("robots: 7", "seven") == PAPER.with_changes(name="seven", robots=7)


@pytest.mark.parametrize("name", scenario_names())
def test_yaml_round_trip(name, tmp_path):
    scenario = load_scenario(name)
    path = tmp_path / f"{name}-copy.yaml"
    path.write_text(scenario.to_yaml())
    assert load_scenario(path) == scenario.with_changes(name=f"{name}-copy")
    assert parse_scenario(scenario.to_yaml(), name) == scenario


def test_all_problems_at_once_with_their_places():
    assert messages(
        "extends: paper\nrobot: 7\nzone_miss: 1.5\narena:\n  width: wide\n  depth: 3\n"
        "random_walk: [15, 5]\nnest: .nan\nobjects: 2.5\nlight: 1e2\nduration: true\n"
    ) == [
        "mine:2: unknown key 'robot'; did you mean robots?",
        "mine:6: unknown key arena: 'depth'; did you mean width?",
        "mine:9: objects: expected a whole number, got 2.5",
        "mine:11: duration: expected a number, got true",
        "mine:5: arena: width: expected a number, got the text 'wide'",
        "mine:8: nest: expected more than 0 and at most 10000 m, got nan",
        "mine:10: light: expected a number, got the text '1e2' (as a number: 100.0)",
        "mine:3: zone_miss: expected at least 0 and at most 1, got 1.5",
        "mine:7: random_walk: expected [min, max], got min 15 > max 5",
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("nest: 5", "mine:1: nest: 5 m deep, but the arena is 4.2 m long"),
        ("arena: {length: 3}", "mine:1: arena: length: nest and source overlap: 1.5 m + 2.0 m"),
        ("\nrobots: 500", "mine:2: robots: 500 do not fit in the nest, which has room for 216"),
        ("nest: 0.05", "mine:1: nest: 4 do not fit in the nest, which has room for 0"),
        ("object_margin: 2", "mine:1: object_margin: a margin of 2 m leaves no room"),
        ("robots: -1", "mine:1: robots: expected at least 1"),
        ("robots: 0", "mine:1: robots: expected at least 1"),
        ("robots: .inf", "mine:1: robots: expected a whole number, got inf"),
        ("duration: .inf", "mine:1: duration: expected at least 0.1"),
        ("duration: 0", "mine:1: duration: expected at least 0.1"),
        ("light: 0x" + "f" * 5000, "mine:1: light: expected at least 0"),
        ("light: " + "9" * 5000, "mine:1: light: cannot be understood"),
        ("light:", "mine:1: light: expected a number, got nothing"),
        ("random_walk: 5", "mine:1: random_walk: expected two numbers [min, max], got 5"),
        ("random_walk: [0, 5]", "mine:1: random_walk: expected more than 0"),
        ("random_walk: [a, 5]", "mine:1: random_walk: expected a number, got the text 'a'"),
        ("arena: 4", "mine:1: arena: expected {width: ..., length: ...}"),
        ("width: 4", "mine:1: unknown key 'width'; did you mean arena: width?"),
        ("robots: 4\nrobots: 5", "mine:2: robots: given twice, first in line 1"),
        ("arena:\n  width: 4\n  width: 5", "mine:3: arena: 'width' is given twice"),
        ("extends: paper\nextends: paper", "mine:2: extends: given twice, first in line 1"),
        ("name: x\n", "mine:1: unknown key 'name'; "),
        ("[1]: 4", "mine:1: unknown key None; "),
        ("extends: papper", "mine:1: extends: there is no scenario or file 'papper'; did you mean"),
        ("extends: [1]", "mine:1: extends: expected the name or path of a scenario"),
        ("robots: [4", "mine:1: not valid YAML: "),
        ("a: b: c", "mine:1: not valid YAML: "),
        ("\x00", "mine: not valid YAML: "),
        ("light: !!python/none", "mine:1: light: cannot be understood"),
        ("light: 2020-13-45", "mine:1: light: cannot be understood"),
        ("--- 1\n--- 2", "mine:2: not valid YAML: "),
        ("", "mine: expected lines such as"),
        ("- 1", "mine: expected lines such as"),
        ("light: " + "[" * 3000, "mine: nested too deeply"),
    ],
)
def test_kind_errors(text, expected):
    (message,) = messages(text)
    assert message.startswith(expected)


def test_circles_and_missing_files(tmp_path):
    one, two = tmp_path / "one.yaml", tmp_path / "two.yaml"
    one.write_text("extends: two.yaml\n")
    two.write_text("\nextends: one.yaml\n")
    with pytest.raises(ScenarioError, match=r"two.yaml:2: .*one.yaml -> two.yaml -> one.yaml"):
        load_scenario(one)
    for missing in ("nowhere.yaml", tmp_path, "a\0b", "x" * 5000, ""):
        with pytest.raises(ScenarioError, match="there is no scenario or file"):
            load_scenario(missing)
    two.write_bytes(b"\xff\xfe\xfd")
    with pytest.raises(ScenarioError, match=r"two.yaml: not a text file"):
        load_scenario(two)


def test_a_mistake_in_the_base_is_reported_there(tmp_path):
    (tmp_path / "base.yaml").write_text("robots: 9\nlight: far\n")
    (tmp_path / "mine.yaml").write_text("extends: base.yaml\nlength: 3\n")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(tmp_path / "mine.yaml")
    first, second = (str(finding) for finding in caught.value.findings)
    assert "mine.yaml:2: unknown key 'length'" in first
    assert "base.yaml:2: light: expected a number" in second


def test_changes_are_checked():
    assert PAPER.with_changes(robots=8).robots == 8
    with pytest.raises(ScenarioError, match="paper: zone_miss: expected at least 0"):
        PAPER.with_changes(zone_miss=-1)
    with pytest.raises(ScenarioError, match="did you mean robots"):
        PAPER.with_changes(robot=8)
    with pytest.raises(ScenarioError, match="max_speed"):
        dataclasses.replace(PAPER, max_speed=math.nan)


@given(
    st.dictionaries(
        st.sampled_from([*PARAMETERS, "arena", "extends", "x"]),
        st.one_of(
            st.none(),
            st.booleans(),
            st.integers(),
            st.floats(),
            st.text(max_size=5),
            st.lists(st.floats(), max_size=3),
            st.dictionaries(st.text(max_size=3), st.floats(), max_size=2),
        ),
        max_size=4,
    )
)
@settings(max_examples=200)
def test_whatever_the_file_says_it_loads_or_explains(tree):
    import yaml

    try:
        parse_scenario(yaml.safe_dump(tree))
    except ScenarioError as error:
        assert error.findings


@given(st.text(max_size=80))
def test_any_text_loads_or_explains(text):
    try:
        parse_scenario(text)
    except ScenarioError as error:
        assert error.findings
