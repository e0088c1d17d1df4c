"""What messages are made of, and those that every page knows."""

from __future__ import annotations

import re
from types import ModuleType
from typing import Annotated, Literal, TypeAlias

import msgspec

from geswarm.rules.limits import MAX_CHARACTERS

MAX_NAME = 255
"""Characters of a name, and of a value that is typed."""

Name: TypeAlias = Annotated[str, msgspec.Meta(max_length=MAX_NAME)]
Text: TypeAlias = Annotated[str, msgspec.Meta(max_length=MAX_CHARACTERS)]
Whole: TypeAlias = Annotated[int, msgspec.Meta(ge=0, lt=2**53)]
"""A browser's numbers are whole up to there."""
Typed: TypeAlias = bool | int | float | Name
"""As it was typed or ticked, right or wrong."""


def kind_of(name: str) -> str:
    """What messages of a class are called: `text_findings` for TextFindingsMessage."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name.removesuffix("Message")).lower()


class Structure(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A message, or what messages are made of."""


class Message(Structure, frozen=True, tag_field="type", tag=kind_of):
    """What is said to a page."""


class Request(Structure, frozen=True, tag_field="type", tag=kind_of):
    """What a page says."""


class NoticeMessage(Message, frozen=True):
    """Something that could not be done, or that was.

    Attributes:
        level: An error stays until it is dismissed.
        text: Empty: what it is about is over.
        about: `journal`, or absent: what was asked for last.
    """

    level: Literal["error", "info"]
    text: str
    about: Literal["journal"] | msgspec.UnsetType = msgspec.UNSET


class FrameTime(Request, frozen=True):
    """How fast a browser draws, told every few seconds.

    Attributes:
        milliseconds: Per frame; null if it is not looked at.
    """

    milliseconds: float | None


class Watch(Request, frozen=True):
    """The page is in view."""


class TypedRequest(Request, frozen=True):
    """A value was typed or ticked.

    Attributes:
        name: Of what.
        value: The value.
    """

    name: Name
    value: Typed

    def __post_init__(self) -> None:
        if len(str(self.value)) > MAX_NAME:
            raise ValueError(f"value: expected at most {MAX_NAME} characters, got more")


def kinds_in(module: ModuleType, below: type[Structure]) -> dict[str, type[Structure]]:
    """The messages of a module below a class, by what they are called; only the last of a line."""
    return {
        str(one.__struct_config__.tag): one
        for one in vars(module).values()
        if isinstance(one, type)
        and issubclass(one, below)
        and one.__module__ == module.__name__
        and not one.__subclasses__()
    }
