"""Measures of robots' places and of passages, against plain Python."""

import math

import numpy as np
import pytest

from geswarm.rules import parse_text
from geswarm.sim import World, load_scenario, parse_scenario, vocabulary_of
from geswarm.sim.scenario.model import ScenarioError
from geswarm.sim.terms import coverage
from geswarm.sim.terms.gate import passages
from tests.sim.assembly import ground_twin

ROBOTS, RUNS = 12, 3


def places(scenario, seed=3):
    """Robots all over the arena; in the first run all of them in the north-east."""
    x, y = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, ROBOTS, RUNS))
    x[:, 0], y[:, 0] = 0.9 + 0.05 * x[:, 0], 0.6 + 0.05 * y[:, 0]
    return x, y


def random_points(inside, count=20_000):
    rng = np.random.default_rng(5)
    found = rng.uniform(-1.3, 1.3, (8 * count, 2))
    return [point for point in found.tolist() if inside(*point)][:count]


def mean_nearest(points, robots, most):
    return sum(
        min([most, *(math.dist(point, robot) for robot in robots)]) for point in points
    ) / len(points)


def test_distance_to_robots_is_that_of_random_points():
    scenario = load_scenario("cfa")
    x, y = places(scenario)
    found = coverage.distance_to_robots.of(x, y, scenario.arena)
    points = random_points(lambda *at: ground_twin.edge_of(scenario.arena.outline, *at) < 0, 3_000)
    for run in range(RUNS):
        robots = [
            at
            for at in zip(x[:, run], y[:, run], strict=True)
            if not ground_twin.in_area(scenario.arena, "forbidden", *at)[0]
        ]
        assert len(robots) < ROBOTS or run == 0
        assert found[run] == pytest.approx(mean_nearest(points, robots, 2.5), abs=0.02)
    nobody = np.full((1, 1), 0.5)
    assert coverage.distance_to_robots.of(nobody, nobody, scenario.arena) == pytest.approx(2.5)


def test_distances_on_surface_and_perimeter_are_those_of_random_points():
    scenario = load_scenario("spc")
    x, y = places(scenario)
    x[3, 1:], y[3, 1:] = 0.6, 0.33  # on the perimeter
    on_surface = coverage.distance_on_surface.of(x, y, scenario.arena)
    on_perimeter = coverage.distance_on_perimeter.of(x, y, scenario.arena)
    square = random_points(lambda px, py: abs(px + 0.6) < 0.3 and abs(py) < 0.3, 1_500)
    turns = np.linspace(0.0, 2.0 * math.pi, 1_500, endpoint=False).tolist()
    circle = [(0.6 + 0.3 * math.cos(a), 0.3 * math.sin(a)) for a in turns]
    for run in range(RUNS):
        robots = list(zip(x[:, run], y[:, run], strict=True))
        inside = [(px, py) for px, py in robots if abs(px + 0.6) <= 0.3 and abs(py) <= 0.3]
        around = [at for at in robots if abs(math.dist(at, (0.6, 0.0)) - 0.3) <= 0.04]
        assert bool(around) == (run > 0)
        expected = mean_nearest(square, inside, 0.6 * math.sqrt(2.0))
        assert on_surface[run] == pytest.approx(expected, abs=0.02)
        assert on_perimeter[run] == pytest.approx(mean_nearest(circle, around, 0.6), abs=2e-3)
    assert on_surface[0] == pytest.approx(0.6 * math.sqrt(2.0))


def largest_group(robots):
    left, groups = set(range(len(robots))), []
    while left:
        group, new = set(), {min(left)}
        while new:
            group |= new
            new = {k for k in left - group for g in new if math.dist(robots[k], robots[g]) < 0.35}
        groups.append(group)
        left -= group
    return max(groups, key=len)


def test_covered_is_what_random_points_say():
    scenario = load_scenario("lcn")
    x, y = places(scenario)
    found = coverage.covered.of(x, y, scenario.arena)
    points = random_points(lambda *at: ground_twin.edge_of(scenario.arena.outline, *at) < 0, 12_000)
    area = 12 * 0.657**2 * (2.0 + math.sqrt(3.0)) / 4.0
    for run in range(RUNS):
        robots = list(zip(x[:, run], y[:, run], strict=True))
        members = [robots[k] for k in largest_group(robots)]
        assert 1 < len(members) < ROBOTS or run == 0
        near = sum(any(math.dist(p, at) <= 0.25 for at in members) for p in points) / len(points)
        assert found[run] == pytest.approx(area * near, rel=0.06)


@pytest.mark.parametrize(
    ("y_before", "y", "in_gate", "step", "expected"),
    [
        (0.01, -0.01, 1, 5, 1), (-0.01, 0.01, 1, 5, -1), (0.02, 0.01, 1, 5, 0),
        (0.01, -0.01, 0, 5, 0), (0.01, -0.01, 1, 0, 0), (0.0, -0.01, 1, 5, 0),
    ],
)  # fmt: skip
def test_passages(y_before, y, in_gate, step, expected):
    numbers = np.int32(in_gate), np.float32(y), np.float32(y_before), np.int32(step)
    assert passages.function(*numbers) == expected


@pytest.mark.long
def test_a_world_counts_passages_and_measures_places():
    scenario = load_scenario("directional-gate")
    rules = parse_text(
        "rule while STOP do p = 1, EXPLORATION(5)\nrule if FLOOR != grey do p = 1, PHOTOTAXIS\n"
        "rule if FLOOR == grey while PHOTOTAXIS do p = 0.1, EXPLORATION(5)",
        "", vocabulary_of(scenario),
    )  # fmt: skip
    world, count, before = World(scenario, rules, 1), 0, None
    for _ in range(600):
        world.step()
        y, inside = world.state.y, np.abs(world.state.x) < 0.25
        if before is not None:
            south = (before > 0) & (y < 0) & inside
            count += int(south.sum()) - int(((before < 0) & (y > 0) & inside).sum())
        before = y.copy()
    assert world.measures == {"passages": count}
    assert world.fitness == max(count, 0) > 0


@pytest.mark.parametrize(
    ("measure", "text"),
    [
        ("passages", "passages is about gate, but there is no area of that name"),
        ("delivered", "delivered is about food and nest, but there is no area of that name"),
        ("distance_on_surface", "distance_on_surface is about surface, but there is no area"),
    ],
)
def test_measures_need_their_areas(measure, text):
    with pytest.raises(ScenarioError, match=text):
        parse_scenario(f"extends: epuck-aac\nmeasures: [{measure}]\nobjective: {measure}\n")


def test_an_area_that_cannot_be_measured_is_told():
    with pytest.raises(ScenarioError, match="area surface: expected one disc, box or polygon"):
        parse_scenario(
            "extends: spc\narena: {patches: [{half_plane: {side: west, at: 0}, area: surface}]}\n"
            "measures: [distance_on_surface]\nobjective: {minimise: distance_on_surface}\n"
        )
