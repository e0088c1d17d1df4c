"""A rule set as the probabilistic finite state machine that it is (paper, section 5).

States are behaviours, each split by those internal states that do not always have the same value.
Transitions are read off the exact outcome distributions of one control step, in all situations that
robots can get into; situations that they cannot get into make the conditions shorter.

>>> from geswarm.rules import StateMachine, load_rule_set
>>> machine = StateMachine.of(load_rule_set("hand-coded"))
>>> [state.label for state in machine.states]
['PHOTOTAXIS', 'ANTI-PHOTOTAXIS', 'RANDOM_WALK']
>>> for transition in machine.transitions_from(1):
...     print(machine.describe(transition))
ANTI-PHOTOTAXIS to RANDOM_WALK when ON_NEST: p = 1, at once; drop the object

Conditions are about what is true or false. Where a precondition holds by chance, the probability of
the transition depends on what robots perceive: it is told as a multiple of that chance, or else
from the least to the greatest.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.conditions import Condition, minimise
from geswarm.rules.model import CONTROL_STEP, RuleSet, StateChange, Term, Value, format_value
from geswarm.rules.notebook import as_html
from geswarm.rules.rates import Rate
from geswarm.rules.reachability import TOLERANCE, Trace, effective_outcomes
from geswarm.rules.space import Space
from geswarm.rules.vocabulary import FORAGING, Vocabulary

IntArray: TypeAlias = npt.NDArray[np.int64]


@dataclass(frozen=True)
class State:
    """A state of the machine.

    Attributes:
        behaviour: What the robot executes.
        internal: The internal states that distinguish it from other states of the same behaviour.
        initial: Whether robots start in it.
        column: Behaviour and internal states, as the control table numbers them.
    """

    behaviour: Term
    internal: tuple[tuple[str, Value], ...]
    initial: bool
    column: int

    @property
    def marks(self) -> tuple[str, ...]:
        """The internal states: `not WANT_OBJECT`, `HUNGER = 3`."""
        return tuple(_mark(name, value) for name, value in self.internal)

    @property
    def label(self) -> str:
        """`RANDOM_WALK`, or `RANDOM_WALK, not WANT_OBJECT`."""
        return ", ".join([str(self.behaviour), *self.marks])


def _mark(name: str, value: Value) -> str:
    if isinstance(value, bool):
        return name if value else f"not {name}"
    return f"{name} = {format_value(value)}"


@dataclass(frozen=True)
class Transition:
    """What can happen in one control step, apart from nothing.

    Attributes:
        source: Index of the state before.
        target: Index of the state after; the same as `source` for a loop, which has an effect.
        condition: The percepts for which it can happen.
        chances: How probable it is in a control step in which the condition holds.
        effects: Momentary internal states that are set, and to what; `DROP_OBJECT` only where
            an object is held.
        restarts: A loop that begins the behaviour afresh (random walk: a new heading).
        rules: Numbers of the rules that bring it about, from 1.
    """

    source: int
    target: int
    condition: Condition
    chances: Rate
    effects: tuple[tuple[str, Value], ...]
    restarts: bool
    rules: tuple[int, ...]

    @property
    def probability(self) -> float:
        """Per control step in which the condition holds; the greatest, if it varies."""
        return self.chances.most

    @property
    def mean_wait(self) -> float:
        """Mean time until it happens while the condition holds (s); the least, if it varies."""
        return CONTROL_STEP / self.probability

    @property
    def rate(self) -> str:
        """Probability per step and mean waiting time: `p = 0.05, 2 s`."""
        if self.chances.varies:
            return str(self.chances)
        digits = 0 if self.mean_wait >= 9.95 else 1 if self.mean_wait >= 0.95 else 2
        wait = f"{self.mean_wait:.{digits}f} s".replace(".0 s", " s")
        return f"{self.chances}, {'at once' if self.probability == 1 else wait}"


@dataclass(frozen=True)
class _Event:
    """What a robot comes to in a step; the unit in which transitions are counted.

    Attributes:
        column: Of the state after.
        effects: As of a transition.
        restarts: As of a transition.
    """

    column: int
    effects: tuple[tuple[str, Value], ...]
    restarts: bool

    @classmethod
    def of(cls, outcome: int, column: int, space: Space) -> _Event:
        """What an outcome, as the control table numbers them, is to a robot in a column."""
        behaviour, states, restart = space.describe_outcome(outcome)
        effects = tuple(
            (entry.name, value)
            for entry, value in zip(space.internal_states, space.state_values[states], strict=True)
            if entry.momentary and value != entry.initially
        )
        after = behaviour * space.states + space.kept[states]
        same = behaviour == column // space.states
        return cls(after, effects, restart and same)


@dataclass(frozen=True)
class StateMachine:
    """States and transitions of a rule set.

    Attributes:
        name: Name of the rule set.
        states: In the order of the vocabulary.
        transitions: By source, then target; what remains to 1 in a state is the probability that
            nothing happens.
        space: What the rules tell apart.
    """

    name: str
    states: tuple[State, ...]
    transitions: tuple[Transition, ...]
    space: Space

    @classmethod
    def of(cls, rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> StateMachine:
        """The state machine of the rules that are switched on.

        Raises:
            RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        """
        reader = _Reader(rule_set, vocabulary)
        transitions = tuple(
            transition
            for source in range(len(reader.states))
            for transition in reader.transitions_from(source)
        )
        return cls(rule_set.name, reader.states, transitions, reader.space)

    def position(self, behaviour: Term) -> int:
        """Position of a behaviour's name in the vocabulary, which pictures colour it by."""
        return self.space.vocabulary.behaviour_index[behaviour.name]

    def transitions_from(self, source: int) -> tuple[Transition, ...]:
        """The transitions that leave a state, loops among them."""
        return tuple(entry for entry in self.transitions if entry.source == source)

    @cached_property
    def between(self) -> dict[tuple[int, int], tuple[Transition, ...]]:
        """Transitions by (source, target)."""
        groups: dict[tuple[int, int], list[Transition]] = defaultdict(list)
        for transition in self.transitions:
            groups[transition.source, transition.target].append(transition)
        return {pair: tuple(group) for pair, group in groups.items()}

    def robots_in_states(self, behaviour: IntArray, internal_states: IntArray) -> IntArray:
        """How many robots are in each state, shape (states,).

        After a change of the rules, robots can still be where the new rules never lead: they are in
        none of the states.

        Args:
            behaviour: Numbers of the behaviours in `space`, shape (robots,); -1 for others.
            internal_states: Numbers of the internal states, shape (robots,).
        """
        known = behaviour >= 0
        columns = behaviour[known] * self.space.states + internal_states[known]
        robots = np.bincount(columns, minlength=self.space.starts)
        return robots[[state.column for state in self.states]]

    def times_taken(self, decisions: IntArray) -> IntArray:
        """How often each transition was taken, shape (transitions,).

        Args:
            decisions: How often robots came from each situation to each outcome, shape (situations,
                outcomes), as `World.decisions` counts them.
        """
        known = self._transition_of >= 0
        times = np.zeros(len(self.transitions), dtype=np.int64)
        np.add.at(times, self._transition_of[known], decisions[known])
        return times

    @cached_property
    def _transition_of(self) -> IntArray:
        """The transition that each outcome is, -1 for none; shape (situations, outcomes)."""
        space = self.space
        becomes = effective_outcomes(space).argmax(axis=2)
        columns = [state.column for state in self.states]
        alike: dict[tuple[int, _Event], list[int]] = defaultdict(list)
        for at, entry in enumerate(self.transitions):
            event = _Event(columns[entry.target], entry.effects, entry.restarts)
            alike[columns[entry.source], event].append(at)
        found = np.full((space.percepts, space.starts, space.outcomes), -1)
        names = [atom.name for atom in space.atoms]
        for percepts, outcome in np.ndindex(becomes.shape):
            sensed = dict(zip(names, map(bool, space.truths[percepts]), strict=True))
            for column in columns:
                event = _Event.of(int(becomes[percepts, outcome]), column, space)
                for at in alike.get((column, event), ()):
                    if self.transitions[at].condition.holds(sensed):
                        found[percepts, column, outcome] = at
        return found.reshape(space.situations, space.outcomes)

    def effects(self, transition: Transition) -> tuple[str, ...]:
        """What a transition does besides changing the state, in words."""
        vocabulary = self.space.vocabulary
        phrases = [
            vocabulary.state_names[name].says(StateChange(1.0, name, value))
            for name, value in transition.effects
        ]
        if transition.restarts:
            behaviour = self.states[transition.target].behaviour
            phrases.append(
                f"{vocabulary.behaviour_names[behaviour.name].says(behaviour)[1]} afresh"
            )
        return tuple(phrases)

    def describe(self, transition: Transition) -> str:
        """One line about a transition."""
        ends = f"{self.states[transition.source].label} to {self.states[transition.target].label}"
        condition = str(transition.condition)
        when = condition if condition == "always" else f"when {condition}"
        return "; ".join([f"{ends} {when}: {transition.rate}", *self.effects(transition)])

    def _repr_html_(self) -> str:
        """How notebooks show it: as a picture."""
        return as_html(self)


