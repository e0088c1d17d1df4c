import dataclasses

import numpy as np
import pytest

from geswarm.rules import (
    FORAGING,
    BehaviourChange,
    ControlTable,
    Rule,
    RuleSet,
    RuleSetError,
    Space,
    StateChange,
    load_preset,
)
from geswarm.sim.scenario.model import load_scenario
from geswarm.sim.world import World

PAPER = load_scenario("paper")
EVO8, HAND_CODED = load_preset("evo8"), load_preset("hand-coded")


def same(one, other, but=()):
    one, other = vars(one), vars(other)
    return all(
        name in but or np.all(np.equal(value, other[name]))
        for name, value in one.items()
        if isinstance(value, np.ndarray | int)
    ) and ("action_counts" in but or one["action_counts"] == other["action_counts"])


def test_start():
    world = World(load_scenario("flexibility-20"), EVO8, 3)
    seen, scenario = world.state, world.scenario
    assert np.all(seen.y < -scenario.length / 2 + scenario.nest)
    assert np.ptp(seen.x) > scenario.width / 2
    assert np.all(seen.behaviour == FORAGING.behaviour_index["RANDOM_WALK"])
    assert np.all(seen.internal_states == Space.of(FORAGING).initial_states)
    assert not seen.carried.any()
    assert np.all(seen.last_rule == -1)
    gaps = np.hypot(seen.x[:, None] - seen.x, seen.y[:, None] - seen.y)[np.triu_indices(20, 1)]
    assert gaps.min() >= 0.17
    assert (world.time, world.steps, world.fitness) == (0,) * 3
    assert world.measures == {"picked": 0, "collected": 0, "lost": 0}


def test_same_seed_same_run():
    one, other, third = (World(PAPER, EVO8, seed) for seed in (1, 1, 2))
    for world in (one, other, third):
        world.step(500)
    assert same(one.state, other.state)
    assert not same(one.state, third.state)
    third.reset(1)
    assert third.seed == 1
    third.step(500)
    assert same(one.state, third.state)
    one.reset()
    assert one.steps == 0
    assert one.state.rule_counts.sum() == 0
    one.step(500)
    assert same(one.state, other.state)


def test_arrays_are_read_only_and_keep_still():
    world = World(PAPER, EVO8, 1)
    before = world.state
    with pytest.raises(ValueError, match="read-only"):
        before.x[0] = 1
    x = before.x.copy()
    world.step(50)
    assert np.array_equal(before.x, x)
    assert not np.array_equal(world.state.x, x)
    assert world.state.time == world.time == pytest.approx(5.0)


def test_new_rules_keep_everything_else():
    world = World(PAPER, EVO8, 1)
    world.step(3000)
    before = world.state
    world.set_rules(HAND_CODED)
    assert world.rule_set is HAND_CODED
    fired = ("rule_counts", "action_counts", "last_rule")
    assert same(before, world.state, but=fired)
    assert np.all(world.state.last_rule == -1)
    assert world.state.rule_counts.tolist() == [0, 0, 0, 0]
    assert world.state.action_counts == ((0,), (0, 0), (0,), (0, 0))
    world.step(10)
    assert world.state.rule_counts.sum() > 0


def test_a_rule_set_that_is_wrong_changes_nothing():
    world = World(PAPER, EVO8, 1)
    world.step(100)
    before = world.state
    with pytest.raises(RuleSetError, match="did you mean PHOTOTAXIS"):
        world.set_rules(RuleSet((Rule(actions=(BehaviourChange(1.0, "PHOTOTAXI"),)),)))
    assert world.rule_set is EVO8
    assert same(before, world.state)


def test_rules_that_are_off_keep_their_number():
    off = dataclasses.replace(EVO8.rules[0], enabled=False)
    world = World(PAPER, RuleSet((off, *EVO8.rules[1:])), 1)
    world.step(5000)
    counts = world.state.rule_counts
    assert counts[0] == 0
    assert np.all(counts[1:] > 0)
    assert set(world.state.last_rule.tolist()) <= {1, 2, 3}


def test_what_fired():
    change = Rule(actions=(BehaviourChange(1.0, "PHOTOTAXIS"), BehaviourChange(0.0, "RANDOM_WALK")))
    half = Rule(actions=(StateChange(0.5, "WANT_OBJECT", False),))
    never = Rule(behaviours=("RANDOM_WALK",), actions=(BehaviourChange(1.0, "PHOTOTAXIS"),))
    world = World(PAPER, RuleSet((change, half, never)), 1)
    world.step(1000)
    seen = world.state
    assert seen.rule_counts[0] == 4000
    assert seen.action_counts[0] == (4000, 0)
    assert 1800 < seen.rule_counts[1] < 2200
    assert seen.action_counts[1] == (seen.rule_counts[1],)
    assert seen.rule_counts[2] == 0
    assert set(seen.last_rule.tolist()) <= {0, 1}


