"""Vocabularies: everything that the rules of a scenario may mention, as data.

Grammar, parser, checks, editor and control table all read a vocabulary.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from geswarm.rules.arguments import Argument
from geswarm.rules.declarations import (
    BOOLEAN,
    BehaviourName,
    InternalStateName,
    ObjectNames,
    PreconditionName,
    Reading,
)
from geswarm.rules.findings import shown, unknown_name
from geswarm.rules.model import (
    COMPARISONS,
    OPERATIONS,
    Precondition,
    StateChange,
    Term,
    Value,
    format_value,
)


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """Everything that a rule may mention, in the order in which it is offered.

    Attributes:
        preconditions: Percepts.
        behaviours: Low-level behaviours.
        internal_states: Internal state variables.
        probabilities: Values of p that the grammar and the editor offer.
        initial_behaviour: Behaviour at the start of a run.
        apart: Pairs of percepts that never hold together.
        objects: What carries, wants and drops objects; None if there are none.
        readings: Of the sensors, but for those that a percept of the same name makes true or false.
        name: What it is called; rule sets may say for which vocabulary they were written.
    """

    preconditions: tuple[PreconditionName, ...]
    behaviours: tuple[BehaviourName, ...]
    internal_states: tuple[InternalStateName, ...]
    probabilities: tuple[float, ...]
    initial_behaviour: str
    apart: tuple[tuple[str, str], ...] = ()
    objects: ObjectNames | None = None
    readings: tuple[Reading, ...] = ()
    name: str = ""

    def __deepcopy__(self, _: object) -> Vocabulary:
        return self  # it never changes, and is equal to nothing but itself

    @cached_property
    def percepts(self) -> dict[str, PreconditionName]:
        """What can be compared, by name: the preconditions, and readable internal states."""
        states = {
            entry.name: entry.as_percept() for entry in self.internal_states if entry.readable
        }
        return states | {entry.name: entry for entry in self.preconditions}

    @cached_property
    def precondition_index(self) -> dict[str, int]:
        """Position of each precondition name."""
        return {entry.name: at for at, entry in enumerate(self.preconditions)}

    @cached_property
    def behaviour_index(self) -> dict[str, int]:
        """Position of each behaviour name."""
        return {entry.name: at for at, entry in enumerate(self.behaviours)}

    @cached_property
    def state_index(self) -> dict[str, int]:
        """Position of each internal state's name."""
        return {entry.name: at for at, entry in enumerate(self.internal_states)}

    @cached_property
    def behaviour_names(self) -> dict[str, BehaviourName]:
        """The behaviours by name."""
        return {entry.name: entry for entry in self.behaviours}

    @cached_property
    def state_names(self) -> dict[str, InternalStateName]:
        """The internal states by name."""
        return {entry.name: entry for entry in self.internal_states}

    @cached_property
    def readings_by_name(self) -> dict[str, Reading]:
        """All readings: of sensors, of percepts that are their own, and of internal states."""
        own = [Reading(entry.name) for entry in self.preconditions if not entry.reading]
        states = [Reading(each.name, each.values) for each in self.internal_states if each.readable]
        return {entry.name: entry for entry in (*own, *self.readings, *states)}

    def reading_of(self, percept: str) -> Reading:
        """What a percept looks at."""
        return self.readings_by_name[self.percepts[percept].reading or percept]

    def values_of(self, percept: str) -> tuple[Value, ...]:
        """What a percept can be compared with."""
        entry = self.percepts[percept]
        return BOOLEAN if entry.truth or entry.chance else self.reading_of(percept).values

    def comparisons_of(self, percept: str) -> tuple[str, ...]:
        """How a percept can be compared."""
        if isinstance(self.values_of(percept)[0], bool | str):
            return "==", "!="
        return tuple(COMPARISONS)

    def is_drawn(self, precondition: Precondition) -> bool:
        """Whether it is by chance that a precondition holds."""
        entry = self.percepts.get(precondition.percept.name)
        return entry is not None and entry.chance is not None

    def chance(self, precondition: Precondition, value: Value) -> float:
        """The probability that a precondition holds when the reading has a value.

        Raises:
            ValueError: What the vocabulary makes of them is none.
        """
        entry = self.percepts[precondition.percept.name]
        if entry.chance is None:
            return float(self.holds(precondition, value))
        true = float(entry.chance(value, *precondition.percept.arguments))
        if not 0.0 <= true <= 1.0:
            raise ValueError(
                f"{precondition.percept}: expected a chance from 0 to 1 for "
                f"{format_value(value)}, got {true}"
            )
        wanted = COMPARISONS[precondition.comparison](True, precondition.value)
        return true if wanted else 1.0 - true

    def holds(self, precondition: Precondition, value: Value) -> bool:
        """Whether a precondition holds when the reading that it looks at has a value.

        It must be one that is true or false of it, see `is_drawn`.
        """
        entry = self.percepts[precondition.percept.name]
        sensed = entry.truth(value, *precondition.percept.arguments) if entry.truth else value
        return COMPARISONS[precondition.comparison](sensed, precondition.value)

    def precondition_error(self, precondition: Precondition) -> str | None:
        """Why a precondition cannot be used, or None."""
        name = precondition.percept.name
        if name not in self.percepts:
            return unknown_name("precondition", name, self.percepts)
        if problem := _arguments_error(precondition.percept, self.percepts[name].arguments):
            return problem
        comparisons = self.comparisons_of(name)
        if precondition.comparison not in comparisons:
            expected = " or ".join(comparisons)
            return f"expected {expected} after {name}, got {shown(precondition.comparison)}"
        return _value_error(precondition.value, self.values_of(name))

    def behaviour_error(self, behaviour: Term) -> str | None:
        """Why a behaviour cannot be used, or None."""
        if behaviour.name not in self.behaviour_names:
            return unknown_name("behaviour", behaviour.name, self.behaviour_names)
        return _arguments_error(behaviour, self.behaviour_names[behaviour.name].arguments)

    def change_error(self, change: StateChange) -> str | None:
        """Why a change of an internal state cannot be made, or None."""
        if change.state not in self.state_names:
            return unknown_name("internal state", change.state, self.state_names)
        entry = self.state_names[change.state]
        operations = OPERATIONS if entry.counts else OPERATIONS[:1]
        if change.operation not in operations:
            expected = " or ".join(operations)
            return f"expected {expected} after {change.state}, got {shown(change.operation)}"
        return _value_error(change.value, entry.values)


