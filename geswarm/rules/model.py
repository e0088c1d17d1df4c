"""Rule sets as values: R_i = P_i x B_i x A_i (paper, section 2.1).

Everything here is frozen; an edit makes a new rule set. Names are checked against a vocabulary by
`geswarm.rules.check`, not here, so that a rule set with a misspelt name can still be shown.
"""

from __future__ import annotations

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

from geswarm.rules.notebook import as_html

if TYPE_CHECKING:
    from geswarm.rules.vocabulary import Vocabulary

CONTROL_STEP = 0.1
"""How often robots go through their rules (s): the foot-bot's 10 times in a second (section 4)."""


Value: TypeAlias = bool | int | float | str
"""Of an argument, a reading or an internal state."""


@dataclass(frozen=True)
class Term:
    """What rules are made of, as a rule mentions it: `ON_NEST`, `IS_CLOSE_TO(3)`.

    Attributes:
        name: Of a precondition or a behaviour of the vocabulary.
        arguments: In the order of its declaration.
    """

    name: str
    arguments: tuple[Value, ...] = ()

    def __str__(self) -> str:
        if not self.arguments:
            return self.name
        return f"{self.name}({', '.join(map(format_value, self.arguments))})"


@dataclass(frozen=True)
class Precondition:
    """A percept compared with a value: `ON_NEST == true`, `NEIGHBOURS >= 3` (production 7).

    Attributes:
        percept: What is compared: a precondition of the vocabulary, or an internal state.
        value: What with.
        comparison: One of COMPARISONS.
    """

    percept: Term
    value: Value
    comparison: str = "=="

    def __post_init__(self) -> None:
        object.__setattr__(self, "percept", _term(self.percept))

    def __str__(self) -> str:
        return f"{self.percept} {self.comparison} {format_value(self.value)}"


@dataclass(frozen=True)
class Situation:
    """What rules change of a robot in a control step.

    Attributes:
        behaviour: What it executes.
        states: Its internal states, name and value each.
        restart: Whether the behaviour was switched into during the step and starts afresh.
    """

    behaviour: Term
    states: tuple[tuple[str, Value], ...]
    restart: bool = False


class Action(ABC):
    """Something that happens with probability `p` per control step (production 9)."""

    p: float

    def __str__(self) -> str:
        return f"p = {format_value(float(self.p))}, {self.deed}"

    @property
    @abstractmethod
    def deed(self) -> str:
        """What happens, without its probability."""

    @property
    @abstractmethod
    def target(self) -> str:
        """Name of the internal state that it changes; empty for the behaviour."""

    @property
    def behaviours(self) -> tuple[Term, ...]:
        """The behaviours that it can start."""
        return ()

    @property
    @abstractmethod
    def becomes(self) -> str:
        """What its target becomes, as tables write it behind an arrow."""

    @abstractmethod
    def error(self, vocabulary: Vocabulary) -> str | None:
        """Why it cannot be used with a vocabulary, apart from its probability; or None."""

    @abstractmethod
    def says(self, vocabulary: Vocabulary) -> str:
        """What happens as a phrase."""

    @abstractmethod
    def after(self, situation: Situation, vocabulary: Vocabulary) -> Situation:
        """What becomes of a robot when it happens."""


@dataclass(frozen=True)
class BehaviourChange(Action):
    """With probability p per control step, change to `behaviour` (production 10)."""

    p: float
    behaviour: Term

    def __post_init__(self) -> None:
        object.__setattr__(self, "behaviour", _term(self.behaviour))

    @property
    def deed(self) -> str:
        """`RANDOM_WALK`."""
        return str(self.behaviour)

    @property
    def target(self) -> str:
        """Empty: it changes no internal state."""
        return ""

    @property
    def behaviours(self) -> tuple[Term, ...]:
        """The one."""
        return (self.behaviour,)

    @property
    def becomes(self) -> str:
        """The behaviour."""
        return str(self.behaviour)

    def error(self, vocabulary: Vocabulary) -> str | None:
        """Why the behaviour cannot be used, or None."""
        return vocabulary.behaviour_error(self.behaviour)

    def says(self, vocabulary: Vocabulary) -> str:
        """`go to the light`."""
        known = vocabulary.behaviour_names.get(self.behaviour.name)
        return known.says(self.behaviour)[1] if known else f"start {str(self.behaviour)!r}"

    def after(self, situation: Situation, vocabulary: Vocabulary) -> Situation:
        """The behaviour starts; afresh if it is another one, and one that has a beginning."""
        if situation.behaviour == self.behaviour:
            return situation
        restarts = vocabulary.behaviour_names[self.behaviour.name].restarts
        return replace(situation, behaviour=self.behaviour, restart=restarts)


