"""Where runs are kept unless the user says otherwise."""

from __future__ import annotations

from datetime import datetime
from itertools import count
from pathlib import Path

from geswarm.cli.output import shortened
from geswarm.evolution import RunConfig

RUNS = Path("runs")


def new_run_directory(config: RunConfig, parent: Path = RUNS) -> Path:
    """A name for a run that is not taken: scenario, seed and time; the directory is not made."""
    return new_directory(f"{shortened(config.scenario.name)}-seed{config.seed}", parent)


def new_directory(what: str, parent: Path = RUNS) -> Path:
    """A name that is not taken: what it is, and the time of day; the directory is not made."""
    now = datetime.now().strftime("%Y-%m-%d-%H%M%S")
    stem = f"{what}-{now}"
    names = (stem if number == 1 else f"{stem}-{number}" for number in count(1))
    return next(parent / name for name in names if not (parent / name).exists())
