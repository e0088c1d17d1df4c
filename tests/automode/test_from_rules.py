"""Rules become the machine that does the same, or what differs is told."""

from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geswarm.automode import (
    Situation,
    from_rules,
    next_situations,
    read_machines,
    to_rules,
)
from geswarm.automode.fitting import solved, ways_to_say
from geswarm.automode.modules import FLOORS
from geswarm.automode.steps import first_true
from geswarm.exports import format_automode, to_automode
from geswarm.rules import RuleSetError, parse_text
from tests.automode.machines import AAC, machines, vocabulary
from tests.automode.test_as_rules import ORDERED, SAME, too_many_orders

PLAIN = vocabulary(("enter0", "in0"))


def expressed(text, words=PLAIN):
    return from_rules(parse_text(text, "", words), words)


def words_of(conversion):
    return vocabulary(conversion.values or ("enter0", "in0"))


def uncommented(conversion):
    return replace(conversion.rule_set, comment="")


@settings(max_examples=40, deadline=None)
@given(machines())
def test_a_machine_comes_back_to_the_letter(machine):
    conversion = to_rules(machine)
    found = from_rules(conversion.rule_set, words_of(conversion))
    assert found.machine == machine
    assert found.departures == conversion.departures


@pytest.mark.parametrize("text", [AAC, ORDERED, SAME])
def test_its_rules_alone_are_enough(text):
    (machine,) = read_machines(text)
    conversion = to_rules(machine)
    found = from_rules(uncommented(conversion), words_of(conversion))
    assert found.departures == ()
    assert len(found.machine.states) == len(machine.states)
    for number in range(len(machine.states)):
        for floor in FLOORS:
            for heard in range(8):
                one, other = (
                    next_situations(
                        each,
                        Situation(number, False),
                        lambda at, floor=floor, n=heard: at.chance(floor, n),
                    )
                    for each in (machine, found.machine)
                )
                assert one == {each: pytest.approx(float(p)) for each, p in other.items()}


def test_edited_rules_become_an_edited_machine():
    (machine,) = read_machines(AAC)
    conversion = to_rules(machine)
    words = words_of(conversion)
    text = format_automode(conversion.rule_set, words)
    assert text == f"--fsm-config {AAC}\n"
    edited = replace(
        conversion.rule_set,
        rules=tuple(
            replace(rule, actions=(replace(rule.actions[0], p=0.75),))
            if rule.actions[0].p == 0.5
            else rule
            for rule in conversion.rule_set.rules
        ),
    )
    assert to_automode(edited, words).warnings == ()
    assert "--c0x0 0 --p0x0 0.75 " in format_automode(edited, words)


def test_plain_rules_have_a_state_for_each_behaviour():
    found = expressed(
        "rule while STOP do p = 1, EXPLORATION(5) "
        "rule if FLOOR == black while EXPLORATION(5) do p = 0.5, ATTRACTION(2) "
        "rule if FLOOR == white while ATTRACTION(2) do p = 0.25, EXPLORATION(5)"
    )
    assert found.departures == ()
    (wanted,) = read_machines(
        "--nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 0.5 "
        "--s1 4 --att1 2 --n1 1 --n1x0 0 --c1x0 2 --p1x0 0.25"
    )
    assert found.machine == wanted


def test_a_later_rule_that_goes_on_in_the_same_step_is_told():
    found = expressed(
        "rule if FLOOR == black while STOP do p = 0.5, ATTRACTION(2) "
        "rule if ALONE(2, 1.5) == true while ATTRACTION(2) do p = 1, STOP"
    )
    assert [(each.state, each.floor) for each in found.departures] == [(0, "black")]


def test_a_count_that_is_denied_is_the_inverted_one():
    found = expressed("rule if CROWDED(2, 1) == false while STOP do p = 1, PHOTOTAXIS")
    (transition,) = found.machine.states[0].transitions
    assert str(transition.condition) == "inverted neighbour count (xi 2, eta 1)"


