"""How the terms that rules are made of are declared: names, arguments, values and words.

A robot has a whole number from each of its sensors in every step, a reading; preconditions are
predicates over one reading, or over an internal state. Words may hold arguments: `near {k} robots`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from geswarm.rules.arguments import Argument
from geswarm.rules.model import COMPARISONS, Precondition, StateChange, Term, Value, format_value

_COMPARISON_WORDS = {
    "==": "exactly",
    "!=": "other than",
    ">=": "at least",
    "<=": "at most",
    ">": "more than",
    "<": "less than",
}


def _named(arguments: tuple[Argument, ...], term: Term) -> dict[str, str]:
    """The arguments of a term by name, as words take them."""
    names = (each.name for each in arguments)
    return dict(zip(names, map(format_value, term.arguments), strict=True))


BOOLEAN: tuple[Value, ...] = (False, True)


@dataclass(frozen=True)
class Reading:
    """What a sensor gives a robot in each step: the position of one of `values`.

    Attributes:
        name: Of the sensor.
        values: What there is to compare with: truths, numbers in ascending order, or names.
    """

    name: str
    values: tuple[Value, ...] = BOOLEAN


@dataclass(frozen=True)
class PreconditionName:
    """A percept that rules may compare with a value.

    Attributes:
        name: As written in rules.
        holds: Phrase for a percept that is true, or that is compared: `{comparison}` and `{value}`.
        fails: Phrase for one that is false; empty if it is compared with numbers or names.
        reading: What it looks at; empty for the reading of its own name.
        arguments: What is written in parentheses.
        truth: Makes a percept true or false of a reading's value and the arguments; None takes
            the value itself.
        chance: The probability that it is true, of the same; each rule draws it on its own.
    """

    name: str
    holds: str
    fails: str = ""
    reading: str = ""
    arguments: tuple[Argument, ...] = ()
    truth: Callable[..., bool] | None = None
    chance: Callable[..., float] | None = None

    def says(self, precondition: Precondition) -> str:
        """A precondition on this percept as a phrase."""
        words = _named(self.arguments, precondition.percept)
        value = format_value(precondition.value)
        holds = COMPARISONS[precondition.comparison]
        if isinstance(precondition.value, bool):
            return (self.holds if holds(True, precondition.value) else self.fails).format(**words)
        if isinstance(precondition.value, str):
            phrase = self.holds if precondition.comparison == "==" else self.fails
            return phrase.format(value=value, **words)
        comparison = _COMPARISON_WORDS[precondition.comparison]
        return self.holds.format(comparison=comparison, value=value, **words)


@dataclass(frozen=True)
class BehaviourName:
    """A low-level behaviour that a robot executes.

    Attributes:
        name: As written in rules.
        doing: Phrase that describes it.
        start: Phrase for changing to it.
        restarts: True if switching into it starts something afresh (random walk: a new heading).
        arguments: What is written in parentheses.
    """

    name: str
    doing: str
    start: str
    restarts: bool = False
    arguments: tuple[Argument, ...] = ()

    def says(self, behaviour: Term) -> tuple[str, str]:
        """Phrases for executing a behaviour of this name, and for changing to it."""
        words = _named(self.arguments, behaviour)
        return self.doing.format(**words), self.start.format(**words)


@dataclass(frozen=True)
class InternalStateName:
    """An internal state variable: true or false, one of some names, or a counter.

    Attributes:
        name: As written in rules.
        on: Phrase for setting it true, or to `{value}`.
        off: Phrase for setting it false; empty if it is not true or false.
        initially: Value at the start of a run.
        momentary: True if it has its initial value again after every control step.
        readable: Whether rules may compare it.
        values: What it can be; a counter has whole numbers from 0.
    """

    name: str
    on: str
    off: str = ""
    initially: Value = False
    momentary: bool = False
    readable: bool = False
    values: tuple[Value, ...] = BOOLEAN

    @property
    def counts(self) -> bool:
        """Whether it is a counter, which can be added to."""
        return not isinstance(self.values[0], bool | str)

    def as_percept(self) -> PreconditionName:
        """What preconditions on it look at."""
        if self.counts:
            holds, fails = f"with {self.name} {{comparison}} {{value}}", ""
        elif self.values == BOOLEAN:
            holds, fails = f"with {self.name} true", f"with {self.name} false"
        else:
            holds, fails = f"with {self.name} {{value}}", f"with {self.name} not {{value}}"
        return PreconditionName(self.name, holds, fails)

    def says(self, change: StateChange) -> str:
        """A change of it as a phrase."""
        if change.operation != "=":
            add = change.operation == "+="
            value = format_value(change.value)
            return f"add {value} to {self.name}" if add else f"take {value} from {self.name}"
        if isinstance(change.value, bool):
            return self.on if change.value else self.off
        return self.on.format(value=format_value(change.value))

    def after(self, before: Value, change: StateChange) -> Value:
        """What a change makes of a value; a counter stays within its range."""
        if change.operation == "=":
            return change.value
        by = int(change.value) if change.operation == "+=" else -int(change.value)
        return min(max(int(before) + by, int(self.values[0])), int(self.values[-1]))


@dataclass(frozen=True)
class ObjectNames:
    """How rules see and move the object that a robot carries.

    Attributes:
        holding: The percept that is true exactly while the robot carries an object.
        wanting: The internal state without which no object is picked up.
        dropping: The internal state that drops the object at the end of the step.
    """

    holding: str
    wanting: str
    dropping: str
