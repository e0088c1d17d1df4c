"""The campaigns that are kept: which there are, and one of them as people look at it."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geswarm.analysis.reproduction import Campaign, CampaignError, Claim, Plan, parse_claims
from geswarm.analysis.reproduction.progress import Part
from geswarm.analysis.reproduction.studies import EVO_8, HAND_CODED, evolved_name
from geswarm.plain_text import decode

MOST_CAMPAIGNS = 200
"""Shown at most, the newest."""

_Stamp = tuple[int, int]


@dataclass(frozen=True)
class CampaignSummary:
    """A line of the list of campaigns.

    Attributes:
        name: Of its directory.
        written: When it was begun or reported, in seconds of the clock (`time.time`).
        plan: What was asked for; None if it cannot be read.
        reported: Its report is there.
        problem: Why it cannot be read, else empty.
    """

    name: str
    written: float
    plan: Plan | None = None
    reported: bool = False
    problem: str = ""


@dataclass(frozen=True)
class CampaignLook:
    """A campaign at one moment.

    Attributes:
        name: Of its directory.
        plan: What was asked for.
        parts: How far each part is.
        curves: Best fitness so far of each evolutionary run, from generation 1 on, by the name of
            the rule set that is evolved.
        levels: What the paper's rule sets collect on average, by name, once it is known.
        claims: Of the paper, held to its data; empty before the report is written.
        reported: Its report is there.
    """

    name: str
    plan: Plan
    parts: tuple[Part, ...]
    curves: dict[str, tuple[float, ...]]
    levels: dict[str, float]
    claims: tuple[Claim, ...]
    reported: bool

    @property
    def share(self) -> float:
        """Of all its work that is done, by the files."""
        done = sum(part.work * part.done / part.total for part in self.parts)
        return min(1.0, done / sum(part.work for part in self.parts))


class CampaignFolder:
    """The campaigns directly below a folder; curves are read again only if they changed.

    Attributes:
        path: The folder; it need not exist.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._curves: dict[Path, tuple[_Stamp, tuple[float, ...]]] = {}

    def scan(self) -> tuple[CampaignSummary, ...]:
        """All campaigns, the newest first."""
        found = [_summary(directory) for directory in self._directories()]
        found.sort(key=lambda summary: (-summary.written, summary.name))
        return tuple(found[:MOST_CAMPAIGNS])

    def directory(self, name: str) -> Path:
        """The directory of a campaign.

        Raises:
            CampaignError: There is no campaign of that name directly below the folder.
        """
        for directory in self._directories():
            if directory.name == name:
                return directory
        raise CampaignError(f"there is no campaign {name!r} in {self.path}")

    def report(self, name: str) -> Path:
        """The report of a campaign.

        Raises:
            CampaignError: There is no such campaign, or it has no report.
        """
        path = self.directory(name) / "report.html"
        if path.is_symlink() or not path.is_file():
            raise CampaignError(f"{name} has no report yet")
        return path

    def look(self, name: str) -> CampaignLook:
        """A campaign as its files say; another process may be at work on it.

        Raises:
            CampaignError: There is no such campaign, or it cannot be read.
        """
        directory = self.directory(name)
        campaign = Campaign.at(directory)
        try:
            curves = {
                evolved_name(seed): self._curve(campaign.place_of(seed) / "history.csv")
                for seed in campaign.plan.seeds
            }
            reported = (directory / "report.html").is_file()
            claims = _claims(directory / "data" / "claims.csv") if reported else []
            levels = _levels(campaign.data_of("performance"))
            parts = tuple(campaign.parts())
        except (OSError, ValueError, KeyError, TypeError, csv.Error) as error:
            raise CampaignError(f"{directory}: cannot be read: {error}") from error
        return CampaignLook(name, campaign.plan, parts, curves, levels, tuple(claims), reported)

    def _curve(self, path: Path) -> tuple[float, ...]:
        if not path.exists():
            return ()
        status = path.stat()
        stamp = (status.st_mtime_ns, status.st_size)
        known, curve = self._curves.get(path, (None, ()))
        if known != stamp:
            curve = tuple(float(row["best_so_far"]) for row in _rows(path))
            if not all(map(math.isfinite, curve)):
                raise ValueError(f"{path.name}: expected finite numbers")
            self._curves[path] = stamp, curve
        return curve

    def _directories(self) -> Iterator[Path]:
        try:
            entries = sorted(self.path.iterdir())
        except OSError:
            return
        for entry in entries:
            if not entry.is_symlink() and (entry / "campaign.yaml").is_file():
                yield entry


def _summary(directory: Path) -> CampaignSummary:
    report = directory / "report.html"
    reported = report.is_file()
    try:
        written = (report if reported else directory / "campaign.yaml").stat().st_mtime
        plan = Campaign.at(directory).plan
    except (CampaignError, OSError) as error:
        return CampaignSummary(directory.name, 0.0, problem=str(error))
    return CampaignSummary(directory.name, written, plan, reported)


def _levels(path: Path) -> dict[str, float]:
    """Mean collected of the paper's rule sets where the others evolved."""
    if not path.exists():
        return {}
    collected: dict[str, list[int]] = {EVO_8: [], HAND_CODED: []}
    for row in _rows(path):
        if row["rules"] in collected:
            collected[row["rules"]].append(int(row["collected"]))
    return {name: float(np.mean(runs)) for name, runs in collected.items() if runs}


def _claims(path: Path) -> list[Claim]:
    return parse_claims(decode(path.read_bytes()))


def _rows(path: Path) -> csv.DictReader[str]:
    return csv.DictReader(io.StringIO(decode(path.read_bytes())))
