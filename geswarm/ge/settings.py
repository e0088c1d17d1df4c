"""Parameters of the evolutionary algorithm; the defaults are the paper's (section 3.1.2)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from difflib import get_close_matches
from typing import Any

PRESETS: dict[str, dict[str, Any]] = {
    "paper": {},
    "modern": {
        "population": 200,
        "evaluations": 1,
        "initialisation": "grow",
        "selection": "tournament",
        "tournament": 6,
        "variation": "derivation",
        "crossover": 0.5,
        "mutation": 0.5,
        "elitism": 0.5,
        "share_evaluations": True,
        "reevaluate_elites": True,
        "parsimony": True,
    },
}
"""What the presets change of the defaults, by name."""

STEERABLE = ("crossover", "mutation", "scaling", "tournament")
"""What may change between generations."""

CHOICES = {
    "initialisation": ("random", "grow"),
    "selection": ("roulette", "tournament"),
    "variation": ("codons", "derivation"),
}
"""The settings that are names, and which names they can be."""
_SWITCHES = ("common_random_numbers", "share_evaluations", "reevaluate_elites", "parsimony")


MOST = 1_000_000
"""Of everything that is counted: more could not be held in memory."""


class SettingsError(ValueError):
    """Settings cannot be used; `findings` lists every reason."""

    def __init__(self, findings: list[str]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(findings))


@dataclass(frozen=True)
class Settings:
    """What an evolutionary run does; checked when it is made.

    Attributes:
        population: Individuals per generation.
        generations: Generations to evaluate, the initial one included.
        evaluations: Simulations per individual; the objective averages over them.
        crossover: Probability that two parents are crossed over.
        mutation: Probability, per codon, that it is redrawn; on the derivation tree, that there is
            a local change, and then that there is another one.
        elitism: Fraction of the population that survives unchanged, or is evaluated again.
        max_wraps: Passes over a genome after the first one (GEVA's usual value).
        max_codons: Longest genome; a guard, far beyond what the rules need.
        initialisation: `random` derivations (paper, section 2.2), or `grow`: position-independent
            grow to depths that differ, without duplicates (Fagan et al. 2016).
        selection: `roulette` wheel, or `tournament`.
        scaling: Roulette-wheel shares are fitness to this power; 1 is proportional.
        tournament: Contenders per tournament, drawn with replacement.
        variation: Operators on `codons`, as GEVA's, or on the `derivation` tree.
        common_random_numbers: All individuals of a generation are evaluated with the same random
            numbers.
        share_evaluations: Individuals that behave the same are one for the evaluation.
        reevaluate_elites: Elites are evaluated again in each generation, and the whole population
            competes with the offspring by the mean of all evaluations less its standard error, so
            that luck does not survive (Rakshit et al. 2017).
        parsimony: Every codon costs a little in the ranking (Luke and Panait 2002).

    Raises:
        SettingsError: Values that cannot be used: every field, what was expected and given.
    """

    population: int = 100
    generations: int = 1000
    evaluations: int = 3
    crossover: float = 0.3
    mutation: float = 0.05
    elitism: float = 0.05
    max_wraps: int = 3
    max_codons: int = 1000
    initialisation: str = "random"
    selection: str = "roulette"
    scaling: float = 1.0
    tournament: int = 3
    variation: str = "codons"
    common_random_numbers: bool = False
    share_evaluations: bool = False
    reevaluate_elites: bool = False
    parsimony: bool = False

    def __post_init__(self) -> None:
        findings = [
            *(self._whole(name, 1) for name in ("generations", "evaluations", "max_codons")),
            self._whole("population", 2),
            self._whole("max_wraps", 0),
            self._whole("tournament", 1),
            self._number("crossover", "a probability in [0, 1]"),
            self._number("mutation", "a probability in [0, 1]"),
            self._number("elitism", "a fraction of the population in [0, 1)", below=1.0),
            self._number("scaling", "a power in [0, 100]", most=100.0),
            *(self._one_of(name, allowed) for name, allowed in CHOICES.items()),
            *(self._one_of(name, (True, False)) for name in _SWITCHES),
        ]
        order = [field.name for field in fields(self)]
        given = [finding for finding in findings if finding]
        if not given and self.population * self.evaluations > MOST:
            given = [f"evaluations: expected at most {MOST} in all individuals of a generation"]
        if given:
            raise SettingsError(sorted(given, key=lambda text: order.index(text.split(":")[0])))

    @classmethod
    def preset(cls, name: str, **changes: Any) -> Settings:
        """The settings of a preset, with changes.

        Raises:
            SettingsError: There is no such preset, no such setting, or a value cannot be used.
        """
        if name not in PRESETS:
            raise SettingsError([f"preset: expected {_either(PRESETS)}, got {name!r}"])
        return cls.of(**{**PRESETS[name], **changes})

    @classmethod
    def of(cls, **values: Any) -> Settings:
        """The settings with these values, the others as the paper's.

        Raises:
            SettingsError: There is no such setting, or a value cannot be used.
        """
        names = [field.name for field in fields(cls)]
        if unknown := [name for name in values if name not in names]:
            raise SettingsError([_unknown(name, names) for name in unknown])
        return cls(**values)

    def steered(self, **changes: Any) -> Settings:
        """These settings with changes that are allowed between generations: `STEERABLE`.

        Raises:
            SettingsError: Something else is to be changed, or a value cannot be used.
        """
        if wrong := [name for name in changes if name not in STEERABLE]:
            raise SettingsError([f"{name}: expected {_either(STEERABLE)}" for name in wrong])
        return replace(self, **changes)

    @property
    def steerable(self) -> dict[str, float]:
        """The present values of what may change between generations."""
        return {name: getattr(self, name) for name in STEERABLE}

    @property
    def elites(self) -> int:
        """Individuals that survive: the nearest number, at least one unless elitism is 0."""
        if self.elitism == 0:
            return 0
        return min(max(round(self.elitism * self.population), 1), self.population - 1)

    def _whole(self, name: str, least: int) -> str:
        value = getattr(self, name)
        if not isinstance(value, int) or isinstance(value, bool) or value < least:
            return f"{name}: expected a whole number >= {least}, got {value!r}"
        return f"{name}: expected at most {MOST}, got {value}" if value > MOST else ""

    def _number(self, name: str, expected: str, most: float = 1.0, below: float = math.inf) -> str:
        value = getattr(self, name)
        if (
            isinstance(value, int | float)
            and not isinstance(value, bool)
            and 0 <= value <= most
            and value < below
        ):
            return ""
        return f"{name}: expected {expected}, got {value!r}"

    def _one_of(self, name: str, allowed: tuple[Any, ...]) -> str:
        value = getattr(self, name)
        if any(value is one or (isinstance(value, str) and value == one) for one in allowed):
            return ""
        return f"{name}: expected {_either(allowed)}, got {value!r}"


def _unknown(name: str, names: Sequence[str]) -> str:
    near = get_close_matches(name, names, 1)
    hint = f"did you mean {near[0]!r}?" if near else f"expected {_either(names)}"
    return f"unknown setting {name!r}; {hint}"


def _either(names: Any) -> str:
    return " or ".join(str(name) for name in names)
