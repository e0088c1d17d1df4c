"""Writes the JavaScript side of all messages: `python -m app.protocol`."""

from __future__ import annotations

from pathlib import Path

from .javascript import written
from .pages import MODULES

STATIC = Path(__file__).resolve().parents[2] / "static"


def main() -> None:
    """Write `static/PAGE/protocol.js` of every page."""
    for page in MODULES:
        (STATIC / page / "protocol.js").write_text(written(page), encoding="utf-8")


if __name__ == "__main__":
    main()