class _Reader:
    """Reads states and transitions off a trace of the rule set."""

    def __init__(self, rule_set: RuleSet, vocabulary: Vocabulary) -> None:
        self.trace = Trace.of(rule_set, vocabulary)
        self.space = self.trace.space
        self.decided = self.trace.decided
        self.before, self.after = np.stack(self.trace.before), np.stack(self.trace.after)
        stays = np.eye(self.space.outcomes, dtype=bool)
        self.moves = np.array([(matrix > 0) & ~stays for matrix in self.trace.matrices])
        self.numbers = [at for at, rule in enumerate(rule_set.rules, start=1) if rule.enabled]
        self.names = tuple(atom.name for atom in self.space.atoms)
        self.columns = [int(column) for column in np.flatnonzero(self.trace.reachable.any(axis=0))]
        self.relevant = self._relevant_states()
        self.states = tuple(map(self._state, self.columns))
        places = 1 << np.arange(len(self.names))
        self.points = (self.space.truths @ places).tolist()

    def _relevant_states(self) -> list[int]:
        """Positions of the internal states that have several values at the start of some step."""
        seen = {self.space.state_values[column % self.space.states] for column in self.columns}
        return [at for at, values in enumerate(zip(*seen, strict=True)) if len(set(values)) > 1]

    def _state(self, column: int) -> State:
        space = self.space
        behaviour, states = divmod(column, space.states)
        values = space.state_values[states]
        return State(
            space.behaviours[behaviour],
            tuple((space.internal_states[at].name, values[at]) for at in self.relevant),
            initial=behaviour == space.initial_behaviour and states == space.initial_states,
            column=column,
        )

    def transitions_from(self, source: int) -> Iterator[Transition]:
        """Everything that can happen in a state, the same probabilities merged."""
        column = self.columns[source]
        alike: dict[int, list[int]] = defaultdict(list)  # but for what is true by chance
        for percepts in map(int, np.flatnonzero(self.trace.reachable[:, column])):
            alike[self.points[percepts]].append(percepts)
        percepts_of: dict[tuple[_Event, Rate], list[int]] = defaultdict(list)
        for group in alike.values():
            events = {percepts: self._events(percepts, column) for percepts in group}
            for event in dict.fromkeys(event for found in events.values() for event in found):
                found = {percepts: events[percepts].get(event, 0.0) for percepts in group}
                if max(found.values()) > TOLERANCE and event != _Event(column, (), False):
                    percepts_of[event, Rate.over(found, self.space)] += group
        in_order = sorted(
            percepts_of.items(),
            key=lambda item: (item[0][0].column, item[0][0].effects, -item[0][1].most, item[1]),
        )
        for (event, chances), where in in_order:
            yield Transition(
                source,
                self.columns.index(event.column),
                self._condition(where, set(alike)),
                chances,
                event.effects,
                event.restarts,
                self._rules_behind(where, column, event),
            )

    def _condition(self, where: list[int], points: set[int]) -> Condition:
        holds = {self.points[at] for at in where}
        return minimise(holds, points - holds, self.names)

    def _events(self, percepts: int, column: int) -> dict[_Event, float]:
        """Probability of everything that can happen in one situation."""
        events: dict[_Event, float] = defaultdict(float)
        row = self.decided[percepts, column]
        for outcome in np.flatnonzero(row):
            event = _Event.of(int(outcome), column, self.space)
            events[event] += float(row[outcome])
        return events

    def _rules_behind(self, where: list[int], column: int, event: _Event) -> tuple[int, ...]:
        """Rules that change something on some way to the event."""
        behind: set[int] = set()
        for percepts in where:
            finals = [
                outcome
                for outcome in map(int, np.flatnonzero(self.decided[percepts, column]))
                if _Event.of(outcome, column, self.space) == event
            ]
            come_by = self.before[:-1, percepts, column] > 0
            lead_there = self.after[1:, percepts][:, :, finals].sum(axis=2) > 0
            ways = self.moves[:, percepts] & come_by[:, :, None] & lead_there[:, None, :]
            behind.update(self.numbers[at] for at in np.flatnonzero(ways.any(axis=(1, 2))))
        return tuple(sorted(behind))
