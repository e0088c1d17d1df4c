"""Edits of the rules, as pages make them; places count from 0."""

from __future__ import annotations

from abc import ABC
from typing import Annotated, Any, Literal, TypeAlias

import msgspec

from geswarm.rules import Action, Precondition, Rule, Term
from geswarm.rules.as_json import (
    action_from_json,
    precondition_from_json,
    rule_from_json,
    term_from_json,
)
from geswarm.rules.edits import MAX_COMMENT
from geswarm.rules.findings import shown

from .base import Structure, Text, Whole, kind_of

RulePart: TypeAlias = Literal["preconditions", "behaviours", "actions"]
Comment: TypeAlias = Annotated[str, msgspec.Meta(max_length=MAX_COMMENT)]

_KINDS = {"preconditions": Precondition, "behaviours": Term, "actions": Action}


class RuleElement(ABC):  # noqa: B024 - the pieces of the model are registered with it
    """A precondition, a behaviour or an action; `read_model` tells them apart."""


class WholeRule(ABC):  # noqa: B024
    """A rule; `read_model` knows its parts."""


for _kind in _KINDS.values():
    RuleElement.register(_kind)
WholeRule.register(Rule)


def read_model(kind: type, value: Any) -> Any:
    """A piece of a rule set in a JSON value, for msgspec.

    Raises:
        JsonError: It has another shape.
    """
    if kind is WholeRule:
        return rule_from_json(value)
    keys = set(value) if isinstance(value, dict) else set()
    if keys & {"p", "behaviour", "state"}:
        return action_from_json(value)
    if keys & {"percept", "holds"}:
        return precondition_from_json(value)
    return term_from_json(value, "expected a precondition, a behaviour or an action")


class Edit(Structure, frozen=True, tag_field="do", tag=kind_of):
    """A change of the rules."""


class PlaceEdit(Edit, frozen=True):
    """Rules are put in.

    Attributes:
        at: Where the first of them will be.
    """

    at: Whole


class RuleEdit(Edit, frozen=True):
    """A rule is changed.

    Attributes:
        rule: Which one.
    """

    rule: Whole


class SetName(Edit, frozen=True):
    """The rules are called something else."""

    name: Comment


class AddRule(PlaceEdit, frozen=True):
    """A rule is put in."""

    rule: WholeRule


class PasteRules(PlaceEdit, frozen=True):
    """Rules in the rule language are put in."""

    text: Text


class RemoveRule(RuleEdit, frozen=True):
    """A rule is taken out."""


class DuplicateRule(RuleEdit, frozen=True):
    """The same rule once more, behind it."""


class MoveRule(RuleEdit, frozen=True):
    """A rule goes to another place.

    Attributes:
        to: Where it is then.
    """

    to: Whole


class SetEnabled(RuleEdit, frozen=True):
    """A rule is switched on or off."""

    enabled: bool


class SetComment(RuleEdit, frozen=True):
    """A rule is explained."""

    comment: Comment


class ElementEdit(RuleEdit, frozen=True):
    """An element of a rule is changed.

    Attributes:
        part: Whether a precondition, a behaviour or an action.
        at: Which one of these.
    """

    part: RulePart
    at: Whole


class WithElement(ElementEdit, frozen=True):
    """An element of a rule is put in.

    Attributes:
        element: What it is then.
    """

    element: RuleElement

    def __post_init__(self) -> None:
        if not isinstance(self.element, _KINDS[self.part]):
            raise ValueError(f"element: expected one of the {self.part}, got {shown(self.element)}")


class AddElement(WithElement, frozen=True, tag="add"):
    """Another element is put in."""


class SetElement(WithElement, frozen=True, tag="set"):
    """An element becomes another one."""


class RemoveElement(ElementEdit, frozen=True, tag="remove"):
    """An element is taken out."""


AnyEdit: TypeAlias = (
    SetName
    | AddRule
    | PasteRules
    | RemoveRule
    | DuplicateRule
    | MoveRule
    | SetEnabled
    | SetComment
    | AddElement
    | SetElement
    | RemoveElement
)