@dataclass(frozen=True)
class StateChange(Action):
    """With probability p per control step, change the internal state `state` (production 11).

    Attributes:
        p: The probability.
        state: Its name.
        value: What it becomes, or by how much a counter changes.
        operation: One of OPERATIONS.
    """

    p: float
    state: str
    value: Value
    operation: str = "="

    @property
    def deed(self) -> str:
        """`DROP_OBJECT = true`, `HUNGER += 1`."""
        return f"{self.state} {self.operation} {format_value(self.value)}"

    @property
    def target(self) -> str:
        """The internal state."""
        return self.state

    @property
    def becomes(self) -> str:
        """`true`, `HUNGER + 1`."""
        value = format_value(self.value)
        return value if self.operation == "=" else f"{self.state} {self.operation[0]} {value}"

    def error(self, vocabulary: Vocabulary) -> str | None:
        """Why the internal state cannot be changed so, or None."""
        return vocabulary.change_error(self)

    def says(self, vocabulary: Vocabulary) -> str:
        """`drop the object`."""
        known = vocabulary.state_names.get(self.state)
        value = format_value(self.value)
        return known.says(self) if known else f"set {self.state!r} to {value}"

    def after(self, situation: Situation, vocabulary: Vocabulary) -> Situation:
        """The internal state has its new value."""
        states = dict(situation.states)
        states[self.state] = vocabulary.state_names[self.state].after(states[self.state], self)
        return replace(situation, states=tuple(states.items()))


COMPARISONS: Mapping[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
}
"""How a percept may be compared; but for the first two, only with numbers."""

OPERATIONS = ("=", "+=", "-=")
"""How an internal state may be changed; but for the first, only counters."""


def format_value(value: Value) -> str:
    """As rules write it: the shortest text that reads back as exactly this value."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value).removesuffix(".0") if isinstance(value, int | float) else value


def _term(term: Term | str) -> Term:
    """A term without arguments may be given by its name."""
    return Term(term) if isinstance(term, str) else term


def clean_text(text: str) -> str:
    """Free text as files can carry it: printable, no blank edges, no spaces at line ends."""
    lines = (
        "".join(char for char in line.replace("\t", " ") if char.isprintable()).rstrip()
        for line in text.splitlines()
    )
    return "\n".join(lines).strip("\n")


def clean_line(text: str) -> str:
    """Free text on one line."""
    return clean_text(text).replace("\n", " ").strip()


@dataclass(frozen=True)
class Rule:
    """One rule: active if all preconditions hold and the behaviour is among `behaviours`.

    Attributes:
        preconditions: All must hold; none means always.
        behaviours: The current behaviour must be among them; none means any.
        actions: Each drawn on its own, in order.
        comment: What the rule is for, in the author's words.
        enabled: False switches the rule off without deleting it.
    """

    preconditions: tuple[Precondition, ...] = ()
    behaviours: tuple[Term, ...] = ()
    actions: tuple[Action, ...] = ()
    comment: str = ""
    enabled: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "behaviours", tuple(map(_term, self.behaviours)))
        object.__setattr__(self, "comment", clean_text(self.comment))


@dataclass(frozen=True)
class Origin:
    """Where a rule set came from; fields that do not apply are None."""

    preset: str | None = None
    run: str | None = None
    generation: int | None = None
    fitness: float | None = None

    def __post_init__(self) -> None:
        for key in ("preset", "run"):
            value = getattr(self, key)
            object.__setattr__(self, key, None if value is None else clean_line(value))


@dataclass(frozen=True)
class RuleSet:
    """The controller that every robot of the swarm runs.

    Attributes:
        rules: In order, R1 first.
        name: What it is called.
        comment: What it is for, in the author's words.
        origin: Where it came from.
        scenario: Name of the scenario in whose words it was written; empty for foraging's.
    """

    rules: tuple[Rule, ...] = ()
    name: str = ""
    comment: str = ""
    origin: Origin = field(default_factory=Origin)
    scenario: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", clean_line(self.name))
        object.__setattr__(self, "comment", clean_text(self.comment))
        object.__setattr__(self, "scenario", clean_line(self.scenario))

    @property
    def active_rules(self) -> tuple[Rule, ...]:
        """The rules that are not switched off."""
        return tuple(rule for rule in self.rules if rule.enabled)

    def _repr_html_(self) -> str:
        """How notebooks show it: like the paper's tables."""
        return as_html(self)
