"""Control tables for any terms against the exact ones: arguments, counters, named registers."""

import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from geswarm.rules import ControlTable, RuleSetError, Space
from geswarm.sim import World, parts_of
from geswarm.sim.controllers.program import Instances
from geswarm.sim.controllers.spaces import sensed_values, state_values
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.kernels.table import ROW_BEHAVIOURS
from tests.sim.terms.scenarios import COUNTING, MEETING, REMEMBERING, SENSING, rule_sets

scenarios = pytest.mark.parametrize(
    "scenario", [REMEMBERING, SENSING, MEETING], ids=lambda scenario: scenario.name
)


def few(examples):
    """Of what takes long; shrinking would take longer."""
    unhurried = list(HealthCheck)
    return settings(
        max_examples=examples, deadline=None, phases=[Phase.generate],
        suppress_health_check=unhurried,
    )  # fmt: skip


def code_of(parts, sensed, state):
    """The code of readings that are sensed or, of registers, known."""
    code, size = 0, 1
    for sensor in parts.sensors:
        registers = [each for each in parts.registers if each.seen_by is sensor]
        if registers:
            (register,) = registers
            reading = (state & parts.mask(register)) >> parts.shifts[register.name]
        else:
            sensed, reading = divmod(sensed, sensor.values)
        code, size = code + reading * size, size * sensor.values
    return code


def drawn(controllers, code, instance, state):
    """{(instance, registers, restart): probability} that a table draws."""
    tables, parts = controllers.tables, controllers.parts
    first_code, first_row, _ = tables.begins[0]
    row = first_row + ROW_BEHAVIOURS * int(tables.classes[first_code + code]) + instance
    first_slot, bits = divmod(int(tables.rows[row]), 8)
    found = {}
    for slot in range(first_slot, first_slot + (1 << bits)):
        share = int(tables.thresholds[slot]) / 2**32
        outcomes = tables.outcomes[2 * slot :][:2].tolist()
        for outcome, p in zip(outcomes, (share, 1 - share), strict=True):
            key = outcome >> 1 & 31, registers_after(parts, state, outcome), outcome & 1
            found[key] = found.get(key, 0.0) + p / (1 << bits)
    return found


def registers_after(parts, state, outcome):
    after = state & ~(outcome >> 6 & 255) | outcome >> 14 & 255
    if parts.counter is None:
        return after
    shift = parts.shifts[parts.counter.name]
    added, least, most = (outcome >> 22 & 15) - 8, outcome >> 26 & 7, outcome >> 29 & 7
    counter = min(max((after >> shift & 7) + added, least), most)
    return after & ~(7 << shift) | counter << shift


def number_of_states(space, parts, state):
    values = state_values(parts, state)
    return space.state_values.index(tuple(values[each.name] for each in space.internal_states))


def expected(table, parts, terms, sensed, state, instance):
    """The same as `drawn`, from the exact table."""
    space = table.space
    percept = space.percept(state_values(parts, state) | sensed_values(parts, sensed))
    behaviour = space.behaviours.index(terms[instance])
    row = table.probabilities[
        space.situation(percept, behaviour, number_of_states(space, parts, state))
    ]
    return {outcome: row[outcome] for outcome in np.flatnonzero(row).tolist()}


def states_of(parts, space):
    """All states at the start of a step; what is momentary or not in the space is as initially."""
    known = {each.name for each in space.internal_states}
    choices = [
        range(each.values) if each.word.name in known and not each.momentary else [each.initially]
        for each in parts.registers
    ]
    shifts = [parts.shifts[each.name] for each in parts.registers]
    for chosen in itertools.product(*choices):
        yield sum(value << shift for value, shift in zip(chosen, shifts, strict=True))


def exact_table(rule_set, vocabulary):
    """The exact table, if that is soon made."""
    try:
        space = Space.of(vocabulary, rule_set)
    except RuleSetError:
        assume(False)
    assume(space.situations * space.outcomes < 300_000)
    return ControlTable.within(space, rule_set)


@scenarios
@given(data=st.data(), miss=st.sampled_from([0.0, 0.2, 1.0]))
@few(12)
def test_a_table_draws_what_the_rules_say(scenario, data, miss):
    parts = parts_of(scenario)
    rule_set = data.draw(rule_sets(parts.vocabulary))
    exact = exact_table(rule_set, parts.vocabulary)
    fails = [miss if sensor.fails else 0.0 for sensor in parts.sensors]
    assert parts.sensors[0].fails == "zone_miss"
    controllers = compile_controllers([rule_set], fails, parts)
    terms = list(Instances.of(rule_set, parts).terms)
    states = list(states_of(parts, exact.space))
    places = st.tuples(st.integers(0, parts.sensed_codes - 1), st.sampled_from(states))
    for sensed, state in data.draw(st.lists(places, min_size=8, max_size=8)):
        for term in set(exact.space.behaviours) & set(terms):  # no action starts the others
            at = terms.index(term)
            found = {}
            for key, p in drawn(controllers, code_of(parts, sensed, state), at, state).items():
                instance, registers, restart = key
                behaviour = exact.space.behaviours.index(terms[instance])
                number = number_of_states(exact.space, parts, registers)
                found[exact.space.outcome(behaviour, number, restart)] = p
            missed = sensed - sensed % parts.sensors[0].values
            noticed, unnoticed = (
                expected(exact, parts, terms, each, state, at) for each in (sensed, missed)
            )
            for outcome in {*found, *noticed, *unnoticed}:
                p = (1 - miss) * noticed.get(outcome, 0) + miss * unnoticed.get(outcome, 0)
                assert found.get(outcome, 0) == pytest.approx(p, abs=2.0**-20)
                assert p > 0 or found.get(outcome, 0) == 0


@pytest.mark.parametrize("scenario", [COUNTING, MEETING], ids=lambda scenario: scenario.name)
@given(data=st.data(), seed=st.integers(0, 2**32))
@few(8)
def test_worlds_come_from_situations_to_outcomes_as_often_as_the_rules_say(scenario, data, seed):
    vocabulary = parts_of(scenario).vocabulary
    rule_set = data.draw(rule_sets(vocabulary))
    exact = exact_table(rule_set, vocabulary)
    world = World(scenario, rule_set, seed)
    world.step(100)
    counted = world.decisions
    assert counted.sum() == 100 * scenario.robots
    assert not counted[exact.probabilities == 0].any()
    rows = np.flatnonzero(counted.sum(axis=1))
    mean = counted[rows].sum(axis=1, keepdims=True) * exact.probabilities[rows]
    apart = np.abs(counted[rows] - mean)
    assert np.all(apart <= 6 * np.sqrt(mean * (1 - exact.probabilities[rows])) + 6)
