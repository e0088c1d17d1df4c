"""The next evolutionary run as it is being planned: its parameters, and what it begins with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from geswarm.evolution import Composition, InjectionError, RunConfig, preset_for
from geswarm.ge import PRESETS, Settings, SettingsError
from geswarm.rules import Rule, RuleSet
from geswarm.sim import Scenario

from .document import bare_rules

LARGEST_SEED = 2**53
"""Browsers write whole numbers up to this exactly."""
_LONGEST_VALUE = 40
_SIZES = ("generations", "population", "evaluations")


class RunPlanError(ValueError):
    """What was asked of a plan, or the plan itself, cannot be; says why."""


@dataclass(frozen=True)
class RunPlan:
    """What the next run will be; values are as they were typed, right or wrong.

    Attributes:
        preset: Whose values the others were filled with.
        values: Of every field of `Settings`.
        seed: Of the run.
        frozen: Rules of the table, without comments, that evolution must not change.
        from_table: The rules of the table enter the first generation.
    """

    preset: str = "paper"
    values: Mapping[str, Any] = field(default_factory=lambda: asdict(Settings()))
    seed: Any = 0
    frozen: frozenset[Rule] = frozenset()
    from_table: bool = False

    @classmethod
    def of(cls, scenario: Scenario) -> RunPlan:
        """The plan of somebody who has said nothing yet."""
        return cls(values=asdict(preset_for(scenario)))

    def with_preset(self, name: str, scenario: Scenario) -> RunPlan:
        """With all values of a preset, as they suit a scenario.

        Raises:
            RunPlanError: There is none of that name.
        """
        try:
            return replace(self, preset=name, values=asdict(preset_for(scenario, name)))
        except SettingsError as error:
            raise RunPlanError(str(error)) from error

    def with_value(self, name: str, value: Any) -> RunPlan:
        """With another value of a setting, of the `seed` or of `from_table`; see `findings`.

        Raises:
            RunPlanError: There is no such setting, or it is no value at all.
        """
        if not isinstance(value, int | float | str) or len(str(value)) > _LONGEST_VALUE:
            raise RunPlanError(f"{name}: expected a number, a word, true or false")
        if name == "seed":
            return replace(self, seed=value)
        if name == "from_table":
            return replace(self, from_table=value is True)
        if name not in self.values:
            raise RunPlanError(f"{name}: expected a setting, the seed or from_table")
        return replace(self, values={**self.values, name: value})

    def freezing(self, rule: Rule, wanted: bool) -> RunPlan:
        """With a rule frozen, or no longer."""
        (bare,) = bare_rules(RuleSet((rule,)))
        return replace(self, frozen=self.frozen | {bare} if wanted else self.frozen - {bare})

    def following(self, before: RuleSet, after: RuleSet) -> RunPlan:
        """With the same rules frozen after the table was edited."""
        old, new = bare_rules(before), bare_rules(after)
        kept = self.frozen & set(new)
        if len(old) == len(new):
            kept |= {now for was, now in zip(old, new, strict=True) if was in self.frozen - kept}
        return self if kept == self.frozen else replace(self, frozen=kept)

    def changed(self, scenario: Scenario) -> list[str]:
        """The settings in which it differs from its preset."""
        preset = asdict(preset_for(scenario, self.preset))
        return [name for name, value in self.values.items() if value != preset[name]]

    def findings(self, scenario: Scenario, rule_set: RuleSet) -> dict[str, str]:
        """What is wrong with it, by the name of the setting; `rule_set` is that of the table."""
        found: dict[str, str] = {}
        try:
            Settings(**self.values)
        except SettingsError as error:
            found |= dict(finding.split(": ", 1) for finding in error.findings)
        if type(self.seed) is not int or not 0 <= self.seed <= LARGEST_SEED:
            found["seed"] = f"expected a whole number from 0 to {LARGEST_SEED}, got {self.seed!r}"
        if self.from_table:
            try:
                self.first(scenario, rule_set)
            except InjectionError as error:
                found["from_table"] = str(error)
        return found

    def frozen_rules(self, rule_set: RuleSet) -> tuple[Rule, ...]:
        """The rules of the table that are frozen, in their order; not those switched off."""
        pairs = zip(rule_set.rules, bare_rules(rule_set), strict=True)
        return tuple(rule for rule, bare in pairs if rule.enabled and bare in self.frozen)

    def first(self, scenario: Scenario, rule_set: RuleSet) -> RuleSet | None:
        """What enters the first generation: the rules of the table, the frozen ones in front.

        Raises:
            InjectionError: It cannot enter.
        """
        if not self.from_table:
            return None
        frozen = self.frozen_rules(rule_set)
        others = [rule for rule in rule_set.active_rules if rule not in frozen]
        first = RuleSet((*frozen, *others))
        Composition.of(scenario, frozen).phenotype(first)  # raises if it cannot
        return first

    def config(self, scenario: Scenario, rule_set: RuleSet) -> RunConfig:
        """The configuration of the run.

        Raises:
            RunPlanError: With all findings.
        """
        if found := self.findings(scenario, rule_set):
            raise RunPlanError("\n".join(f"{name}: {text}" for name, text in found.items()))
        settings = Settings(**self.values)
        return RunConfig(scenario, settings, self.seed, self.frozen_rules(rule_set))


def idle_settings(settings: Mapping[str, Any]) -> list[str]:
    """The settings that have no effect beside the others, for example `tournament` of a wheel."""
    selection = settings["selection"]
    uses = {"scaling": "roulette", "tournament": "tournament"}
    return [name for name, needed in uses.items() if selection != needed]


def preset_of(settings: Settings) -> tuple[str, list[str]]:
    """The preset that settings are closest to, and where they differ; sizes do not count."""
    values = asdict(settings)
    differences = {
        preset: [
            name
            for name, value in asdict(Settings.preset(preset)).items()
            if name not in _SIZES and values[name] != value
        ]
        for preset in PRESETS
    }
    return min(differences.items(), key=lambda item: len(item[1]))
