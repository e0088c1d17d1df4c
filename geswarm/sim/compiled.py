"""The kernels, compiled on first use and kept on disk.

The cache notices a change of the file that a kernel stands in, not of the files that it calls into:
after an update it would go on running the old model. The kernels therefore get a fingerprint of all
their sources as a constant, which is part of the cache's key.
"""

from __future__ import annotations

import zlib
from pathlib import Path

from geswarm.sim.kernels import lanes, run, table


def _fingerprint(folder: Path) -> int:
    """Checksum of all kernel sources."""
    checksum = 0
    for source in sorted(folder.glob("*.py")):
        checksum = zlib.crc32(source.read_bytes(), checksum)
    return checksum


VERSION = _fingerprint(Path(run.__file__).parent)
"""Checksum of the sources from which the kernels are compiled."""

start_world = run.build_start(VERSION)
run_world = run.build_run_world(VERSION)
run_simulation = run.build_run_simulation(VERSION)
start_lanes = lanes.build_start_lanes(VERSION)
run_lanes = lanes.build_run_lanes(VERSION)
fill_slots = table.build_fill_slots(VERSION)
