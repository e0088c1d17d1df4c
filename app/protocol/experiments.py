"""What the experiments page is told, and what it asks for."""

from __future__ import annotations

from typing import Literal, TypeAlias

from .base import Message, Name, Request, Structure, Typed, TypedRequest

CampaignPhase: TypeAlias = Literal["IDLE", "RUNNING", "STOPPED", "FINISHED", "FAILED"]
ClaimVerdict: TypeAlias = Literal["HOLDS", "FAILS", "OPEN"]


class Offer(Structure, frozen=True):
    """Something that can be chosen."""

    name: str
    chosen: bool


class ChoiceMessage(Message, frozen=True):
    """What can be compared, and what is chosen, as it was typed.

    Attributes:
        table: Name of the rules in the table.
        arena: Name of the scenario of the arena.
        findings: What is wrong, by name.
    """

    rules: tuple[Offer, ...]
    scenarios: tuple[Offer, ...]
    table: str
    arena: str
    against: str
    runs: Typed
    seed: Typed
    findings: dict[str, str]


class CaseResult(Structure, frozen=True):
    """A rule set in a scenario.

    Attributes:
        fitness: Of every run.
    """

    rules: str
    scenario: str
    fitness: tuple[float, ...]
    mean: float
    sd: float
    median: float
    p_value: float | None
    p_holm: float | None
    effect: float | None


class ScenarioResults(Structure, frozen=True):
    """All rule sets in a scenario.

    Attributes:
        objective: What the figures are of.
        maximise: More is better.
    """

    name: str
    objective: str
    maximise: bool
    results: tuple[CaseResult, ...]


class ComparedMessage(Message, frozen=True):
    """The newest comparison as far as it is made.

    Attributes:
        share: Of all the work that is done.
    """

    busy: bool = False
    share: float = 0.0
    error: str = ""
    runs: int = 0
    seed: int = 0
    against: str = ""
    explanation: str = ""
    scenarios: tuple[ScenarioResults, ...] = ()


class DraftMessage(Message, frozen=True):
    """The next campaign, as it was typed.

    Attributes:
        seconds: How long it will take; null if that cannot be told.
    """

    values: dict[str, Typed]
    findings: dict[str, str]
    sizes: tuple[Offer, ...]
    seconds: float | None


class CampaignStatusMessage(Message, frozen=True, tag="status"):
    """The present or last campaign."""

    phase: CampaignPhase
    name: str | None
    share: float
    doing: str
    seconds_left: float | None
    error: str


class PlannedCampaign(Structure, frozen=True):
    """How large a campaign is."""

    runs: int
    generations: int
    evaluations: int
    seed: int


class KeptCampaign(Structure, frozen=True):
    """A campaign that is kept.

    Attributes:
        written: Seconds since 1970.
    """

    name: str
    problem: str
    plan: PlannedCampaign | None
    reported: bool
    written: float


class CampaignsMessage(Message, frozen=True):
    """All campaigns that are kept, and which of them is looked at."""

    shown: str | None
    campaigns: tuple[KeptCampaign, ...]


class CampaignPart(Structure, frozen=True):
    """How far a part of a campaign is."""

    name: str
    done: int
    total: int


class SeedCurve(Structure, frozen=True):
    """The best so far of an evolution, only where it rises."""

    name: str
    generation: tuple[int, ...]
    best_so_far: tuple[float, ...]


class CurveLevel(Structure, frozen=True):
    """What a preset collects."""

    name: str
    mean: float


class JudgedClaim(Structure, frozen=True):
    """A claim of the paper."""

    where: str
    paper: str
    found: str
    verdict: ClaimVerdict
    words: str


class CampaignMessage(Message, frozen=True):
    """The campaign looked at; without a name there is none."""

    name: str | None
    problem: str
    share: float = 0.0
    reported: bool = False
    parts: tuple[CampaignPart, ...] = ()
    curves: tuple[SeedCurve, ...] = ()
    levels: tuple[CurveLevel, ...] = ()
    claims: tuple[JudgedClaim, ...] = ()


class ChooseCase(Request, frozen=True, tag="choose"):
    """Compare a rule set, or in a scenario, or no longer."""

    what: Literal["rules", "scenarios"]
    name: Name
    on: bool


class SetChoice(TypedRequest, frozen=True, tag="choice"):
    """`against`, `runs` or `seed` of the comparison was typed."""

    name: Literal["against", "runs", "seed"]


class AddFile(Request, frozen=True, tag="file"):
    """A rule set from a file is offered from now on."""

    name: Name
    text: str


class CompareChosen(Request, frozen=True, tag="compare"):
    """Begin the comparison."""


class CancelComparison(Request, frozen=True, tag="cancel"):
    """Do not go on with it."""


class ChooseSize(Request, frozen=True, tag="size"):
    """Fill the next campaign."""

    name: Name


class SetDraft(TypedRequest, frozen=True, tag="draft"):
    """A value of the next campaign was typed."""


class StartCampaign(Request, frozen=True, tag="start"):
    """Begin the next campaign."""


class StopCampaign(Request, frozen=True, tag="stop"):
    """Stop the campaign under way."""


class ResumeCampaign(Request, frozen=True, tag="resume"):
    """Go on with a campaign."""

    name: Name


class OpenCampaign(Request, frozen=True, tag="open"):
    """Look at a campaign."""

    name: Name
