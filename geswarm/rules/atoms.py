"""Statements about what a robot senses that rules tell apart: true, false, or true by chance."""

from __future__ import annotations

from dataclasses import dataclass

from geswarm.rules.model import Precondition
from geswarm.rules.vocabulary import Vocabulary

_OPPOSITE = {"==": "!=", "!=": "==", ">=": "<", "<": ">=", "<=": ">", ">": "<="}


@dataclass(frozen=True)
class Atom:
    """A statement about one reading that is true or false.

    Attributes:
        precondition: What it states: `ON_NEST == true`, `NEIGHBOURS >= 3`.
        opposite: The precondition that denies it.
        reading: What it looks at.
        accepted: Whether it is true for each value of the reading.
    """

    precondition: Precondition
    opposite: Precondition
    reading: str
    accepted: tuple[bool, ...]

    @classmethod
    def of(cls, entry: Precondition, vocabulary: Vocabulary) -> Atom:
        """The statement that a precondition makes or denies."""
        reading = vocabulary.reading_of(entry.percept.name)
        if isinstance(entry.value, bool):
            one, other = (Precondition(entry.percept, value) for value in (True, False))
        else:
            one = entry
            other = Precondition(entry.percept, entry.value, _OPPOSITE[entry.comparison])
            if entry.comparison in ("!=", "<", "<="):
                one, other = other, one
        accepted = (vocabulary.holds(one, value) for value in reading.values)
        return cls(one, other, reading.name, tuple(accepted))

    @property
    def name(self) -> str:
        """`ON_NEST`, `NEIGHBOURS >= 3`."""
        truth = self.precondition.value is True
        return str(self.precondition.percept) if truth else str(self.precondition)

    @property
    def negation(self) -> str:
        """`not ON_NEST`, `NEIGHBOURS < 3`."""
        truth = self.precondition.value is True
        return f"not {self.name}" if truth else str(self.opposite)

    def says(self, true: bool, vocabulary: Vocabulary) -> str:
        """That it is true, or not, as a phrase."""
        percept = vocabulary.percepts[self.precondition.percept.name]
        return percept.says(self.precondition if true else self.opposite)


@dataclass(frozen=True)
class Drawn:
    """A statement about one reading that is true with a probability that depends on it.

    Attributes:
        precondition: What it states: `CROWDED(3, 2.5) == true`.
        opposite: The precondition that denies it.
        reading: What it looks at.
        chances: How probable it is for each value of the reading.
    """

    precondition: Precondition
    opposite: Precondition
    reading: str
    chances: tuple[float, ...]

    @classmethod
    def of(cls, entry: Precondition, vocabulary: Vocabulary) -> Drawn:
        """The statement that a precondition makes or denies."""
        reading = vocabulary.reading_of(entry.percept.name)
        one, other = (Precondition(entry.percept, value) for value in (True, False))
        chances = (vocabulary.chance(one, value) for value in reading.values)
        return cls(one, other, reading.name, tuple(chances))

    def says(self, vocabulary: Vocabulary) -> str:
        """That it is true, as a phrase."""
        return vocabulary.percepts[self.precondition.percept.name].says(self.precondition)
