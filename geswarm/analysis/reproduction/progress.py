"""How much of a campaign's work is done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geswarm.analysis.reproduction import studies
from geswarm.analysis.reproduction.plan import Plan
from geswarm.ge import GenerationRecord

OnProgress: TypeAlias = Callable[[float, str], None]
"""Called with (share of all the work that is done, what is being done)."""


@dataclass(frozen=True)
class Part:
    """A part of a campaign: an evolutionary run, or an experiment.

    Attributes:
        name: Of the rule set that is evolved, or of the experiment.
        done: Generations, or 1 for an experiment that is done.
        total: What `done` ends with.
        work: All of it in simulations times robots, which is what takes time.
    """

    name: str
    done: int
    total: int
    work: int


def works_of(plan: Plan) -> dict[str, int]:
    """The work of each part by its name, in simulations times robots; evolution comes first."""
    config = plan.run_config(plan.seed)
    settings = config.settings
    generation = settings.population * settings.evaluations * config.scenario.robots
    evolved = [studies.evolved_name(seed) for seed in plan.seeds]
    experiments = {"performance": studies.performance(evolved), **studies.others(evolved[0])}
    return {
        **dict.fromkeys(evolved, plan.generations * generation),
        **{
            name: plan.evaluations * sum(case.scenario.robots for case in cases)
            for name, cases in experiments.items()
        },
    }


class Meter:
    """Counts the work, and tells.

    Args:
        parts: Of the campaign as it stands, the evolutionary runs first.
        tell: Hears what is being done; None: nobody.
    """

    def __init__(self, parts: Sequence[Part], tell: OnProgress | None) -> None:
        self._generation = parts[0].work // parts[0].total
        self._tell = tell
        self._total = sum(part.work for part in parts)
        done = sum(part.work * part.done // part.total for part in parts)
        self._reach(done, "reading what is done")

    def evolved(self, seed: int, record: GenerationRecord) -> None:
        """A generation is finished."""
        doing = f"seed {seed}, generation {record.generation}, best {record.best_so_far:.1f}"
        self._reach(self._done + self._generation, doing)

    def simulated(self, name: str) -> Callable[[int, int], None]:
        """An experiment begins; what to call with (work done, work in all)."""
        before = self._done
        return lambda done, _: self._reach(before + done, name)

    def _reach(self, done: int, doing: str) -> None:
        self._done = done
        if self._tell:
            self._tell(min(1.0, done / self._total), doing)
