"""State machines as AutoMoDe runs them (Francesca et al. 2014), as control tables.

A situation's outcome is a distribution like that of rules: of a state and whether it has just been
entered, which are numbered as behaviours are.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from functools import partial

import numpy as np
import numpy.typing as npt

from geswarm.automode import Condition, Machine, Situation, next_situations
from geswarm.rules.model import Term
from geswarm.sim.terms import automode
from geswarm.sim.terms.parts import Parts


class ControllerError(ValueError):
    """A controller of AutoMoDe cannot run here; the message says why."""


def instances_of(machine: Machine, parts: Parts) -> tuple[Term, ...]:
    """The behaviours of a machine's states: just entered and later, the first state's at the start.

    Raises:
        ControllerError: A behaviour is not on offer or takes other arguments.
    """
    terms = [state.behaviour.term for state in machine.states for _ in range(2)]
    require_offered(terms, parts)
    terms += [terms[0]] * max(0, parts.first_instance + 1 - len(terms))
    order = _order(len(terms), parts)
    return tuple(terms[at] for at in order)


def require_offered(terms: Iterable[Term], parts: Parts) -> None:
    """Raise ControllerError unless a scenario has these behaviours, with as many arguments."""
    for term in terms:
        kind = parts.kinds.get(term.name)
        if kind is None:
            raise ControllerError(f"{term.name} is not on offer in {parts.name}")
        expected = len(parts.behaviours[kind].arguments)
        if len(term.arguments) != expected:
            raise ControllerError(
                f"{term.name}: expected {expected} arguments, got {term.arguments}"
            )


def _order(number: int, parts: Parts) -> list[int]:
    """The numbers of instances, that of the first state just entered being where robots begin."""
    order = list(range(number))
    first = parts.first_instance
    order[0], order[first] = order[first], order[0]
    return order


def states_of(machine: Machine, parts: Parts) -> npt.NDArray[np.int64]:
    """The state that each instance stands for, int64, shape (instances,)."""
    order = _order(len(instances_of(machine, parts)), parts)
    states = np.zeros(len(order), dtype=np.int64)
    for at in range(2 * len(machine.states)):
        states[order[at]] = at // 2
    return states


def outcomes_of(machine: Machine, parts: Parts, number: int) -> npt.NDArray[np.float64]:
    """Outcome distributions of each code and instance, see `kernels.tabulate`.

    Args:
        machine: What to tabulate.
        parts: What the scenario is composed of.
        number: How many instances there are to be room for.

    Returns:
        Shape (codes, number, 2 * number * states of the registers).
    """
    order = _order(len(instances_of(machine, parts)), parts)
    table = np.zeros((parts.codes, number, number, parts.states, 2))
    for code in range(parts.codes):
        floor, heard = perceived(parts, code)
        chance = partial(chance_of, floor, heard)
        for at, first in itertools.product(range(len(machine.states)), (True, False)):
            here = order[2 * at + (not first)]
            for then, share in next_situations(machine, Situation(at, first), chance).items():
                to = order[2 * then.state + (not then.first)]
                table[code, here, to, 0, int(then.first)] += float(share)
    return table.reshape(parts.codes, number, -1)


def chance_of(floor: str, heard: int, condition: Condition) -> float:
    """The probability that a condition is true for these readings."""
    return condition.chance(floor, heard)


def perceived(parts: Parts, code: int) -> tuple[str, int]:
    """Floor and messages of a code of readings."""
    found = {automode.floor_below: 0, automode.messages: 0}
    for sensor in parts.sensors:
        code, reading = divmod(code, sensor.values)
        if sensor in found:
            found[sensor] = reading
    return automode.FLOORS[found[automode.floor_below]], found[automode.messages]
