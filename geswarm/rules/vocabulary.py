"""The names that rules are made of (paper, section 3.1.1), as data.

Grammar, parser, editor, control table and kernels all read the vocabulary from here. Positions
matter: percept bits, behaviour codes and internal-state bits are the indices into these tuples.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class PreconditionName:
    """A percept that a rule may test, with the phrases that say it holds or does not."""

    name: str
    holds: str
    fails: str


@dataclass(frozen=True)
class BehaviourName:
    """A low-level behaviour that a robot executes.

    Attributes:
        name: As written in rules.
        doing: Phrase that describes it.
        start: Phrase for changing to it.
        restarts: True if switching into it starts something afresh (random walk: a new heading).
    """

    name: str
    doing: str
    start: str
    restarts: bool = False


@dataclass(frozen=True)
class InternalStateName:
    """An internal state variable.

    Attributes:
        name: As written in rules.
        on: Phrase for setting it true.
        off: Phrase for setting it false.
        initially: Value at the start of a run.
        momentary: True if it is false again after every control step.
    """

    name: str
    on: str
    off: str
    initially: bool = False
    momentary: bool = False


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


@dataclass(frozen=True)
class Vocabulary:
    """Everything that a rule may mention; the order fixes bits and codes.

    Attributes:
        preconditions: Percepts.
        behaviours: Low-level behaviours.
        internal_states: Internal state variables.
        probabilities: Values of p that the grammar and the editor offer.
        initial_behaviour: Behaviour at the start of a run.
        apart: Pairs of percepts that never hold together.
        objects: What carries, wants and drops objects; None if there are none.
    """

    preconditions: tuple[PreconditionName, ...]
    behaviours: tuple[BehaviourName, ...]
    internal_states: tuple[InternalStateName, ...]
    probabilities: tuple[float, ...]
    initial_behaviour: str
    apart: tuple[tuple[str, str], ...] = ()
    objects: ObjectNames | None = None

    @cached_property
    def precondition_index(self) -> dict[str, int]:
        """Percept bit of each precondition name."""
        return {entry.name: bit for bit, entry in enumerate(self.preconditions)}

    @cached_property
    def behaviour_index(self) -> dict[str, int]:
        """Code of each behaviour name."""
        return {entry.name: code for code, entry in enumerate(self.behaviours)}

    @cached_property
    def state_index(self) -> dict[str, int]:
        """Bit of each internal-state name."""
        return {entry.name: bit for bit, entry in enumerate(self.internal_states)}

    @cached_property
    def initial_states(self) -> int:
        """Internal states at the start of a run, as bits."""
        return sum(entry.initially << bit for bit, entry in enumerate(self.internal_states))

    @cached_property
    def lasting_states(self) -> int:
        """Mask of the internal states that survive the end of a control step."""
        return sum((not entry.momentary) << bit for bit, entry in enumerate(self.internal_states))


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
)
