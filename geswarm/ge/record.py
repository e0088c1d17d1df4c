"""What is written down of a generation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, fields


@dataclass(frozen=True)
class GenerationRecord:
    """One generation in numbers; a line of `history.csv`.

    Attributes:
        generation: Its number; the initial generation is 1.
        best_so_far: Fitness of the best individual so far. If elites keep the fitness of their
            time, it is the highest since the beginning; if they are evaluated again, it is the mean
            of all evaluations of the best, which can also fall.
        best: Highest fitness among the individuals bred for this generation, elites not included.
        mean: Mean fitness of the same individuals; invalid ones count, see `Engine.tell`.
        invalid: How many of them are invalid: their mapping did not finish.
        distinct: Different phenotypes among them.
        seconds: Wall-clock time; the only field in which two equal runs differ.
    """

    generation: int
    best_so_far: float
    best: float
    mean: float
    invalid: int
    distinct: int
    seconds: float

    @classmethod
    def csv_header(cls) -> str:
        """The field names, without the end of the line."""
        return ",".join(field.name for field in fields(cls))

    def csv_row(self) -> str:
        """The values in ten digits, seconds in milliseconds, without the end of the line."""
        *numbers, seconds = astuple(self)
        return ",".join([*(format(number, ".10g") for number in numbers), f"{seconds:.3f}"])


def fall_in_words(
    best_so_far: Sequence[float], shown: Callable[[float], str] = "{:.1f}".format
) -> str:
    """A word wherever the best so far is less than it was: the best was evaluated again.

    Args:
        best_so_far: Of every generation so far, one at least.
        shown: How a fitness is written.

    Returns:
        For example `re-evaluated: 131.2 → 129.8`; empty if it has never been more than it is.
    """
    highest, last = map(shown, (max(best_so_far), best_so_far[-1]))
    return "" if highest == last else f"re-evaluated: {highest} → {last}"
