from collections import defaultdict

import numpy as np
import pytest
from hypothesis import given, settings

from geswarm.rules import RuleSet, RuleSetError, StateMachine, load_preset, parse_text
from geswarm.sim import World, load_scenario
from tests import strategies
from tests.rules import oracle

HAND_CODED = """
PHOTOTAXIS to ANTI-PHOTOTAXIS when HAS_OBJECT and not ON_NEST: p = 1, at once [3]
PHOTOTAXIS to RANDOM_WALK when ON_SOURCE and not HAS_OBJECT: p = 1, at once [2]
PHOTOTAXIS to RANDOM_WALK when ON_NEST and HAS_OBJECT: p = 1, at once; drop the object [3 4]
ANTI-PHOTOTAXIS to RANDOM_WALK when ON_NEST: p = 1, at once; drop the object [4]
RANDOM_WALK to PHOTOTAXIS when not ON_SOURCE and not HAS_OBJECT: p = 1, at once [1]
RANDOM_WALK to ANTI-PHOTOTAXIS when HAS_OBJECT and not ON_NEST: p = 1, at once [3]
RANDOM_WALK to RANDOM_WALK when ON_NEST and HAS_OBJECT: p = 1, at once; drop the object; \
start walking at random afresh [3 4]
"""

EVO8 = """
PHOTOTAXIS to PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.044955, 2.2 s; drop the object [1 2]
PHOTOTAXIS to ANTI-PHOTOTAXIS when HAS_OBJECT and not ON_NEST: p = 0.1, 1 s [1 3]
PHOTOTAXIS to ANTI-PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.095855, 1 s [3 4]
PHOTOTAXIS to ANTI-PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.005045, 20 s; drop the object \
[1 2 3 4]
PHOTOTAXIS to RANDOM_WALK when not ON_NEST and not HAS_OBJECT: p = 0.05, 2 s [1]
PHOTOTAXIS to RANDOM_WALK when HAS_OBJECT and not ON_NEST: p = 0.045, 2.2 s [1]
ANTI-PHOTOTAXIS to PHOTOTAXIS when ON_NEST and not HAS_OBJECT: p = 1, at once [2]
ANTI-PHOTOTAXIS to PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.8991, 0.11 s; drop the object [2]
ANTI-PHOTOTAXIS to ANTI-PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.1009, 1 s; drop the object \
[2 3 4]
RANDOM_WALK to PHOTOTAXIS when ON_NEST and not HAS_OBJECT: p = 1, at once [2]
RANDOM_WALK to PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.8991, 0.11 s; drop the object [2]
RANDOM_WALK to ANTI-PHOTOTAXIS when HAS_OBJECT and not ON_NEST: p = 0.1, 1 s [3]
RANDOM_WALK to ANTI-PHOTOTAXIS when ON_NEST and HAS_OBJECT: p = 0.1009, 1 s; drop the object \
[2 3 4]
"""


@pytest.mark.parametrize(("preset", "expected"), [("hand-coded", HAND_CODED), ("evo8", EVO8)])
def test_the_papers_rule_sets_by_hand(preset, expected):
    """Worked out by hand from the paper's Tables 1 and 2, rule by rule."""
    machine = StateMachine.of(load_preset(preset))
    assert [state.label for state in machine.states if state.initial] == ["RANDOM_WALK"]
    assert len(machine.states) == 3
    lines = [
        f"{machine.describe(entry)} [{' '.join(map(str, entry.rules))}]"
        for entry in machine.transitions
    ]
    assert lines == expected.strip().splitlines()


@settings(max_examples=60)
@given(strategies.plain_rule_sets(max_rules=3, probabilities=strategies.any_probabilities))
def test_the_machine_does_what_the_rules_do(rule_set):
    """In every situation that a run can come to: all outcomes, found draw by draw."""
    machine = StateMachine.of(rule_set)
    for percepts, behaviour, states in oracle.reachable(rule_set):
        source = state_index(machine, behaviour, states)
        expected = defaultdict(float)
        for outcome, p in oracle.outcomes(rule_set, percepts, behaviour, states).items():
            after, true_states, restarted = outcome
            dropped = "DROP_OBJECT" in true_states and percepts["HAS_OBJECT"]
            target = state_index(machine, after, true_states)
            restarts = restarted and after == behaviour
            expected[target, dropped, restarts] += float(p)
        found = defaultdict(float)
        for entry in machine.transitions_from(source):
            if entry.condition.holds(percepts):
                found[entry.target, bool(entry.effects), entry.restarts] += entry.probability
        found[source, False, False] = 1 - sum(found.values())
        for event in set(expected) | set(found):
            assert found[event] == pytest.approx(expected[event], abs=1e-9), (event, percepts)


