"""Rule sets as values: R_i = P_i x B_i x A_i (paper, section 2.1).

Everything here is frozen; an edit makes a new rule set. Names are checked against a vocabulary by
`geswarm.rules.check`, not here, so that a rule set with a misspelt name can still be shown.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from geswarm.rules.notebook import as_html

CONTROL_STEP = 0.1
"""How often robots go through their rules (s): the foot-bot's 10 times in a second (section 4)."""


@dataclass(frozen=True)
class Precondition:
    """`name == holds`, for example `ON_NEST == true`."""

    name: str
    holds: bool


@dataclass(frozen=True)
class BehaviourChange:
    """With probability p per control step, change to `behaviour` (production 10)."""

    p: float
    behaviour: str


@dataclass(frozen=True)
class StateChange:
    """With probability p per control step, set the internal state `state` to `value` (11)."""

    p: float
    state: str
    value: bool


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


Action: TypeAlias = BehaviourChange | StateChange


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
    behaviours: tuple[str, ...] = ()
    actions: tuple[Action, ...] = ()
    comment: str = ""
    enabled: bool = True

    def __post_init__(self) -> None:
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
    """The controller that every robot of the swarm runs: rules in order, R1 first."""

    rules: tuple[Rule, ...] = ()
    name: str = ""
    comment: str = ""
    origin: Origin = field(default_factory=Origin)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", clean_line(self.name))
        object.__setattr__(self, "comment", clean_text(self.comment))

    @property
    def active_rules(self) -> tuple[Rule, ...]:
        """The rules that are not switched off."""
        return tuple(rule for rule in self.rules if rule.enabled)

    def _repr_html_(self) -> str:
        """How notebooks show it: like the paper's tables."""
        return as_html(self)
