"""What people tell behaviours in a population by: a number and perhaps a colour."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from geswarm.evolution import Population

MOST_COLOURED = 5
"""Behaviours that have a colour at a time; the others are grey."""


@dataclass(frozen=True)
class Label:
    """What a behaviour is told by for as long as it lives.

    Attributes:
        number: From 1 on, in the order in which they were seen; no other one ever has it.
        colour: Number of its colour; None if it has none.
    """

    number: int
    colour: int | None = None


class Labels:
    """Gives labels to the behaviours of a run, generation after generation.

    A behaviour keeps its label until no individual has it. Colours go to the most common ones as
    they become free.
    """

    def __init__(self) -> None:
        self._living: dict[str, Label] = {}
        self._seen = 0

    def of(self, population: Population) -> Mapping[str, Label]:
        """The labels in a population, by `Member.behaviour`."""
        common = Counter(one.behaviour for one in population.members if one.behaviour is not None)
        living = {}
        for behaviour in common:
            if behaviour not in self._living:
                self._seen += 1
            living[behaviour] = self._living.get(behaviour, Label(self._seen))
        used = {label.colour for label in living.values()}
        free = [colour for colour in range(MOST_COLOURED) if colour not in used]
        waiting = [one for one, _ in common.most_common() if living[one].colour is None]
        for behaviour, colour in zip(waiting, free, strict=False):
            living[behaviour] = replace(living[behaviour], colour=colour)
        self._living = living
        return living
