"""What is bred, evaluated and selected, and its form in a checkpoint."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from geswarm.ge.mapping import CODON_LIMIT, Genome

Birth: TypeAlias = "tuple[int, int]"
"""(generation, key): names an individual within a run."""

WORST_FITNESS = 0.0


@dataclass(frozen=True)
class Individual:
    """A genome and what it maps to.

    Attributes:
        generation: Generation for which it was bred; the initial one is 1.
        key: Its number among those bred for that generation, from 0.
        genome: Codons.
        phenotype: A sentence of the grammar, or None if the mapping did not finish.
        used: Codons that the mapping read, wrapping included.
        parents: Births of those whose codons it has; empty for the initial and injected ones.
        fitness: Mean of the values told so far; None as long as it is not evaluated.
        told: How many values that are.
    """

    generation: int
    key: int
    genome: Genome
    phenotype: str | None
    used: int
    parents: tuple[Birth, ...] = ()
    fitness: float | None = None
    told: int = 0

    @property
    def birth(self) -> Birth:
        """Its name within the run."""
        return self.generation, self.key

    @property
    def value(self) -> float:
        """Its fitness; the worst as long as there is none."""
        return WORST_FITNESS if self.fitness is None else self.fitness


def to_json(individual: Individual) -> dict[str, Any]:
    """An individual in JSON types."""
    return {
        "generation": individual.generation,
        "key": individual.key,
        "parents": [list(birth) for birth in individual.parents],
        "fitness": individual.fitness,
        "told": individual.told,
        "phenotype": individual.phenotype,
        "used": individual.used,
        "genome": list(individual.genome),
    }


def from_json(data: Mapping[str, Any]) -> Individual:
    """What `to_json` made.

    Raises:
        KeyError, TypeError, ValueError: It is something else.
    """
    genome = tuple(data["genome"])
    if not genome or not all(type(c) is int and 0 <= c < CODON_LIMIT for c in genome):
        raise ValueError(f"genome of individual {data['key']}: codons in [0, {CODON_LIMIT})")
    for name, least in (("generation", 1), ("key", 0), ("used", 0), ("told", 1)):
        if type(data[name]) is not int or not least <= data[name] < CODON_LIMIT:
            raise ValueError(f"{name} of an individual: a whole number from {least} on")
    if not math.isfinite(data["fitness"]):
        raise ValueError(f"fitness of individual {data['key']}: a finite number")
    return Individual(
        generation=data["generation"],
        key=data["key"],
        genome=genome,
        phenotype=None if data["phenotype"] is None else str(data["phenotype"]),
        used=data["used"],
        parents=tuple((int(generation), int(key)) for generation, key in data["parents"]),
        fitness=float(data["fitness"]),
        told=data["told"],
    )
