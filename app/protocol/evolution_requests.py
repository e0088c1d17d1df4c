"""What the evolution page asks for."""

from __future__ import annotations

from .base import Name, Request, TypedRequest, Whole


class ByName(Request, frozen=True):
    """Something about a preset or a run."""

    name: Name


class ChoosePreset(ByName, frozen=True, tag="preset"):
    """Fill the plan of the next run."""


class SetPlan(TypedRequest, frozen=True, tag="plan"):
    """A setting of the next run, its `seed` or `from_table` was typed."""


class Freeze(Request, frozen=True):
    """Evolution must not change a rule of the table, or may again."""

    rule: Whole
    on: bool


class StartRun(Request, frozen=True, tag="start"):
    """Begin the next run.

    Attributes:
        instead: Also if that stops the one under way.
    """

    instead: bool = False


class PauseRun(Request, frozen=True, tag="pause"):
    """Pause the run under way."""


class GoOn(Request, frozen=True):
    """Go on with the paused run."""


class StopRun(Request, frozen=True, tag="stop"):
    """Stop the run under way."""


class Steer(Request, frozen=True):
    """Change a setting of the run under way."""

    name: Name
    value: int | float


class Inject(Request, frozen=True):
    """Put the rules of the table into the population."""


class LoadBest(Request, frozen=True):
    """Put the best rules into the table."""


class ChooseIndividual(Request, frozen=True, tag="choose"):
    """Look at an individual."""

    generation: Whole
    key: Whole


class Forget(Request, frozen=True):
    """Look at no individual."""


class LoadChosen(Request, frozen=True, tag="load"):
    """Put the rules of the individual looked at into the table."""


class CompareWith(Request, frozen=True):
    """Run the individual looked at in the arena, beside the table."""


class OpenRun(ByName, frozen=True, tag="open"):
    """Look at a run."""


class CompareRun(ByName, frozen=True, tag="compare"):
    """Lay the curve of a run over the others, or no longer."""

    on: bool


class ResumeRun(ByName, frozen=True, tag="resume"):
    """Go on with a run.

    Attributes:
        generations: How many it is to have; null for as many as it was to have.
        instead: As in StartRun.
    """

    generations: int | None = None
    instead: bool = False


class DeleteRun(ByName, frozen=True, tag="delete"):
    """Delete a run."""
