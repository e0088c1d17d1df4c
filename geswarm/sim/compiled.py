"""The kernels, compiled on first use and cached on disk.

Numba's cache notices a change of the file that a kernel stands in, not of the files that it calls
into: after an update it would go on running the old model. The kernels therefore get a fingerprint
of all their sources as a constant, which is part of the cache's key.
"""

from __future__ import annotations

import zlib
from pathlib import Path

from geswarm.sim.kernels import run


def _fingerprint(folder: Path) -> int:
    """Checksum of all kernel sources."""
    checksum = 0
    for source in sorted(folder.glob("*.py")):
        checksum = zlib.crc32(source.read_bytes(), checksum)
    return checksum


_VERSION = _fingerprint(Path(run.__file__).parent)

start_world = run.build_start(_VERSION)
run_world = run.build_run_world(_VERSION)
run_simulations = run.build_run_simulations(_VERSION)
