"""What the evolution page is told. All but behaviours counts from 0, these from 1."""

from __future__ import annotations

from typing import Literal, TypeAlias

from .base import Message, Structure, Typed

PhaseName: TypeAlias = Literal["IDLE", "RUNNING", "PAUSED", "STOPPED", "FINISHED", "FAILED"]
FieldKind: TypeAlias = Literal["whole", "number", "choice", "switch"]


class SettingField(Structure, frozen=True):
    """A parameter of a run."""

    name: str
    kind: FieldKind
    choices: tuple[str, ...]
    help: str
    steerable: bool


class FormMessage(Message, frozen=True):
    """All parameters that a run has, and the presets that fill them."""

    presets: tuple[str, ...]
    most_compared: int
    fields: tuple[SettingField, ...]


class TableRule(Structure, frozen=True):
    """A rule of the table, and whether evolution must not change it."""

    text: str
    frozen: bool
    enabled: bool


class PlanMessage(Message, frozen=True):
    """The next run, as it was typed.

    Attributes:
        changed: Fields that differ from the preset.
        idle: Fields that have no effect beside the others.
        findings: What is wrong, by field.
        table: Name of the rules in the table.
        moved: The frozen rules are not the first ones.
    """

    preset: str
    values: dict[str, Typed]
    changed: tuple[str, ...]
    idle: tuple[str, ...]
    findings: dict[str, str]
    seed: Typed
    from_table: bool
    scenario: str
    table: str
    rules: tuple[TableRule, ...]
    moved: bool


class NearestPreset(Structure, frozen=True):
    """The preset that settings are closest to, and where they differ."""

    name: str
    changed: tuple[str, ...]


class AboutRun(Structure, frozen=True):
    """What the run looked at is.

    Attributes:
        frozen: How many rules.
        version: Of the GESwarm that began it, if that is another one.
        fall: Where the best so far is less than it was: a word for it.
    """

    scenario: str
    preset: NearestPreset
    seed: int
    frozen: int
    generations: int
    done: int
    finished: bool
    version: str | None
    best: float | None
    fall: str
    mean: float | None


class EvolutionMessage(Message, frozen=True, tag="status"):
    """What the evolution does now, and which run is looked at.

    Attributes:
        run: The present or last one.
        remarks: What there is to know of the present run.
        resumable: The run looked at can go on.
        shown: The run looked at.
        problem: Why it cannot be looked at.
        settings: What can be steered; nothing unless a run is open.
    """

    phase: PhaseName
    active: bool
    error: str
    run: str | None
    remarks: tuple[str, ...]
    resumable: bool
    done: int
    generations: int
    shown: str | None
    problem: str
    about: AboutRun | None
    settings: dict[str, float]
    idle: tuple[str, ...]


class ReferenceLevel(Structure, frozen=True):
    """What a preset collects in the scenario of the run."""

    name: str
    mean: float


class CurveMark(Structure, frozen=True):
    """What a person did to a run.

    Attributes:
        generation: The first one that it acted on.
        fitness: Of the rules that entered; null if it was something else.
    """

    generation: int
    text: str
    fitness: float | None


class CurvesMessage(Message, frozen=True):
    """The curves of the run looked at, the references, and what people did to it.

    Attributes:
        label: What the curves are of: the objective, or what it is less than nothing.
        reevaluated: Its best is evaluated again and again, so that its curve can fall.
    """

    run: str | None
    label: str
    reevaluated: bool
    generation: tuple[int, ...]
    best_so_far: tuple[float, ...]
    best: tuple[float, ...]
    mean: tuple[float, ...]
    references: tuple[ReferenceLevel, ...]
    marks: tuple[CurveMark, ...]


class OtherCurve(Structure, frozen=True):
    """The best so far of a run that is compared.

    Attributes:
        reevaluated: As in CurvesMessage.
    """

    name: str
    colour: int
    reevaluated: bool
    generation: tuple[int, ...]
    best_so_far: tuple[float, ...]


class ComparedRunsMessage(Message, frozen=True, tag="compared"):
    """The runs that are compared."""

    runs: tuple[OtherCurve, ...]


class Histogram(Structure, frozen=True):
    """How many values lie in each of equally wide bins, and the mean of all."""

    low: float
    high: float
    mean: float
    counts: tuple[int, ...]


class IndividualRow(Structure, frozen=True, array_like=True):
    """An individual of the last generation."""

    generation: int
    key: int
    fitness: float
    evaluations: int
    codons: int
    rules: int | None
    behaviour: int | None


class PopulationMessage(Message, frozen=True):
    """The individuals of the last generation, the best first, and how they differ.

    Attributes:
        coloured: Common behaviours: number, how many have it, colour.
    """

    generation: int
    size: int
    invalid: int
    behaviours: int
    diversity: float
    coloured: tuple[tuple[int, int, str], ...]
    fitness: Histogram
    codons: Histogram
    members: tuple[IndividualRow, ...]


class AncestorRow(Structure, frozen=True, array_like=True):
    """Somebody from whom the best descends; births of the parents are generation and key."""

    generation: int
    key: int
    fitness: float
    parents: tuple[tuple[int, int], ...]


class DescentRow(Structure, frozen=True, array_like=True):
    """Somebody in the line of first parents, and how it was bred."""

    generation: int
    key: int
    fitness: float
    bred: str
    codons: int


class AncestorsMessage(Message, frozen=True):
    """Whom the best descends from: all of them, and the line of first parents, newest first."""

    all: tuple[AncestorRow, ...]
    line: tuple[DescentRow, ...]


class KeptRun(Structure, frozen=True):
    """A run that is kept.

    Attributes:
        colour: Of its curve and its box, if it is compared.
        elsewhere: It is under way in another process.
        fall: As in AboutRun.
        written: Seconds since 1970.
    """

    name: str
    colour: int | None
    elsewhere: bool
    problem: str
    scenario: str
    preset: NearestPreset | None
    seed: int | None
    done: int
    generations: int | None
    best: float | None
    fall: str
    phase: PhaseName
    written: float


class RunsMessage(Message, frozen=True):
    """All runs that are kept."""

    runs: tuple[KeptRun, ...]


class ChosenIndividual(Structure, frozen=True):
    """The individual looked at."""

    run: str
    generation: int
    key: int
    fitness: float


class ReadRule(Structure, frozen=True):
    """A rule in the rule language and as a sentence."""

    text: str
    english: str


class ChosenMessage(Message, frozen=True):
    """The individual looked at and its rules."""

    individual: ChosenIndividual | None
    rules: tuple[ReadRule, ...]
