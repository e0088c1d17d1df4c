"""How probable a transition is where its condition holds, if that depends on statements by chance.

>>> str(Rate(0.5, 0.5))
'p = 0.5'
>>> str(Rate(0.01, 0.4, factor=0.5, of="CROWDED(3, 2.5)"))
'p = 0.5 times the chance of CROWDED(3, 2.5)'
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from geswarm.rules.reachability import TOLERANCE
from geswarm.rules.space import FloatArray, Space

_DIGITS = 12  # probabilities that agree to this many decimals are the same


@dataclass(frozen=True)
class Rate:
    """A probability per control step, or what it lies between.

    Attributes:
        least: The least.
        most: The greatest; the same unless it depends on a statement that is true by chance.
        factor: If it is the chance of one such statement times a number, that number; else 0.
        of: That statement.
    """

    least: float
    most: float
    factor: float = 0.0
    of: str = ""

    @classmethod
    def over(cls, probabilities: Mapping[int, float], space: Space) -> Rate:
        """The probability of something, given for some percepts by their numbers."""
        where = list(probabilities)
        p = np.array([round(each, _DIGITS) for each in probabilities.values()])
        least, most = float(p.min()), float(p.max())
        if least < most:
            for of, chances in _statements(space):
                likeliest = int(chances[where].argmax())
                factor = float(p[likeliest] / chances[where][likeliest])
                if np.abs(p - factor * chances[where]).max() <= 2.0 * TOLERANCE:
                    return cls(least, most, round(factor, _DIGITS - 1), of)
        return cls(least, most)

    @property
    def varies(self) -> bool:
        """Whether it depends on a statement that is true by chance."""
        return self.least < self.most

    def __str__(self) -> str:
        if not self.varies:
            return f"p = {self.most:.6g}"
        if not self.of:
            return f"p = {self.least:.6g} to {self.most:.6g}, by chance"
        times = "" if self.factor == 1.0 else f"{self.factor:.6g} times "
        return f"p = {times}the chance of {self.of}"


def _statements(space: Space) -> Iterator[tuple[str, FloatArray]]:
    """Each statement that is true by chance, and that it is false, with their chances."""
    for drawn in space.drawn:
        name = str(drawn.precondition.percept)
        yield name, space.chance(drawn.precondition)
        yield f"not {name}", space.chance(drawn.opposite)
