"""What the rule table page asks for."""

from __future__ import annotations

from typing import Literal

from .base import Request, Text
from .edits import AnyEdit


class ChangeRequest(Request, frozen=True, kw_only=True):
    """A change of the rules as the page was told them last.

    Attributes:
        version: Of these rules; the session of the page fills it in.
    """

    version: int


class TextRequest(Request, frozen=True):
    """Something about a text in the rule language."""

    text: Text


class NameRequest(Request, frozen=True):
    """Something by its name."""

    name: Text


class FileRequest(Request, frozen=True):
    """Something about rules that a killed dashboard left.

    Attributes:
        file: Its name.
    """

    file: Text


class MakeEdit(ChangeRequest, frozen=True, tag="edit"):
    """Make one edit."""

    edit: AnyEdit


class Undo(ChangeRequest, frozen=True):
    """Take the last change back."""


class Redo(ChangeRequest, frozen=True):
    """Make the change again that was taken back last."""


class SetText(ChangeRequest, frozen=True):
    """Change the rules to what was typed."""

    text: Text


class TakeSimplified(ChangeRequest, frozen=True):
    """Put the shortest rules in place that were shown for a version."""


class LoadPreset(NameRequest, frozen=True):
    """Load a preset."""


class LoadText(TextRequest, frozen=True):
    """Load the text of a file.

    Attributes:
        name: Of the file.
    """

    name: Text


class Save(Request, frozen=True):
    """Answer with a file."""

    format: Literal["yaml", "text", "json"]


class CheckText(TextRequest, frozen=True):
    """Answer with what is wrong with a text."""


class Simplify(Request, frozen=True):
    """Answer with the shortest rules."""


class PressKey(Request, frozen=True, tag="key"):
    """A key of the arena was pressed over the table."""

    key: Literal["P", "O", "X", "F", "R"]


class WorthStart(Request, frozen=True):
    """Find out what each piece is worth."""


class WorthCancel(Request, frozen=True):
    """Do not go on with that."""


class BeCalled(NameRequest, frozen=True, tag="name"):
    """This is who looks at the page."""


class BringBack(FileRequest, frozen=True):
    """Put these rules in place."""


class Discard(FileRequest, frozen=True):
    """Forget these rules."""
