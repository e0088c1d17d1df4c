"""In whose words rule sets are read: a scenario's vocabulary."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from geswarm.cli.arguments import UsageError

if TYPE_CHECKING:
    from geswarm.rules import RuleSet, RuleSetText, Vocabulary
    from geswarm.sim import Scenario

WORDS_HELP = (
    "in whose words the rules are written: a scenario or a YAML file; default: the one that they "
    "name, or paper"
)


@dataclass(frozen=True)
class Words:
    """A vocabulary and the scenario that offers it.

    Attributes:
        name: Of the scenario, or the path of its file.
        vocabulary: What rules may mention.
    """

    name: str
    vocabulary: Vocabulary
    _scenario: Scenario | None = None

    @property
    def scenario(self) -> Scenario:
        """The scenario itself."""
        from geswarm.sim import load_scenario

        return self._scenario or load_scenario(self.name)

    def read(self, found: RuleSetText) -> RuleSet:
        """A rule set in these words.

        Raises:
            RuleSetError: It mentions something else, or is none.
        """
        return found.read(self.vocabulary, self.name)


def words_of(found: Sequence[RuleSetText], scenario: str | None) -> Words:
    """The words of a scenario; of the one that a rule set names if none is given, or paper's.

    A rule set can name a scenario that comes with GESwarm, or a file beside its own, or that of the
    run in whose directory it lies.

    Raises:
        UsageError: The scenario cannot be used.
    """
    from geswarm.rules import FORAGING

    named = [each for each in found if each.scenario]
    if scenario is None and not named:
        return Words("paper", FORAGING)  # without loading the simulator
    from geswarm.sim import ScenarioError, load_scenario, vocabulary_of

    try:
        if scenario is not None:
            loaded = load_scenario(scenario)
            return Words(scenario, vocabulary_of(loaded), loaded)
        for each in named:
            if (own := _own(each)) is not None:
                return Words(each.scenario, vocabulary_of(own), own)
    except ScenarioError as error:
        raise UsageError(str(error)) from error
    return Words("paper", FORAGING)


def _own(found: RuleSetText) -> Scenario | None:
    """The scenario that a rule set names, if there is one of that name.

    Raises:
        ScenarioError: It is wrong.
    """
    from geswarm.sim import load_scenario, scenario_names

    name, beside = found.scenario, Path(found.source).parent
    if name in scenario_names():
        return load_scenario(name)
    for path in (beside / name, beside / f"{name}.yaml"):
        if Path(name).name == name and path.is_file():
            return load_scenario(path)
    return _of_the_run(beside, name)


def _of_the_run(directory: Path, name: str) -> Scenario | None:
    """The scenario of the run in a directory, if it has that name."""
    from geswarm.evolution import RunConfig, RunConfigError

    with suppress(OSError, UnicodeDecodeError, RunConfigError):
        text = (directory / "config.yaml").read_text(encoding="utf-8")
        scenario = RunConfig.from_yaml(text).scenario
        return scenario if scenario.name == name else None
    return None
