"""Rules that stand for a machine come to its distribution, whatever a robot senses."""

from collections import defaultdict
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.automode import Situation, next_situations, read_machines, to_rules
from geswarm.automode.as_rules import COMMENT, MOST_VALUES
from geswarm.automode.drawing import REGISTER
from geswarm.automode.modules import FLOORS, NEIGHBOUR_COUNTS, crowded_chance
from geswarm.rules import ControlTable, parse_yaml
from geswarm.rules.anything import ANYTHING
from geswarm.rules.model import BehaviourChange
from geswarm.rules.yaml_form import format_yaml
from tests.automode.machines import AAC, machines, vocabulary

ORDERED = (
    "--nstates 3 --s0 1 --n0 4 --n0x0 0 --c0x0 3 --p0x0 2 --w0x0 1.5 --n0x1 1 --c0x1 4 --p0x1 3 "
    "--w0x1 0.5 --n0x2 1 --c0x2 0 --p0x2 0.3 --n0x3 0 --c0x3 5 --p0x3 0.2 --s1 2 --s2 3"
)
CROWDED_OUT = " ".join(
    [
        "--nstates 2 --s0 2 --n0 4",
        *(f"--n0x{at} 0 --c0x{at} 3 --p0x{at} {at + 1} --w0x{at} 2" for at in range(4)),
        "--s1 1",
    ]
)
SAME = "--nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 5 --p0x0 .5 --s1 0 --rwm1 5"


def chance(precondition, value, floor, neighbours):
    """The probability that a precondition of a rule holds."""
    name, arguments = precondition.percept.name, precondition.percept.arguments
    if name == REGISTER:
        return float(value == precondition.value)
    if name == "FLOOR":
        return float(floor == precondition.value)
    crowded = crowded_chance(*arguments, neighbours)
    assert precondition.value is True
    return {"CROWDED": crowded, "ALONE": 1 - crowded}[name]


def outcomes(rule_set, value, behaviour, floor, neighbours):
    """What rules do in a step: {(STATE, behaviour, behaviours begun afresh): probability}.

    Rules see STATE as it was when the step began; each rule is active by chance, and each of its
    actions is drawn on its own.
    """
    found = {(value, behaviour, False): 1.0}
    for rule in rule_set.rules:
        active = 1.0
        for each in rule.preconditions:
            active *= chance(each, value, floor, neighbours)
        assert not rule.behaviours
        if not active:
            continue
        done = {each: p * active for each, p in found.items()}
        for action in rule.actions:
            drawn = defaultdict(float)
            for (state, doing, afresh), p in done.items():
                drawn[state, doing, afresh] += p * (1 - action.p)
                if isinstance(action, BehaviourChange):
                    changed = action.behaviour != doing
                    drawn[state, action.behaviour, afresh or changed] += p * action.p
                else:
                    drawn[action.value, doing, afresh] += p * action.p
            done = drawn
        mixed = defaultdict(float, {each: p * (1 - active) for each, p in found.items()})
        for each, p in done.items():
            mixed[each] += p
        found = {each: p for each, p in mixed.items() if p}
    return found


def insides(conversion, number):
    return [each for each in conversion.values if each.startswith(f"in{number}")]


def require_same(machine, conversion, floor, neighbours):
    """In each state of the machine, and each value of STATE that stands for it."""
    rules = conversion.rule_set
    for number, state in enumerate(machine.states):
        doing = state.behaviour.term
        for value in (f"enter{number}", *insides(conversion, number)):
            first = value.startswith("enter")
            if not first:
                assert {each[1:] for each in outcomes(rules, value, doing, floor, neighbours)} == {
                    (doing, False)
                }
        wanted = next_situations(
            machine, Situation(number, False), lambda each: each.chance(floor, neighbours)
        )
        drawn = defaultdict(float)
        for value in insides(conversion, number):
            for (after, _, _), p in outcomes(rules, value, doing, floor, neighbours).items():
                drawn[after] += p / len(insides(conversion, number))
        stays = sum(drawn.pop(each, 0.0) for each in insides(conversion, number))
        assert stays == pytest.approx(float(wanted.pop(Situation(number, False), 0)), abs=1e-12)
        for each in drawn.keys() | {f"enter{each.state}" for each in wanted}:
            leaves = float(wanted.get(Situation(int(each[-1]), True), 0))
            assert drawn[each] == pytest.approx(leaves, abs=1e-12), each


