"""Input widgets that show what the session holds."""

from __future__ import annotations

from typing import Any


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
