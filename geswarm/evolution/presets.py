"""The settings with which rules evolve in a scenario, unless somebody says otherwise."""

from __future__ import annotations

from typing import Any

from geswarm.ge import Settings
from geswarm.sim import Scenario


def preset_for(scenario: Scenario, name: str = "paper", **given: Any) -> Settings:
    """A preset, with as many evaluations for each of its own as the scenario asks for.

    Args:
        scenario: Where rules are going to evolve.
        name: Of the preset.
        **given: What is to be otherwise; nothing is multiplied then.

    Raises:
        SettingsError: There is no such preset, or a value cannot be used.
    """
    preset = Settings.preset(name)
    evaluations = preset.evaluations * scenario.evaluations
    return Settings.preset(name, **{"evaluations": evaluations, **given})
