"""State machines as AutoMoDe runs them (Francesca et al. 2014), as control tables.

In a step the behaviour of the state acts first. Then the state's transitions are looked at in a
random order, and the first whose condition holds is taken; in the first step of a state none is
looked at. Conditions hold with a probability that depends on what the robot perceives, so a
situation's outcome is a distribution like that of rules: of a state and whether it has just been
entered, which are numbered as behaviours are.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import Term
from geswarm.sim.kernels.table import ROW_BEHAVIOURS
from geswarm.sim.terms import automode
from geswarm.sim.terms.automode import chance_of_neighbours
from geswarm.sim.terms.parts import Parts

MOST_STATES = ROW_BEHAVIOURS // 2


@dataclass(frozen=True)
class Transition:
    """A way out of a state.

    Attributes:
        condition: "black", "grey", "white" (floor), "neighbours", "few-neighbours" (the inverted
            count) or "fixed".
        target: Index of the state that it leads to.
        p: Probability; of neighbour counts the number xi.
        w: Of neighbour counts the steepness eta.
    """

    condition: str
    target: int
    p: float
    w: float = 0.0


@dataclass(frozen=True)
class State:
    """A state: a behaviour, with its argument if it takes one, and the ways out."""

    behaviour: Term
    transitions: tuple[Transition, ...] = ()


@dataclass(frozen=True)
class Machine:
    """A finite-state machine; it begins with its first state.

    Raises:
        ValueError: There are no states or too many, a transition leads nowhere, or its condition is
            not known.
    """

    states: tuple[State, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.states) <= MOST_STATES:
            raise ValueError(f"expected 1 to {MOST_STATES} states, got {len(self.states)}")
        for number, state in enumerate(self.states):
            for each in state.transitions:
                if not 0 <= each.target < len(self.states):
                    raise ValueError(f"state {number}: there is no state {each.target}")
                if each.condition not in _CONDITIONS:
                    known = ", ".join(_CONDITIONS)
                    raise ValueError(f"state {number}: expected {known}, got {each.condition}")


_COLOURS = {"grey": 0, "black": 1, "white": 2}
_CONDITIONS = (*_COLOURS, "neighbours", "few-neighbours", "fixed")


def _chance(transition: Transition, floor: int, heard: int) -> float:
    """With which probability a transition's condition holds, of a floor and so many messages."""
    if transition.condition == "fixed":
        return transition.p
    if transition.condition in _COLOURS:
        return transition.p if floor == _COLOURS[transition.condition] else 0.0
    many = chance_of_neighbours(heard, transition.p, transition.w)
    return many if transition.condition == "neighbours" else 1.0 - many


def shares_in_random_order(chances: Sequence[float]) -> list[float]:
    """How often each of some events is the first one to happen, looked at in a random order.

    Args:
        chances: With which probability each happens.
    """
    shares = [0.0] * len(chances)
    orders = list(itertools.permutations(range(len(chances))))
    for order in orders:
        left = 1.0 / len(orders)
        for at in order:
            shares[at] += left * chances[at]
            left *= 1.0 - chances[at]
    return shares


def instances_of(machine: Machine, parts: Parts) -> tuple[Term, ...]:
    """The behaviours of a machine's states: just entered and later, the first state's at the start.

    Raises:
        ValueError: A behaviour is not on offer or takes other arguments.
    """
    terms = [state.behaviour for state in machine.states for _ in range(2)]
    for term in terms:
        kind = parts.kinds.get(term.name)
        if kind is None:
            raise ValueError(f"{term.name} is not on offer in {parts.name}")
        expected = len(parts.behaviours[kind].arguments)
        if len(term.arguments) != expected:
            raise ValueError(f"{term.name}: expected {expected} arguments, got {term.arguments}")
    terms += [terms[0]] * max(0, parts.first_instance + 1 - len(terms))
    order = _order(len(terms), parts)
    return tuple(terms[at] for at in order)


def _order(number: int, parts: Parts) -> list[int]:
    """The numbers of instances, that of the first state just entered being where robots begin."""
    order = list(range(number))
    first = parts.first_instance
    order[0], order[first] = order[first], order[0]
    return order


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
        floor, heard = _perceived(parts, code)
        for at, state in enumerate(machine.states):
            entered, later = order[2 * at], order[2 * at + 1]
            table[code, entered, later, 0, 0] = 1.0
            chances = [_chance(each, floor, heard) for each in state.transitions]
            shares = shares_in_random_order(chances)
            for each, share in zip(state.transitions, shares, strict=True):
                table[code, later, order[2 * each.target], 0, 1] += share
            table[code, later, later, 0, 0] = max(0.0, 1.0 - math.fsum(shares))
    return table.reshape(parts.codes, number, -1)


def _perceived(parts: Parts, code: int) -> tuple[int, int]:
    """Floor and messages of a code of readings."""
    found = {automode.floor_below: 0, automode.messages: 0}
    for sensor in parts.sensors:
        code, reading = divmod(code, sensor.values)
        if sensor in found:
            found[sensor] = reading
    return found[automode.floor_below], found[automode.messages]
