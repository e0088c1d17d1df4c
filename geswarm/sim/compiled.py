"""The kernels that every scenario shares, compiled on first use and kept on disk.

The cache notices a change of the file that a kernel stands in, not of the files that it calls into:
after an update it would go on running the old model. The kernels therefore get a fingerprint of all
their sources as a constant, which is part of the cache's key.
"""

from __future__ import annotations

import zlib
from pathlib import Path

from geswarm.sim.kernels import start, tabulate


def _fingerprint(*folders: Path) -> int:
    """Checksum of all sources in some folders."""
    checksum = 0
    for folder in folders:
        for source in sorted(folder.glob("*.py")):
            checksum = zlib.crc32(source.read_bytes(), checksum)
    return checksum


_FOLDER = Path(start.__file__).parent
VERSION = _fingerprint(_FOLDER, _FOLDER.parent / "terms", _FOLDER.parent / "assembly")
"""Checksum of the sources from which kernels are assembled and compiled."""

begin = start.build_begin(VERSION)
look_around = start.build_look_around(VERSION)
compile_tables = tabulate.build_compile_tables(VERSION)
