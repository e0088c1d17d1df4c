"""What rule sets can tell apart: the situations of a control step and what can come of them.

A *situation* is (percepts, behaviour, internal states) at the start of a step, an *outcome*
(behaviour, internal states, restart) after all rules. What no rule mentions makes no difference and
is left out, unless there are few situations in all.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.atoms import Atom, Drawn
from geswarm.rules.declarations import InternalStateName, Reading
from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import (
    Action,
    Precondition,
    RuleSet,
    Situation,
    Term,
    Value,
)
from geswarm.rules.vocabulary import Vocabulary

FloatArray: TypeAlias = npt.NDArray[np.float64]

_FEW = 128
"""Up to so many situations, all that the vocabulary offers without arguments is told apart."""

_MOST = 4_000_000
"""Situations times outcomes: a control table of 32 MB."""


@dataclass(frozen=True, eq=False)
class Space:
    """How situations and outcomes are numbered.

    Percepts are numbered by the values of the readings, the first reading changing fastest; values
    between which no atom distinguishes count once. Internal states likewise. A situation has the
    number `(percepts * behaviours + behaviour) * states + state`, an outcome
    `(behaviour * states + state) * 2 + restart`.

    Attributes:
        vocabulary: The names.
        atoms: The statements about readings that are told apart.
        behaviours: The behaviours.
        internal_states: The internal states; all others keep their initial value.
        drawn: The statements that are true by chance; percepts differ where their chances do.
    """

    vocabulary: Vocabulary
    atoms: tuple[Atom, ...]
    behaviours: tuple[Term, ...]
    internal_states: tuple[InternalStateName, ...]
    drawn: tuple[Drawn, ...] = ()

    @classmethod
    def of(cls, vocabulary: Vocabulary, *rule_sets: RuleSet) -> Space:
        """What rule sets tell apart, all of them together; names must be known.

        Raises:
            RuleSetError: That is more than fits in memory.
        """
        if (everything := _everything(vocabulary)) is not None:
            return everything
        rules = [rule for rule_set in rule_sets for rule in rule_set.active_rules]
        actions = [action for rule in rules for action in rule.actions]
        started = {term for action in actions for term in action.behaviours}
        return _space(
            vocabulary,
            frozenset(entry for rule in rules for entry in rule.preconditions),
            frozenset(started.union(*(rule.behaviours for rule in rules))),
            frozenset(action.target for action in actions),
        )

    @cached_property
    def signature(self) -> str:
        """Equal for spaces that number the same things alike."""
        return repr((self.atoms, self.behaviours, self.internal_states, self.drawn))

    # --- percepts -----------------------------------------------------------------------------

    @cached_property
    def readings(self) -> tuple[tuple[Reading, tuple[int, ...]], ...]:
        """The readings that matter, and for each of its values the number of its cell."""
        found = []
        for name, reading in self.vocabulary.readings_by_name.items():
            said: list[tuple[float, ...]] = [
                *(atom.accepted for atom in self.atoms if atom.reading == name),
                *(drawn.chances for drawn in self.drawn if drawn.reading == name),
            ]
            if said:
                truths = list(zip(*said, strict=True))  # of each value of the reading
                kinds = list(dict.fromkeys(truths))
                found.append((reading, tuple(map(kinds.index, truths))))
        return tuple(found)

    @cached_property
    def _sensed(self) -> tuple[dict[str, int], ...]:
        """For each percept number, a value of each reading, by its position."""
        firsts = [
            [cells.index(cell) for cell in range(max(cells) + 1)] for _, cells in self.readings
        ]
        names = [reading.name for reading, _ in self.readings]
        return tuple(
            dict(zip(names, reversed(chosen), strict=True))
            for chosen in itertools.product(*reversed(firsts))
        )

    @property
    def percepts(self) -> int:
        """How many percepts are told apart."""
        return len(self._sensed)

    def percept(self, values: Mapping[str, Value]) -> int:
        """The number of what a robot perceives, by the values of its readings."""
        number, stride = 0, 1
        for reading, cells in self.readings:
            number += stride * cells[reading.values.index(values[reading.name])]
            stride *= max(cells) + 1
        return number

    @cached_property
    def truths(self) -> npt.NDArray[np.bool_]:
        """Which atoms are true, shape (percepts, atoms)."""
        rows = [[atom.accepted[at[atom.reading]] for atom in self.atoms] for at in self._sensed]
        return np.array(rows, dtype=bool).reshape(self.percepts, len(self.atoms))

    def chance(self, precondition: Precondition) -> FloatArray:
        """How probable a precondition is for each percept, shape (percepts,); often 0 or 1."""
        reading = self.vocabulary.reading_of(precondition.percept.name)
        chances = [self.vocabulary.chance(precondition, value) for value in reading.values]
        return np.array([chances[at[reading.name]] for at in self._sensed], dtype=np.float64)

    def can_hold(self, preconditions: Sequence[Precondition]) -> bool:
        """Whether anything that a robot can perceive meets all of them, or may do so."""
        possible = np.zeros(self.percepts, dtype=bool)
        possible[list(self.possible)] = True
        for precondition in preconditions:
            possible &= self.chance(precondition) > 0.0
        return bool(possible.any())

    @cached_property
    def possible(self) -> tuple[int, ...]:
        """The percepts that a robot can have: without what is never true together."""
        impossible = np.zeros(self.percepts, dtype=bool)
        known = {atom.name: at for at, atom in enumerate(self.atoms)}
        for one, other in self.vocabulary.apart:
            if one in known and other in known:
                impossible |= self.truths[:, known[one]] & self.truths[:, known[other]]
        return tuple(map(int, np.flatnonzero(~impossible)))

    @cached_property
    def held(self) -> npt.NDArray[np.bool_]:
        """For which percepts a robot carries an object, shape (percepts,)."""
        if self.vocabulary.objects is None:
            return np.zeros(self.percepts, dtype=bool)
        return self.chance(Precondition(Term(self.vocabulary.objects.holding), True)) > 0.0

    def perceivable(self, holding: bool, states: int) -> list[int]:
        """Everything that a robot can perceive that holds an object, or does not.

        Args:
            holding: Whether it does.
            states: Its internal states, by number, as the step begins.
        """
        values = self.state_values[states]
        own = {entry.name: value for entry, value in zip(self.internal_states, values, strict=True)}
        agreeing = [
            (reading, own[reading.name]) for reading, _ in self.readings if reading.name in own
        ]
        cells = {reading.name: cells for reading, cells in self.readings}
        return [
            number
            for number in self.possible
            if (self.vocabulary.objects is None or bool(self.held[number]) == holding)
            and all(
                cells[reading.name][self._sensed[number][reading.name]]
                == cells[reading.name][reading.values.index(value)]
                for reading, value in agreeing
            )
        ]

    # --- internal states ----------------------------------------------------------------------

    @cached_property
    def state_values(self) -> tuple[tuple[Value, ...], ...]:
        """Values of the internal states, for each number."""
        choices = [entry.values for entry in reversed(self.internal_states)]
        return tuple(tuple(reversed(chosen)) for chosen in itertools.product(*choices))

    @property
    def states(self) -> int:
        """How many combinations of internal states there are."""
        return len(self.state_values)

    @cached_property
    def _state_numbers(self) -> dict[tuple[Value, ...], int]:
        return {values: number for number, values in enumerate(self.state_values)}

    @cached_property
    def initial_states(self) -> int:
        """Number of the internal states at the start of a run."""
        return self._state_numbers[tuple(entry.initially for entry in self.internal_states)]

    @cached_property
    def kept(self) -> tuple[int, ...]:
        """What each combination becomes at the end of a step: momentary ones are as initially."""
        return tuple(
            self._state_numbers[
                tuple(
                    entry.initially if entry.momentary else value
                    for entry, value in zip(self.internal_states, values, strict=True)
                )
            ]
            for values in self.state_values
        )

    def with_state(self, states: int, name: str, value: Value) -> int:
        """The number of a combination with another value of one internal state."""
        return self._state_numbers[
            tuple(
                value if entry.name == name else old
                for entry, old in zip(self.internal_states, self.state_values[states], strict=True)
            )
        ]

    def state(self, states: int, name: str) -> Value:
        """The value of an internal state in a combination."""
        return self.state_values[states][self._state_places[name]]

    @cached_property
    def _state_places(self) -> dict[str, int]:
        return {entry.name: at for at, entry in enumerate(self.internal_states)}

    # --- situations and outcomes --------------------------------------------------------------

    @property
    def starts(self) -> int:
        """Combinations of behaviour and internal states."""
        return len(self.behaviours) * self.states

    @property
    def situations(self) -> int:
        """Number of rows of a control table."""
        return self.percepts * self.starts

    @property
    def outcomes(self) -> int:
        """Number of columns of a control table."""
        return self.starts * 2

    @cached_property
    def initial_behaviour(self) -> int:
        """Position of the behaviour at the start of a run."""
        return self.behaviours.index(Term(self.vocabulary.initial_behaviour))

    def situation(self, percepts: int, behaviour: int, states: int) -> int:
        """Row of one situation."""
        return (percepts * len(self.behaviours) + behaviour) * self.states + states

    def outcome(self, behaviour: int, states: int, restart: bool = False) -> int:
        """Column of one outcome."""
        return (behaviour * self.states + states) * 2 + restart

    def describe_outcome(self, outcome: int) -> tuple[int, int, bool]:
        """(behaviour, internal states, restart) of a column."""
        rest, restart = divmod(outcome, 2)
        behaviour, states = divmod(rest, self.states)
        return behaviour, states, bool(restart)

    @cached_property
    def _effects(self) -> dict[str, FloatArray]:
        return {}

    def effect(self, action: Action) -> FloatArray:
        """What an action does when it happens, as a 0/1 matrix, shape (outcomes, outcomes)."""
        if action.deed not in self._effects:
            matrix = np.zeros((self.outcomes, self.outcomes))
            for before in range(self.outcomes):
                matrix[
                    before, self._number(action.after(self._outcome(before), self.vocabulary))
                ] = 1
            matrix.setflags(write=False)
            self._effects[action.deed] = matrix
        return self._effects[action.deed]

    def _outcome(self, number: int) -> Situation:
        behaviour, states, restart = self.describe_outcome(number)
        names = (entry.name for entry in self.internal_states)
        values = tuple(zip(names, self.state_values[states], strict=True))
        return Situation(self.behaviours[behaviour], values, restart)

    def _number(self, outcome: Situation) -> int:
        states = self._state_numbers[tuple(value for _, value in outcome.states)]
        return self.outcome(self.behaviours.index(outcome.behaviour), states, outcome.restart)


@lru_cache(maxsize=64)
def _everything(vocabulary: Vocabulary) -> Space | None:
    """All that a small vocabulary offers, or None."""
    arguments = [entry.arguments for entry in vocabulary.preconditions]
    arguments += [entry.arguments for entry in vocabulary.behaviours]
    sizes = [len(entry.values) for entry in vocabulary.readings_by_name.values()]
    sizes += [len(entry.values) for entry in vocabulary.internal_states]
    if any(arguments) or math.prod(sizes) * len(vocabulary.behaviours) > _FEW:
        return None
    return _space(
        vocabulary,
        frozenset(
            Precondition(Term(name), value)
            for name in vocabulary.percepts
            for value in vocabulary.values_of(name)
        ),
        frozenset(Term(entry.name) for entry in vocabulary.behaviours),
        frozenset(vocabulary.state_names),
    )


@lru_cache(maxsize=256)
def _space(
    vocabulary: Vocabulary,
    preconditions: frozenset[Precondition],
    behaviours: frozenset[Term],
    states: frozenset[str],
) -> Space:
    """The space in which these are told apart, and what the model itself looks at."""
    needed = {Term(vocabulary.initial_behaviour)}
    if objects := vocabulary.objects:
        preconditions |= {Precondition(Term(objects.holding), True)}
        states |= {objects.wanting, objects.dropping}
    states |= {entry.percept.name for entry in preconditions} & vocabulary.state_names.keys()
    order = {name: at for at, name in enumerate(vocabulary.behaviour_names)}
    order_of = {name: at for at, name in enumerate(vocabulary.percepts)}
    in_order = sorted(
        preconditions,
        key=lambda entry: (order_of[entry.percept.name], str(entry.percept), str(entry.value)),
    )
    atoms: dict[tuple[str, tuple[bool, ...]], Atom] = {}
    drawn: dict[Term, Drawn] = {}
    for precondition in in_order:
        if vocabulary.is_drawn(precondition):
            drawn.setdefault(precondition.percept, Drawn.of(precondition, vocabulary))
            continue
        atom = Atom.of(precondition, vocabulary)
        opposite = tuple(not each for each in atom.accepted)
        if (atom.reading, opposite) not in atoms:
            atoms.setdefault((atom.reading, atom.accepted), atom)
    space = Space(
        vocabulary,
        tuple(atoms.values()),
        tuple(sorted(behaviours | needed, key=lambda term: (order[term.name], term.arguments))),
        tuple(entry for entry in vocabulary.internal_states if entry.name in states),
        tuple(drawn.values()),
    )
    if (size := space.situations * space.outcomes) > _MOST:
        message = f"expected at most {_MOST:,} situations times outcomes told apart, got {size:,}"
        raise RuleSetError([Finding(Place(), message)])
    return space
