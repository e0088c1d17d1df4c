"""What the rule table page is told. Places count from 0; `rule` of a finding from 1."""

from __future__ import annotations

from typing import Literal, TypeAlias

from msgspec import UNSET, UnsetType

from geswarm.rules import RuleSet, Term
from geswarm.rules.findings import Severity
from geswarm.rules.model import Value

from .base import Message, Structure
from .edits import RulePart

Role: TypeAlias = str
"""`current`, `before`, or the name of a reference."""


class ArgumentOffer(Structure, frozen=True):
    """What may stand in the parentheses of a term."""

    name: str
    unit: str
    offered: tuple[Value, ...]


class PerceptOffer(Structure, frozen=True):
    """What can be compared in a precondition.

    Attributes:
        holds: Words, which may hold arguments in braces.
        fails: The same for its contrary.
    """

    name: str
    holds: str
    fails: str
    arguments: tuple[ArgumentOffer, ...]
    values: tuple[Value, ...]
    comparisons: tuple[str, ...]


class BehaviourOffer(Structure, frozen=True):
    """A behaviour of the vocabulary.

    Attributes:
        doing: Words, which may hold arguments in braces.
        colour: Of the LEDs.
    """

    name: str
    doing: str
    colour: str
    arguments: tuple[ArgumentOffer, ...]


class StateOffer(Structure, frozen=True):
    """An internal state of the vocabulary."""

    name: str
    on: str
    off: str
    values: tuple[Value, ...]
    counts: bool


class PresetOffer(Structure, frozen=True):
    """A rule set that can be loaded by its name."""

    name: str
    title: str


class ObjectiveOffer(Structure, frozen=True):
    """What rules are for.

    Attributes:
        expression: Over measures.
        unit: Of its values.
        label: Both.
        maximise: More is better.
    """

    expression: str
    unit: str
    label: str
    maximise: bool


class VocabularyMessage(Message, frozen=True):
    """The names that rules are made of, with their colours, the presets, and the objective."""

    preconditions: tuple[PerceptOffer, ...]
    behaviours: tuple[BehaviourOffer, ...]
    internal_states: tuple[StateOffer, ...]
    probabilities: tuple[float, ...]
    presets: tuple[PresetOffer, ...]
    objective: ObjectiveOffer


class RuleFinding(Structure, frozen=True):
    """Something to know about the rules.

    Attributes:
        line: Of the text, if it was typed.
        rule: Number of the rule, from 1; null if it is about all of them.
        severity: A hint is true but harmless.
    """

    line: int | None
    rule: int | None
    element: str
    message: str
    severity: Severity


class RulesMessage(Message, frozen=True):
    """The rules as they stand, in all their forms, with what is known of them so far.

    Attributes:
        english: Each rule as a sentence.
        text: The rule set in the rule language.
        rule_texts: Each rule in the rule language.
        loaded: The version loaded last.
        loaded_text: The same in the rule language.
        simpler: Elements that can go without changing the behaviour; absent while unknown.
    """

    version: int
    can_undo: bool
    can_redo: bool
    rule_set: RuleSet
    english: tuple[str, ...]
    text: str
    rule_texts: tuple[str, ...]
    loaded: RuleSet
    loaded_text: str
    findings: tuple[RuleFinding, ...] = ()
    simpler: int | UnsetType = UNSET


class SimplifiedMessage(Message, frozen=True):
    """The shortest rules that behave as those of a version, and what they leave out."""

    version: int
    rule_set: RuleSet
    text: str
    removed: tuple[str, ...]


class TextFindingsMessage(Message, frozen=True):
    """What there is to know about a text that was typed."""

    findings: tuple[RuleFinding, ...]


class LiveMessage(Message, frozen=True):
    """What the swarm does now.

    Attributes:
        time: Simulated time, s.
        fired: How often each rule has fired since the start, all robots together.
        behaviours: Robots in each behaviour, in the order of the vocabulary.
    """

    time: float
    fired: tuple[int, ...]
    behaviours: tuple[int, ...]
    robots: int


class DrawnState(Structure, frozen=True):
    """A state of the state machine.

    Attributes:
        means: What robots in it do, in words.
    """

    label: str
    behaviour: Term
    means: str
    initial: bool


class DrawnTransition(Structure, frozen=True):
    """A transition of the state machine.

    Attributes:
        source: Index of a state.
        target: Index of a state.
        when: Its condition.
        rate: Probability per control step and mean waiting time, in words.
        effects: What it does besides, in words.
        rules: Numbers of the rules behind it, from 1.
        words: All of this in a line.
    """

    source: int
    target: int
    when: str
    rate: str
    effects: tuple[str, ...]
    rules: tuple[int, ...]
    words: str


class StatesMessage(Message, frozen=True):
    """The state machine of the rules and its picture.

    Attributes:
        svg: Drawn by geswarm.exports.brief_svg.
    """

    svg: str
    states: tuple[DrawnState, ...]
    transitions: tuple[DrawnTransition, ...]


class ActivityMessage(Message, frozen=True):
    """What the swarm does in the state machine that was sent last.

    Attributes:
        time: Simulated time, s.
        robots: In each state.
        taken: How often each transition was taken since the rules were set.
        swarm: Robots in all.
    """

    time: float
    robots: tuple[int, ...]
    taken: tuple[int, ...]
    swarm: int


class RoleSample(Structure, frozen=True):
    """The objective in each run."""

    role: Role
    name: str
    fitness: tuple[float, ...]


class RoleComparison(Structure, frozen=True):
    """Mean of the current rules minus mean of the other's, same seeds.

    Attributes:
        role: The other rules.
        low: Lower end of the 95 % interval.
        high: Upper end.
    """

    role: Role
    difference: float
    low: float
    high: float
    p_value: float | None


class VerdictMessage(Message, frozen=True):
    """What is known of the verdict.

    Attributes:
        runs: How many there will be in each sample.
    """

    version: int
    busy: bool
    scenario: str = ""
    runs: int = 0
    samples: tuple[RoleSample, ...] = ()
    comparisons: tuple[RoleComparison, ...] = ()


class WeighedPiece(Structure, frozen=True):
    """Mean without the piece minus mean with it, and its 95 % interval."""

    rule: int
    part: Literal["rule"] | RulePart
    at: int | None
    difference: float
    low: float
    high: float
    p_value: float | None


class WorthMessage(Message, frozen=True):
    """What is known of the worth of each piece."""

    version: int
    busy: bool
    done: int
    total: int
    pieces: tuple[WeighedPiece, ...]


class FileMessage(Message, frozen=True):
    """A file to download."""

    name: str
    text: str


class Person(Structure, frozen=True):
    """Somebody who looks at the rules."""

    name: str
    you: bool


class PeopleMessage(Message, frozen=True):
    """Who is there."""

    people: tuple[Person, ...]


class ChangedMessage(Message, frozen=True):
    """Somebody else did that."""

    who: str
    what: str


class StaleMessage(Message, frozen=True):
    """A change was not made: it was meant for a version that is no longer there.

    Attributes:
        version: The one that it was meant for.
    """

    version: int
    text: str


class UnsavedRules(Structure, frozen=True):
    """Rules of a dashboard that was killed.

    Attributes:
        rules: How many.
        edited: Seconds since 1970.
    """

    file: str
    name: str
    rules: int
    edited: float


class UnsavedMessage(Message, frozen=True):
    """What killed dashboards left."""

    left: tuple[UnsavedRules, ...]
