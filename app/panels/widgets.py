"""Input widgets that show what the session holds."""

from __future__ import annotations

from html import escape
from typing import Any

import viser


class Mirror:
    """Assigns to widgets only what has changed in the session.

    A widget that differs from the session need not be wrong: the user may have just changed it,
    and the command is still on its way.
    """

    def __init__(self) -> None:
        self._last: dict[int, object] = {}

    def show(self, widget: Any, value: object) -> None:
        """Assign a value that is another one than at the last call; viser types it read-only."""
        if self._last.get(id(widget), self) != value:
            self._last[id(widget)] = value
            if widget.value != value:
                widget.value = value

    def forget(self, widget: Any) -> None:
        """Assign at the next call, whatever was shown before: the user's choice was refused."""
        self._last.pop(id(widget), None)


class Refusal:
    """A line that says why what was asked for last is not possible."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html("", visible=False)
        self._text = ""

    def show(self, text: str) -> bool:
        """Show a plain text, nothing if it is empty; True if it is another one than before."""
        if text == self._text:
            return False
        self._text = text
        self._html.content = (
            '<div style="margin:.2em .9em;padding:.4em .6em;font-size:.85em;border-radius:4px;'
            f'background:#fdecea;color:#8a1c12">Not possible: {escape(text)}</div>'
        )
        self._html.visible = bool(text)
        return True
