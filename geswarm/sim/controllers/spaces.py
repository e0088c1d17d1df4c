"""What the numbers of a simulator stand for in a `Space`: sensed, done, remembered."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import Term, Value
from geswarm.rules.space import Space
from geswarm.sim.terms.parts import Parts

Numbers = npt.NDArray[np.int64]


def readings_of(parts: Parts, code: int) -> list[int]:
    """The readings of the sensors that make up a code."""
    readings = []
    for sensor in parts.sensors:
        code, reading = divmod(code, sensor.values)
        readings.append(reading)
    return readings


def state_values(parts: Parts, state: int) -> dict[str, Value]:
    """The values of the registers that make up a robot's state; a value beyond the last is that."""
    values: dict[str, Value] = {}
    for register in parts.registers:
        position = (state & parts.mask(register)) >> parts.shifts[register.name]
        values[register.word.name] = register.word.values[min(position, register.values - 1)]
    return values


def sensed_values(parts: Parts, code: int) -> dict[str, Value]:
    """What robots perceive with a code of sensed readings: the value of each reading, by name.

    What they remember is not sensed, see `state_values`.
    """
    readings = dict(zip(parts.sensors, readings_of(parts, code), strict=True))
    remembered = {register.seen_by for register in parts.registers}
    return {
        percept.word.reading or percept.word.name: percept.value(readings[percept.sensor])
        for percept in parts.percepts
        if percept.sensor not in remembered
    }


@lru_cache(maxsize=256)
def percepts_of_codes(parts: Parts, space: Space, state: int | None = None) -> Numbers:
    """For each code of sensed readings the number of what is perceived.

    Args:
        parts: What the scenario is composed of.
        space: What numbers it.
        state: Of the registers, for what rules read of them; None for that at the start.
    """
    own = state_values(parts, parts.first_state if state is None else state)
    return np.array(
        [space.percept(own | sensed_values(parts, code)) for code in range(parts.sensed_codes)],
        dtype=np.int64,
    )


def states_of_bits(parts: Parts, space: Space) -> Numbers:
    """For each state of a robot the number of its internal states."""
    numbers = {values: number for number, values in enumerate(space.state_values)}
    found = []
    for state in range(parts.states):
        values = state_values(parts, state)
        found.append(numbers[tuple(values[entry.name] for entry in space.internal_states)])
    return np.array(found, dtype=np.int64)


def behaviours_of(terms: Sequence[Term], space: Space) -> Numbers:
    """For each behaviour its number, -1 for one that the space does not tell apart."""
    known = {term: at for at, term in enumerate(space.behaviours)}
    return np.array([known.get(term, -1) for term in terms], dtype=np.int64)


def counted_in(space: Space, decisions: Numbers, terms: Sequence[Term], parts: Parts) -> Numbers:
    """Decisions that a kernel has counted, as a space numbers them.

    Args:
        space: How to number them.
        decisions: Shape (sensed codes, instances, states, instances, states, 2): from where to
            where, and whether the behaviour starts afresh.
        terms: The instances.
        parts: What the scenario is composed of.

    Returns:
        int64, shape (situations, outcomes).
    """
    states, behaviours = states_of_bits(parts, space), behaviours_of(terms, space)
    counted = np.zeros((space.situations, space.outcomes), dtype=np.int64)
    percepts: dict[int, Numbers] = {}
    for place in np.argwhere(decisions):
        code, before, state, after, became, restart = place.tolist()
        if state not in percepts:
            percepts[state] = percepts_of_codes(parts, space, state)
        situation = space.situation(percepts[state][code], behaviours[before], states[state])
        outcome = space.outcome(behaviours[after], states[became], restart)
        if behaviours[before] >= 0 and behaviours[after] >= 0:
            counted[situation, outcome] += decisions[tuple(place)]
    return counted