def test_what_no_machine_does_is_told():
    found = expressed("rule if ALONE(2, 1) == true while STOP do p = 0.5, PHOTOTAXIS")
    assert {each.floor for each in found.departures} == set(FLOORS)
    black = found.departures[0]
    assert (black.state, black.neighbours) == (0, 0)
    assert black.rules[1] == pytest.approx(black.machine[1] / 2)
    warnings = to_automode(
        parse_text("rule if ALONE(2, 1) == true while STOP do p = 0.5, PHOTOTAXIS", "", PLAIN),
        PLAIN,
    ).warnings
    assert warnings[0] == (
        "not the same in state 0, black floor, 0 neighbours: AutoMoDe 0.1192 to 0, 0.8808 to 1; "
        "rules 0.5596 to 0, 0.4404 to 1"
    )


def test_more_orders_than_state_has_values_are_told_at_both_ends():
    (machine,) = read_machines(too_many_orders())
    conversion = to_rules(machine)
    assert from_rules(conversion.rule_set, words_of(conversion)).departures != ()


def problems(text, words=PLAIN):
    with pytest.raises(RuleSetError) as caught:
        expressed(text, words)
    return [str(each) for each in caught.value.findings]


def test_what_automode_does_not_have_is_refused():
    assert problems(
        "rule do p = 0.1, PHOTOTAXIS do p = 0.1, STOP do p = 0.1, EXPLORATION(2) "
        "do p = 0.1, ATTRACTION(2) do p = 0.1, REPULSION(2)"
    ) == [
        "AutoMoDe: expected at most 4 behaviours, got STOP, REPULSION(2), ATTRACTION(2), "
        "EXPLORATION(2), PHOTOTAXIS"
    ]
    floors = "".join(
        f"rule if FLOOR == {floor} while STOP do p = {0.1 * (at + 1):.1f}, PHOTOTAXIS "
        f"do p = {0.2 * (at + 1):.1f}, ANTI-PHOTOTAXIS "
        for at, floor in enumerate(FLOORS[:3])
    )
    floors += "rule if FLOOR == white while STOP do p = 0.5, PHOTOTAXIS"
    (problem,) = problems(floors.replace("p = 0.1, PHOTOTAXIS", "p = 0, PHOTOTAXIS"))
    assert problem.startswith("AutoMoDe: expected at most 4 transitions from stop, got ")


def test_state_that_is_used_in_another_way_is_refused():
    words = vocabulary(("enter0", "in0", "enter1", "in1"))
    enters = "rule if STATE == enter0 do p = 1, STOP do p = 1, STATE = in0 "
    assert problems("rule do p = 0.5, STATE = in0", words) == [
        "STATE: expected enter0 to start one behaviour and become in0"
    ]
    assert problems(enters + "rule if STATE == in0 do p = 0.5, PHOTOTAXIS", words) == [
        "STATE: expected in0 to keep its behaviour"
    ]
    assert problems(enters + "rule if STATE == in0 do p = 0.5, STATE = in1", words) == [
        "STATE: expected in0 to stay in0 or to become the enter of another state, got in1"
    ]
    other = vocabulary(("red", "green"))
    assert problems("rule do p = 0.5, STATE = green", other) == [
        "STATE: expected enter0, in0, enter1 and so on, the first at the start"
    ]


@given(st.lists(st.floats(0.001, 0.999), min_size=1, max_size=3))
def test_probabilities_are_found_again(chances):
    pairs = list(enumerate(chances))
    taken = {k: float(p) for k, p in first_true(pairs, permutations(range(len(pairs)))).items()}
    again = [(k, p) for k, p in solved(taken).items()]
    found = first_true(again, permutations(range(len(again))))
    assert {k: float(p) for k, p in found.items()} == {
        k: pytest.approx(p, abs=1e-6) for k, p in taken.items()
    }


def test_a_chance_on_any_floor_saves_transitions():
    chances = {floor: {1: p, 2: 0.2} for floor, p in zip(FLOORS, (0.5, 0.5, 0.75), strict=True)}
    apart, together = ways_to_say(chances)
    assert [str(each.condition) for each in apart] == [
        "black floor (p 0.5)",
        "grey floor (p 0.5)",
        "white floor (p 0.75)",
        "fixed probability (p 0.2)",
    ]
    assert [str(each.condition) for each in together] == [
        "fixed probability (p 0.5)",
        "white floor (p 0.5)",
        "fixed probability (p 0.2)",
    ]