@pytest.mark.parametrize("rule_set", [EVO8, HAND_CODED])
def test_decisions_are_drawn_as_the_control_table_says(rule_set):
    world = World(PAPER, rule_set, 1)
    for steps in (1, 20_000):
        world.step(steps)
    decisions, table = world.decisions, ControlTable.compile(rule_set).probabilities
    assert decisions.shape == table.shape
    assert decisions.sum() == 4 * 20_001
    assert not decisions[table == 0].any()
    tried = decisions.sum(axis=1, keepdims=True)
    spread = np.sqrt(tried * table * (1 - table))
    assert np.all(np.abs(decisions - tried * table) <= 4.5 * spread + 1e-6)


def test_decisions_are_counted_since_the_rules_were_set():
    world = World(PAPER, EVO8, 1)
    world.step(100)
    kept = world.decisions
    world.set_rules(HAND_CODED)
    assert not world.decisions.any()
    assert kept.sum() == 400
    world.step(10)
    world.reset()
    assert not world.decisions.any()
    with pytest.raises(ValueError, match="read-only"):
        kept[0, 0] = 1


def test_no_rules_at_all():
    world = World(PAPER, RuleSet(), 1)
    world.step(100)
    assert world.state.rule_counts.shape == (0,)
    assert world.state.action_counts == ()


def test_dragging():
    world = World(PAPER, EVO8, 1)
    world.move_robot(2, 99, -99)
    world.move_object(1, -99, 0)
    seen = world.state
    assert (seen.x[2], seen.y[2]) == pytest.approx((2.1 - 0.085, -2.1 + 0.085))
    assert seen.objects[1].tolist() == pytest.approx([-2.0, 0.1])
    world.move_object(1, 0.5, 99)
    assert world.state.objects[1].tolist() == pytest.approx([0.5, 2.0])
    world.move_robot(0, 0.5, 1.9)
    world.step()
    assert world.state.carried.tolist() == [True, False, False, False]
    with pytest.raises(IndexError, match="expected robot 0 to 3, got 4"):
        world.move_robot(4, 0, 0)
    with pytest.raises(IndexError, match="expected object 0 to 4, got -1"):
        world.move_object(-1, 0, 0)
    with pytest.raises(ValueError, match="expected finite coordinates, got"):
        world.move_robot(0, float("nan"), 0)


def test_a_scenario_changed_in_its_physics_keeps_the_run():
    world = World(PAPER, EVO8, 1)
    world.step(3000)
    before = world.state
    slow = PAPER.with_changes(max_speed=0.01, zone_miss=0.0, random_walk=(1.0, 2.0))
    assert world.set_scenario(slow)
    assert world.scenario is slow
    assert same(before, world.state)
    world.step(10)
    moved = np.hypot(world.state.x - before.x, world.state.y - before.y)
    assert 0 < moved.max() <= 0.01 + 1e-9
    assert world.steps == 3010


def test_a_scenario_that_does_not_fit_the_run_starts_again():
    for changes in ({"robots": 7}, {"objects": 3}, {"width": 3.0}, {"source": 1.0}):
        world = World(PAPER, EVO8, 1)
        world.step(3000)
        other = PAPER.with_changes(**changes)
        assert not world.set_scenario(other)
        assert same(World(other, EVO8, 1).state, world.state)
        world.step(100)


def test_kind_errors():
    with pytest.raises(ValueError, match="seed: expected 0 <= seed < 2\\*\\*63, got -1"):
        World(PAPER, EVO8, -1)
    with pytest.raises(ValueError, match="n: expected at least 0, got -1"):
        World(PAPER, EVO8).step(-1)


def test_a_robot_perceives_at_once_where_it_is_put_and_the_run_stays_the_same():
    world, twin = (World(PAPER, EVO8, 1) for _ in range(2))
    on_nest, on_source = (1 << FORAGING.precondition_index[n] for n in ("ON_NEST", "ON_SOURCE"))
    assert world.state.percepts.tolist() == [on_nest] * 4
    for steps in (0, 1, 897):
        world.step(steps)
        twin.step(steps)
        before = world.state
        for robot in range(4):
            held = 4 * before.carried[robot]
            for y, zone in ((-1.0, on_nest), (-0.3, 0), (1.0, on_source)):
                world.move_robot(robot, 0.0, y)
                assert world.state.percepts[robot] == zone + held
            world.move_robot(robot, before.x[robot], before.y[robot])
        assert same(before, world.state, but=("percepts",))
        world.step(1)
        twin.step(1)
        assert same(twin.state, world.state)
    assert before.carried.any()
