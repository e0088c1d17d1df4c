"""What viser's widgets need besides."""

from __future__ import annotations

from typing import Any


def show_value(widget: Any, value: object) -> None:
    """Assign the value of an input if it is another one; viser types it read-only."""
    if widget.value != value:
        widget.value = value
