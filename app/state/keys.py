"""The keys that play the arena: those of ARGoS."""

from __future__ import annotations

from typing import Literal, TypeAlias

from .session import Command

Key: TypeAlias = Literal["P", "O", "X", "F", "R"]

KEYS: tuple[tuple[Key, str, Command], ...] = (
    ("P", "Play", lambda session: session.play()),
    ("O", "Pause", lambda session: session.pause()),
    ("X", "Step", lambda session: session.step()),
    ("F", "Fast-forward, or back to 1x", lambda session: session.toggle_fastest()),
    ("R", "Reset", lambda session: session.reset()),
)
"""Key, name and command."""

COMMANDS: dict[str, Command] = {key: command for key, _, command in KEYS}
