"""Parameters of the evolutionary algorithm; the defaults are the paper's (section 3.1.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields


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
        crossover: Probability that a pair of parents is crossed over.
        mutation: Probability, per codon, that it is redrawn.
        elitism: Fraction of the population that survives unchanged.
        max_wraps: Passes over a genome after the first one (GEVA's usual value).
        max_codons: Longest genome; a guard, far beyond what the rules need.

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

    def __post_init__(self) -> None:
        findings = [
            *(self._whole(name, 1) for name in ("generations", "evaluations", "max_codons")),
            self._whole("population", 2),
            self._whole("max_wraps", 0),
            self._fraction("crossover", "a probability in [0, 1]"),
            self._fraction("mutation", "a probability in [0, 1]"),
            self._fraction("elitism", "a fraction of the population in [0, 1)", below=1.0),
        ]
        order = [field.name for field in fields(self)]
        given = [finding for finding in findings if finding]
        if given:
            raise SettingsError(sorted(given, key=lambda text: order.index(text.split(":")[0])))

    @property
    def elites(self) -> int:
        """Individuals that survive: the nearest number, at least one unless elitism is 0."""
        if self.elitism == 0:
            return 0
        return min(max(round(self.elitism * self.population), 1), self.population - 1)

    def _whole(self, name: str, least: int) -> str:
        value = getattr(self, name)
        if isinstance(value, int) and not isinstance(value, bool) and value >= least:
            return ""
        return f"{name}: expected a whole number >= {least}, got {value!r}"

    def _fraction(self, name: str, expected: str, below: float = math.inf) -> str:
        value = getattr(self, name)
        if (
            isinstance(value, int | float)
            and not isinstance(value, bool)
            and 0 <= value <= 1
            and value < below
        ):
            return ""
        return f"{name}: expected {expected}, got {value!r}"
