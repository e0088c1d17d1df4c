"""In whose words rule sets are read: a scenario's vocabulary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from geswarm.cli.arguments import UsageError

if TYPE_CHECKING:
    from geswarm.rules import RuleSet, RuleSetText, Vocabulary

WORDS_HELP = (
    "in whose words the rules are written: a scenario or a YAML file; default: the one that they "
    "name, or paper"
)


@dataclass(frozen=True)
class Words:
    """A vocabulary and the scenario that offers it.

    Attributes:
        scenario: Its name, or the path of its file.
        vocabulary: What rules may mention.
    """

    scenario: str
    vocabulary: Vocabulary

    def read(self, found: RuleSetText) -> RuleSet:
        """A rule set in these words.

        Raises:
            RuleSetError: It mentions something else, or is none.
        """
        return found.read(self.vocabulary, self.scenario)


def words_of(found: Sequence[RuleSetText], scenario: str | None) -> Words:
    """The words of a scenario; of the one that a rule set names if none is given, or paper's.

    A rule set can name a scenario that comes with GESwarm, or a file beside its own.

    Raises:
        UsageError: The scenario cannot be used.
    """
    name = scenario or next(filter(None, map(_named, found)), None)
    if name is None:  # without loading the simulator
        from geswarm.rules import FORAGING

        return Words("paper", FORAGING)
    from geswarm.sim import ScenarioError, load_scenario, vocabulary_of

    try:
        return Words(name, vocabulary_of(load_scenario(name)))
    except ScenarioError as error:
        raise UsageError(str(error)) from error


def _named(found: RuleSetText) -> str | None:
    """The scenario that a rule set names, if it can be found."""
    name = found.scenario
    if not name:
        return None
    from geswarm.sim import scenario_names

    if name in scenario_names():
        return name
    beside = Path(found.source).parent
    files = [beside / name, beside / f"{name}.yaml"] if Path(name).name == name else []
    return next((str(path) for path in files if path.is_file()), None)
