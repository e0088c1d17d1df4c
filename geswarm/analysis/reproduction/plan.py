"""What a campaign is asked to do; the defaults are the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace

import yaml

from geswarm import __version__
from geswarm.evolution import RunConfig
from geswarm.ge import Settings
from geswarm.rules import plain_yaml
from geswarm.sim import load_scenario

QUICK: dict[str, int] = {"runs": 3, "generations": 50, "evaluations": 20}
"""A small campaign: minutes instead of an hour or two."""


_CAN_GROW = ("runs", "generations")
_LEAST = {"seed": 0, "evaluations": 2}  # the others: 1
_MOST = {"runs": 10_000, "generations": 1_000_000, "evaluations": 1_000_000, "seed": 2**31 - 1}


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
            least, most = _LEAST.get(name, 1), _MOST[name]
            whole = isinstance(value, int) and not isinstance(value, bool)
            if not whole or value < least:
                raise PlanError(f"{name}: expected a whole number >= {least}, got {value!r}")
            if value > most:
                raise PlanError(f"{name}: expected at most {most}, got {value}")

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

    def extended(self, asked: Mapping[str, int]) -> Plan:
        """With the values asked for; what was done for this plan belongs to that one, too.

        Raises:
            PlanError: A value is another one, and not just more runs or generations.
        """
        more = {name: value for name, value in asked.items() if getattr(self, name) != value}
        if any(
            name not in _CAN_GROW or value < getattr(self, name) for name, value in more.items()
        ):
            raise PlanError(f"holds a campaign with {', '.join(self.differences(asked))}")
        return replace(self, **more)

    def to_yaml(self, version: str = __version__) -> str:
        """The text of campaign.yaml, with the version of GESwarm that began it."""
        return yaml.safe_dump({"geswarm": version, **asdict(self)}, sort_keys=False)

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
