"""Finite-state machines of AutoMoDe: states with a behaviour, transitions with a condition.

>>> from geswarm.automode import read_machines
>>> text = "--nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 --s1 1"
>>> (machine,) = read_machines(text)
>>> print(machine.states[0].behaviour)
exploration (rwm 5)
>>> machine.states[0].transitions[0].target
1
"""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.automode.modules import BEHAVIOURS, CONDITIONS, Behaviour, Condition

MOST_STATES = 4
MOST_TRANSITIONS = 4


@dataclass(frozen=True)
class Transition:
    """Where a robot goes if a condition holds.

    Attributes:
        target: Index of the state, among all states (the command line counts the others alone).
        condition: What it looks at.
    """

    target: int
    condition: Condition


@dataclass(frozen=True)
class State:
    """What a robot does until a condition holds.

    Attributes:
        behaviour: What it executes.
        transitions: Looked at in random order, from the second step in the state on.
    """

    behaviour: Behaviour
    transitions: tuple[Transition, ...] = ()


@dataclass(frozen=True)
class Machine:
    """A controller of AutoMoDe; robots start in the first state.

    Attributes:
        states: One to MOST_STATES, with up to MOST_TRANSITIONS each.
    """

    states: tuple[State, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.states) <= MOST_STATES:
            raise ValueError(f"expected 1 to {MOST_STATES} states, got {len(self.states)}")
        for number, state in enumerate(self.states):
            self._require(number, state)

    def _require(self, number: int, state: State) -> None:
        """Raise ValueError unless a state can be one of this machine."""
        if state.behaviour.number not in BEHAVIOURS:
            raise ValueError(f"state {number}: machines have no {state.behaviour}")
        if len(state.transitions) > MOST_TRANSITIONS:
            raise ValueError(
                f"state {number}: expected at most {MOST_TRANSITIONS} transitions, got "
                f"{len(state.transitions)}"
            )
        for each in state.transitions:
            if each.target == number or not 0 <= each.target < len(self.states):
                raise ValueError(
                    f"state {number}: expected another state as target, got {each.target}"
                )
            if each.condition.number not in CONDITIONS:
                raise ValueError(f"state {number}: machines have no {each.condition}")