@settings(max_examples=40, deadline=None)
@given(machines(), st.sampled_from(FLOORS), st.integers(0, 20))
def test_exact_conversions_do_the_same(machine, floor, neighbours):
    conversion = to_rules(machine)
    if len(machine.states) > 1 and conversion.exact:
        require_same(machine, conversion, floor, neighbours)


@pytest.mark.parametrize("text", [AAC, ORDERED, CROWDED_OUT, SAME])
@pytest.mark.parametrize("floor", FLOORS)
def test_these_are_exact(text, floor):
    (machine,) = read_machines(text)
    conversion = to_rules(machine)
    assert conversion.exact
    for neighbours in range(12):
        require_same(machine, conversion, floor, neighbours)


def test_the_order_of_neighbour_counts_is_drawn_a_step_ahead():
    (machine,) = read_machines(ORDERED)
    conversion = to_rules(machine)
    assert conversion.register == "STATE(enter0, in0a, in0b, enter1, in1, enter2, in2)"
    for value in ("enter0", "in0a", "in0b"):
        found = outcomes(conversion.rule_set, value, machine.states[0].behaviour.term, "grey", 2)
        drawn = [sum(p for each, p in found.items() if each[0] == f"in0{x}") for x in "ab"]
        assert drawn[0] == pytest.approx(drawn[1])
        assert drawn[0] > 0.05


def test_entering_starts_the_behaviour_at_once_and_looks_at_nothing():
    (machine,) = read_machines(AAC)
    rules = to_rules(machine).rule_set
    for number, state in enumerate(machine.states):
        for before in (each.behaviour.term for each in machine.states):
            doing = state.behaviour.term
            found = outcomes(rules, f"enter{number}", before, "black", 19)
            assert found == {(f"in{number}", doing, doing != before): 1}


def test_exploration_begins_afresh_in_another_state():
    (machine,) = read_machines(SAME)
    doing = machine.states[0].behaviour.term
    found = outcomes(to_rules(machine).rule_set, "enter1", doing, "grey", 0)
    assert found == {("in1", doing, True): 1}


def test_one_state_needs_no_register():
    (machine,) = read_machines("--nstates 1 --s0 4 --att0 2.50")
    conversion = to_rules(machine, "mine", "aac")
    assert (conversion.values, conversion.register, conversion.exact) == ((), "", True)
    (rule,) = conversion.rule_set.rules
    assert str(rule.actions[0]) == "p = 1, ATTRACTION(2.5)"
    assert (conversion.rule_set.name, conversion.rule_set.scenario) == ("mine", "aac")


def too_many_orders():
    count = "--c{0} {1} --p{0} {2} --w{0} 3"
    parts = ["--nstates 3 --s0 1 --n0 4"]
    for at in range(4):
        name = f"0x{at}"
        parts.append(f"--n{name} {at % 2} " + count.format(name, 3 + at % 2, at + 1))
    return " ".join([*parts, "--s1 2", "--s2 3"])


