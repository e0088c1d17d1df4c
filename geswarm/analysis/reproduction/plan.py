"""What a campaign is asked to do; the defaults are the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields

import yaml

from geswarm import __version__
from geswarm.evolution import RunConfig
from geswarm.ge import Settings
from geswarm.rules import plain_yaml
from geswarm.sim import load_scenario

QUICK: dict[str, int] = {"runs": 3, "generations": 50, "evaluations": 20}
"""A small campaign: minutes instead of an hour or two."""


class PlanError(ValueError):
    """A plan cannot be used; says what was expected."""


@dataclass(frozen=True)
class Plan:
    """How much is done.

    Attributes:
        runs: Evolutionary runs.
        generations: Of each run.
        evaluations: Simulations of each rule set in each setting.
        seed: Of the first evolutionary run, the others count on from it; and of all evaluations.

    Raises:
        PlanError: A value cannot be used.
    """

    runs: int = 10
    generations: int = 1000
    evaluations: int = 50
    seed: int = 1

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            least = {"seed": 0, "evaluations": 2}.get(name, 1)
            whole = isinstance(value, int) and not isinstance(value, bool)
            if not whole or not least <= value < 2**31:
                raise PlanError(f"{name}: expected a whole number >= {least}, got {value!r}")

    @property
    def seeds(self) -> range:
        """Of the evolutionary runs."""
        return range(self.seed, self.seed + self.runs)

    @property
    def is_whole(self) -> bool:
        """There are at least as many runs and generations as in the paper."""
        return self.runs >= Plan.runs and self.generations >= Plan.generations

    def run_config(self, seed: int) -> RunConfig:
        """The evolutionary run with a seed."""
        settings = Settings.preset("paper", generations=self.generations)
        return RunConfig(load_scenario("paper"), settings, seed)

    def differences(self, asked: Mapping[str, int]) -> list[str]:
        """What of the values asked for is not as here."""
        return [
            f"{name} {getattr(self, name)} and not {value}"
            for name, value in asked.items()
            if getattr(self, name) != value
        ]

    def to_yaml(self) -> str:
        """The text of campaign.yaml."""
        return yaml.safe_dump({"geswarm": __version__, **asdict(self)}, sort_keys=False)

    @classmethod
    def from_yaml(cls, text: str) -> Plan:
        """Read what `to_yaml` wrote.

        Raises:
            PlanError: It is something else.
        """
        try:
            document = plain_yaml.load(text)
        except plain_yaml.YamlError as error:
            raise PlanError(str(error)) from error
        names = ["geswarm", *(field.name for field in fields(cls))]
        if not isinstance(document, dict) or sorted(map(str, document)) != sorted(names):
            found = ", ".join(map(str, document)) if isinstance(document, dict) else "no keys"
            raise PlanError(f"expected the keys {', '.join(names)}, got {found}")
        return cls(**{name: document[name] for name in names[1:]})


def version_of(text: str) -> str:
    """The GESwarm that wrote a text which `Plan.from_yaml` reads."""
    return str(plain_yaml.load(text)["geswarm"])
