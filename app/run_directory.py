"""Where runs are kept unless the user says otherwise."""

from __future__ import annotations

from datetime import datetime
from itertools import count
from pathlib import Path

from geswarm.experiment import RunConfig

RUNS = Path("runs")


def new_run_directory(config: RunConfig, parent: Path = RUNS) -> Path:
    """A name that is not taken: scenario, seed and time of day; the directory is not made."""
    now = datetime.now().strftime("%Y-%m-%d-%H%M%S")
    stem = f"{config.scenario.name}-seed{config.seed}-{now}"
    names = (stem if number == 1 else f"{stem}-{number}" for number in count(1))
    return next(parent / name for name in names if not (parent / name).exists())