def test_where_state_would_have_too_many_values_the_difference_is_told():
    (machine,) = read_machines(too_many_orders())
    conversion = to_rules(machine)
    assert not conversion.exact
    assert len(conversion.values) == 6 <= MOST_VALUES
    for departure in conversion.departures:
        here = Situation(departure.state, False)
        exact = next_situations(
            machine,
            here,
            lambda each, at=departure: each.chance(at.floor, at.neighbours),
        )
        assert departure.machine == {each.state: pytest.approx(p) for each, p in exact.items()}
        rules = defaultdict(float)
        doing = machine.states[departure.state].behaviour.term
        found = outcomes(
            conversion.rule_set,
            f"in{departure.state}",
            doing,
            departure.floor,
            departure.neighbours,
        )
        for (value, _, _), p in found.items():
            rules[int(value[-1])] += p
        assert {k: p for k, p in departure.rules.items() if p > 1e-12} == {
            k: pytest.approx(p) for k, p in rules.items() if p > 1e-12
        }
        assert 0 < departure.distance <= 1
        told = f"state 0, {departure.floor} floor, {departure.neighbours} neighbours: AutoMoDe "
        assert str(departure).startswith(told)


def test_rules_are_written_and_read_again():
    (machine,) = read_machines(ORDERED)
    rules = to_rules(machine, "ordered").rule_set
    assert parse_yaml(format_yaml(rules), "", ANYTHING) == rules
    assert read_machines(rules.comment.removeprefix(COMMENT)) == (machine,)
    firsts = [each for each in rules.rules if each.comment]
    assert [each.comment for each in firsts][:2] == ["State 0: stop", "State 1: phototaxis"]


@settings(max_examples=20, deadline=None)
@given(
    machines(3).filter(
        lambda machine: (
            len(machine.states) > 1
            and all(
                each.condition.number not in NEIGHBOUR_COUNTS
                for state in machine.states
                for each in state.transitions
            )
        )
    )
)
def test_the_control_table_is_the_machine(machine):
    conversion = to_rules(machine)
    table = ControlTable.compile(conversion.rule_set, vocabulary(conversion.values))
    space = table.space
    assert space.internal_states[0].values == conversion.values
    for number, state in enumerate(machine.states):
        doing = space.behaviours.index(state.behaviour.term)
        for floor in FLOORS if len(space.readings) > 1 else FLOORS[:1]:
            sensed = {REGISTER: f"in{number}", "floor": floor}
            at = space.situation(
                space.percept(sensed), doing, conversion.values.index(f"in{number}")
            )
            wanted = np.zeros(space.outcomes)
            here = Situation(number, False)
            for each, p in next_situations(
                machine, here, lambda each, floor=floor: each.chance(floor, 0)
            ).items():
                value = f"{'enter' if each.first else 'in'}{each.state}"
                wanted[space.outcome(doing, conversion.values.index(value))] = p
            np.testing.assert_allclose(table.probabilities[at], wanted, atol=1e-12)


def test_a_run_under_rules_is_a_run_of_the_machine():
    """The distribution over (state, first step) after each of twenty steps, from the start."""
    (machine,) = read_machines(ORDERED)
    conversion = to_rules(machine)
    terms = [state.behaviour.term for state in machine.states]
    ours = {(conversion.values[0], terms[1]): 1.0}
    theirs = {Situation(0, True): 1.0}
    rng = np.random.default_rng(4)
    for _ in range(20):
        floor, neighbours = rng.choice(FLOORS), int(rng.integers(0, 6))
        after = defaultdict(float)
        acted, wanted = defaultdict(float), defaultdict(float)
        for (value, doing), p in ours.items():
            for (then, does, _), q in outcomes(
                conversion.rule_set, value, doing, floor, neighbours
            ).items():
                after[then, does] += p * q
                acted[does] += p * q
        following = defaultdict(float)
        for here, p in theirs.items():
            wanted[terms[here.state]] += p
            for then, q in next_situations(
                machine,
                here,
                lambda each, floor=floor, n=neighbours: each.chance(floor, n),
            ).items():
                following[then] += p * float(q)
        assert acted == {each: pytest.approx(p) for each, p in wanted.items()}
        ours, theirs = dict(after), dict(following)


def test_orders_of_one_state_are_all_of_them():
    (machine,) = read_machines(ORDERED)
    values = insides(to_rules(machine), 0)
    assert all(a < b for a, b in pairwise(values))