def state_index(machine, behaviour, true_states):
    (index,) = (
        at
        for at, state in enumerate(machine.states)
        if str(state.behaviour) == behaviour
        and all((name in true_states) == value for name, value in state.internal)
    )
    return index


@given(strategies.plain_rule_sets())
def test_every_transition_has_a_rule_and_a_way_to_happen(rule_set):
    machine = StateMachine.of(rule_set)
    assert len(set(machine.transitions)) == len(machine.transitions)
    for entry in machine.transitions:
        assert entry.rules
        assert set(entry.rules) <= set(range(1, len(rule_set.rules) + 1))
        assert 0 < entry.probability <= 1
        assert entry.mean_wait == pytest.approx(0.1 / entry.probability)
        assert entry.condition.terms
        assert entry.source != entry.target or entry.effects or entry.restarts


@settings(max_examples=8, deadline=None)
@given(strategies.plain_rule_sets())
def test_transitions_are_counted_as_robots_are_seen_to_take_them(rule_set):
    machine = StateMachine.of(rule_set)
    world = World(load_scenario("flexibility-10"), rule_set, seed=1)
    seen = np.zeros((12, 12), dtype=int)
    before = world.state
    for _ in range(200):
        world.step()
        after = world.state
        columns = [
            each.behaviour.astype(int) * 4 + each.internal_states for each in (before, after)
        ]
        np.add.at(seen, tuple(columns), 1)
        counted = machine.robots_in_states(*world.numbers_in(machine.space))
        assert counted.tolist() == [np.sum(columns[1] == each.column) for each in machine.states]
        before = after
    taken = machine.times_taken(world.decisions)
    for (source, target), group in machine.between.items():
        total = sum(taken[machine.transitions.index(entry)] for entry in group)
        there = machine.states[source].column, machine.states[target].column
        assert total == seen[there] or (source == target and total <= seen[there])
    dropped = sum(taken[at] for at, entry in enumerate(machine.transitions) if entry.effects)
    assert dropped == before.measures["collected"] + before.measures["lost"]
    assert np.trace(seen) + taken.sum() >= seen.sum()


def test_robots_that_the_rules_would_never_lead_there_are_in_no_state():
    machine = StateMachine.of(load_preset("hand-coded"))
    behaviour = np.array([0, 0, 1, 2], dtype=np.uint8)
    assert machine.robots_in_states(behaviour, np.array([1, 0, 1, 1])).tolist() == [1, 1, 1]


def test_internal_states_split_behaviours_only_where_they_change():
    machine = StateMachine.of(
        parse_text(
            "rule if ON_NEST == true do p = 0.1, WANT_OBJECT = false "
            "rule if ON_SOURCE == true do p = 1, WANT_OBJECT = true"
        )
    )
    assert [state.label for state in machine.states] == [
        "RANDOM_WALK, not WANT_OBJECT",
        "RANDOM_WALK, WANT_OBJECT",
    ]
    assert [state.initial for state in machine.states] == [False, True]
    assert [machine.describe(entry) for entry in machine.transitions] == [
        "RANDOM_WALK, not WANT_OBJECT to RANDOM_WALK, WANT_OBJECT when ON_SOURCE: p = 1, at once",
        "RANDOM_WALK, WANT_OBJECT to RANDOM_WALK, not WANT_OBJECT when ON_NEST: p = 0.1, 1 s",
    ]


def test_rules_that_are_switched_off_keep_their_numbers():
    machine = StateMachine.of(
        parse_text("rule off do p = 1, PHOTOTAXIS  rule do p = 0.5, PHOTOTAXIS")
    )
    assert [entry.rules for entry in machine.transitions] == [(2,)]


def test_no_rules_no_transitions():
    machine = StateMachine.of(RuleSet())
    assert [state.label for state in machine.states] == ["RANDOM_WALK"]
    assert machine.transitions == ()
    assert "RANDOM_WALK" in machine._repr_html_()


def test_unknown_names_are_refused():
    rule_set = load_preset("evo8")
    behaviours = ("DANCE",)
    wrong = rule_set.__class__((rule_set.rules[0].__class__(behaviours=behaviours),))
    with pytest.raises(RuleSetError, match="DANCE"):
        StateMachine.of(wrong)