def _value_error(value: Value, values: tuple[Value, ...]) -> str | None:
    if any(value == each and type(value) is type(each) for each in values):
        return None
    if isinstance(values[0], bool | str):
        names = map(format_value, values if isinstance(values[0], str) else values[::-1])
        expected = " or ".join(names)
    else:
        expected = f"a whole number from {values[0]} to {values[-1]}"
    return f"expected {expected}, got {shown(value)}"


def _arguments_error(term: Term, arguments: tuple[Argument, ...]) -> str | None:
    if len(term.arguments) != len(arguments):
        expected = Term(term.name, tuple(each.name for each in arguments))
        what = f"expected {expected}" if arguments else "expected no arguments"
        return f"{term.name}: {what}, got {term}"
    problems = map(lambda each, value: each.problem(value), arguments, term.arguments)
    problem = next(filter(None, problems), None)
    return problem and f"{term.name}: {problem}"


FORAGING = Vocabulary(
    preconditions=(
        PreconditionName("ON_NEST", "in the nest", "outside the nest"),
        PreconditionName("ON_SOURCE", "at the source", "away from the source"),
        PreconditionName("HAS_OBJECT", "holding an object", "not holding an object"),
    ),
    behaviours=(
        BehaviourName("PHOTOTAXIS", "going to the light", "go to the light"),
        BehaviourName("ANTI-PHOTOTAXIS", "going away from the light", "go away from the light"),
        BehaviourName("RANDOM_WALK", "walking at random", "start walking at random", restarts=True),
    ),
    internal_states=(
        InternalStateName(
            "WANT_OBJECT", "start picking up objects", "stop picking up objects", initially=True
        ),
        InternalStateName(
            "DROP_OBJECT", "drop the object", "keep the object after all", momentary=True
        ),
    ),
    probabilities=(0.001, 0.005, 0.01, 0.025, 0.05, 0.075, 0.1, 1.0),
    initial_behaviour="RANDOM_WALK",
    apart=(("ON_NEST", "ON_SOURCE"),),
    objects=ObjectNames("HAS_OBJECT", wanting="WANT_OBJECT", dropping="DROP_OBJECT"),
    name="foraging",
)
"""The paper's (section 3.1.1)."""
