"""What is going to run, and where: rule sets and AutoMoDe's controllers in scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from geswarm.cli.arguments import UsageError

if TYPE_CHECKING:
    from geswarm.automode import Runnable
    from geswarm.sim import Scenario


def read_runnable(
    names: Sequence[str], scenarios: Sequence[str]
) -> tuple[list[Scenario], list[tuple[str, Runnable]]]:
    """The scenarios, and what runs in each of them, by name.

    Raises:
        UsageError: Something is not there, cannot be read, or cannot run in one of the scenarios.
    """
    from geswarm.automode import AutoMoDeError, find_controllers
    from geswarm.rules import RuleSetError
    from geswarm.sim import (
        ControllerError,
        ScenarioError,
        load_scenario,
        parts_of,
        require_runnable,
        vocabulary_of,
    )

    try:
        loaded = [load_scenario(name).with_changes(name=name) for name in scenarios]
        found = find_controllers(names)
        for scenario in reversed(loaded):  # what runs is the same in each that has its words
            known = vocabulary_of(scenario)
            read = [pair for one in found for pair in one.read(known, scenario.name).items()]
            require_runnable(dict(read), parts_of(scenario))
    except (RuleSetError, AutoMoDeError, ControllerError, ScenarioError) as error:
        raise UsageError(str(error)) from error
    return loaded, read
