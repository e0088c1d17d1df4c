"""The campaigns of a session: the next, the present, and the one looked at."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from geswarm.analysis.reproduction import QUICK, Campaign, CampaignError, Plan
from geswarm.analysis.reproduction.plan import PlanError
from geswarm.analysis.reproduction.progress import works_of
from geswarm.evaluation import evaluate_rule_sets
from geswarm.rules import load_preset
from geswarm.sim import EvaluationStopped, load_scenario

from ..run_directory import RUNS, new_directory
from .background import Lookout, Stop
from .campaign_folder import CampaignFolder, CampaignLook, CampaignSummary
from .campaign_thread import CampaignThread
from .evolution import EvolutionThread

SIZES: dict[str, dict[str, int]] = {"quick": QUICK, "full": asdict(Plan())}
"""What fills the plan of the next campaign, by name."""

_MOST = {"runs": 100, "generations": 100_000, "evaluations": 1000}
_TIMED_RUNS = 128


@dataclass(frozen=True)
class Draft:
    """The next campaign; values are as they were typed, right or wrong.

    Attributes:
        values: Of every attribute of `Plan`.
    """

    values: Mapping[str, Any] = field(default_factory=lambda: {**asdict(Plan()), **QUICK})

    def findings(self) -> dict[str, str]:
        """What is wrong with it, by the name of the value."""
        found = {}
        for name, value in self.values.items():
            try:
                Plan(**{name: value})
            except PlanError as error:
                found[name] = str(error).removeprefix(f"{name}: ")
            else:
                if value > _MOST.get(name, math.inf):
                    found[name] = f"expected at most {_MOST[name]}, got {value}"
        return found

    def plan(self) -> Plan:
        """What is asked for.

        Raises:
            CampaignError: The draft has findings.
        """
        if found := self.findings():
            lines = (f"{name}: {text}" for name, text in found.items())
            raise CampaignError("\n".join(lines))
        return Plan(**self.values)


class Campaigns:
    """What is planned, what runs, what is kept, and what of it is looked at.

    The loop owns it, except for what `refresh` finds out in the background: `kept`, `look`,
    `problem` and `rate` are replaced as a whole.

    Attributes:
        thread: The campaign under way.
        draft: Of the next campaign.
        kept: All that are kept, the newest first.
        look: The campaign looked at; None if there is none.
        problem: Why it cannot be looked at, else empty.
        rate: Simulations times robots per second here; None while it is not measured.
    """

    def __init__(self, evolution: EvolutionThread, folder: Path = RUNS) -> None:
        self.thread = CampaignThread(evolution.workers)
        self.draft = Draft()
        self.kept: tuple[CampaignSummary, ...] = ()
        self.look: CampaignLook | None = None
        self.problem = ""
        self.rate: float | None = None
        self.folder = CampaignFolder(folder)
        self._evolution = evolution
        self._opened: str | None = None
        self._lookout = Lookout("campaigns", self._find_out)

    @property
    def shown(self) -> str | None:
        """Name of the campaign looked at: the one that was opened, else the present or last."""
        directory = self.thread.directory
        return self._opened or (directory.name if directory else None)

    @property
    def seconds(self) -> float | None:
        """About how long the next campaign will take here; None if that cannot be told."""
        if self.rate is None or self.draft.findings():
            return None
        return sum(works_of(self.draft.plan()).values()) / self.rate

    def set_size(self, name: str) -> None:
        """Fill the draft, but for the seed.

        Raises:
            CampaignError: There is no size of that name.
        """
        if name not in SIZES:
            raise CampaignError(f"expected {' or '.join(SIZES)}, got {name!r}")
        values = {**self.draft.values, **SIZES[name], "seed": self.draft.values["seed"]}
        self.draft = Draft(values)

    def set_value(self, name: str, value: Any) -> None:
        """Change a value of the draft; see its `findings`.

        Raises:
            CampaignError: There is no such value.
        """
        if name not in self.draft.values or not isinstance(value, int | float | str):
            raise CampaignError(f"expected a number for {', '.join(self.draft.values)}")
        self.draft = replace(self.draft, values={**self.draft.values, name: value})

    def start(self) -> None:
        """Begin the planned campaign in a new directory.

        Raises:
            CampaignError: The draft has findings, something else is under way, or the directory
                cannot be written.
        """
        plan = self.draft.plan()
        self._require_rest()
        what = f"campaign-{plan.runs}x{plan.generations}-seed{plan.seed}"
        self._launch(Campaign.at(new_directory(what, self.folder.path), **asdict(plan)))

    def resume(self, name: str) -> str:
        """Go on with a campaign; says what there is to know of it, usually nothing.

        Raises:
            CampaignError: There is no such campaign, or something else is under way.
        """
        self._require_rest()
        campaign = Campaign.at(self.folder.directory(name))
        self._launch(campaign)
        return " ".join(campaign.remarks)

    def open(self, name: str) -> None:
        """Look at a campaign.

        Raises:
            CampaignError: There is no such campaign.
        """
        self._opened = self.folder.directory(name).name
        self._lookout.hurry()

    def refresh(self) -> None:
        """Find out in the background how things stand, unless that is being done already."""
        self._lookout.ask()

    def close(self) -> None:
        """Stop the campaign under way and end the threads."""
        self.thread.stop()
        self._lookout.close()

    def _launch(self, campaign: Campaign) -> None:
        self.thread.start(campaign)
        self._opened = None
        self._lookout.hurry()

    def _require_rest(self) -> None:
        if self._evolution.active:
            raise CampaignError("an evolution is under way: stop it first, on the page Evolution")
        if self.thread.active:
            raise CampaignError("a campaign is under way: stop it first")

    def _find_out(self, stop: Stop) -> None:
        self.kept = self.folder.scan()
        look, problem = None, ""
        if (shown := self.shown) is not None:
            try:
                look = self.folder.look(shown)
            except CampaignError as error:
                problem = str(error)
        self.look, self.problem = look, problem
        if self.rate is None and not (self.thread.active or self._evolution.active):
            self.rate = self._measured_rate(stop)

    def _measured_rate(self, stop: Stop) -> float | None:
        scenario, rule_sets = load_scenario("paper"), [load_preset("evo8")]
        workers = self.thread.workers
        began = time.monotonic()
        try:
            evaluate_rule_sets(rule_sets, scenario, _TIMED_RUNS, workers=workers, stop=stop)
        except EvaluationStopped:
            return None
        return _TIMED_RUNS * scenario.robots / (time.monotonic() - began)
