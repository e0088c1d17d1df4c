"""What a person changes while a run goes on, as values that can be stored and applied again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from geswarm.ge.engine import Engine


@dataclass(frozen=True)
class Injection:
    """A sentence enters the population."""

    sentence: str

    def apply(self, engine: Engine) -> None:
        """Have the engine's next generation contain it; see `Engine.inject`."""
        engine.inject(self.sentence)


@dataclass(frozen=True)
class SettingsChange:
    """Settings have other values from now on; see `Engine.steer`."""

    settings: Mapping[str, float]

    def apply(self, engine: Engine) -> None:
        """Change them from the engine's next generation on."""
        engine.steer(**self.settings)


Steering: TypeAlias = Injection | SettingsChange


@dataclass(frozen=True)
class StoredSteering:
    """Steering that was recorded.

    Attributes:
        generation: The first generation that it acted on.
        what: The change.
    """

    generation: int
    what: Steering


def to_json(steering: Steering) -> dict[str, Any]:
    """Steering in JSON types."""
    if isinstance(steering, Injection):
        return {"inject": steering.sentence}
    return {"settings": dict(steering.settings)}


def from_json(data: Mapping[str, Any]) -> Steering:
    """What `to_json` made.

    Raises:
        ValueError: It is something else.
    """
    match data:
        case {"inject": str(sentence)}:
            return Injection(sentence)
        case {"settings": dict(settings)}:
            return SettingsChange(settings)
    raise ValueError("expected a sentence to inject or settings")
