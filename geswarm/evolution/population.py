"""A population as people look at it: who is how good, how big, and who behaves like whom."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from geswarm.evolution.composition import Composition
from geswarm.ge import Individual
from geswarm.rules import RuleSet


@dataclass(frozen=True)
class Member:
    """An individual of the population as people look at it.

    Attributes:
        generation: For which it was bred.
        key: Its number among those.
        fitness: What is known of it.
        told: How often it was evaluated.
        codons: Its size.
        rule_set: Its rules; None if it is invalid.
        behaviour: Equal texts: robots decide the same, in whatever generation; None if it is
            invalid.
    """

    generation: int
    key: int
    fitness: float
    told: int
    codons: int
    rule_set: RuleSet | None
    behaviour: str | None


@dataclass(frozen=True)
class Population:
    """The population after a generation.

    Attributes:
        members: The individuals, best first, as the evolution itself ranks them.
        behaviours: How many different ones there are.
        diversity: Effective number of behaviours, exp of Shannon's entropy: equal to `behaviours`
            if all are equally frequent, 1 if there is one.
    """

    members: tuple[Member, ...]
    behaviours: int
    diversity: float

    @classmethod
    def of(cls, individuals: Sequence[Individual], composition: Composition) -> Population:
        """Look at the individuals of an engine, in its order."""
        members = []
        for one in individuals:
            rule_set = behaviour = None
            if one.phenotype is not None:
                rule_set = composition.rule_set(one.phenotype)
                behaviour = _digest(composition.behaviour(one.phenotype))
            members.append(Member(*one.birth, one.value, one.told, one.used, rule_set, behaviour))
        numbers = Counter(one.behaviour for one in members if one.behaviour is not None)
        shares = [number / sum(numbers.values()) for number in numbers.values()]
        entropy = -math.fsum(share * math.log(share) for share in shares)
        return cls(tuple(members), len(numbers), math.exp(entropy) if shares else 0.0)


def _digest(behaviour: bytes) -> str:
    """A name of a behaviour: 128 bits, so that no two have the same."""
    return hashlib.blake2b(behaviour, digest_size=16).hexdigest()
