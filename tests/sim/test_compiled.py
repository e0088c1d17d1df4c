import ast
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from geswarm.sim import compiled
from geswarm.sim.kernels import start
from geswarm.sim.kernels.jit import called, inlined, kernel_in_memory

FOLDER = Path(start.__file__).parent


def test_a_change_of_any_kernel_source_is_a_new_version(tmp_path):
    versions = {compiled._fingerprint(FOLDER)}
    for changed in FOLDER.glob("*.py"):
        for source in FOLDER.glob("*.py"):
            text = source.read_text() + ("\n" if source == changed else "")
            (tmp_path / source.name).write_text(text)
        versions.add(compiled._fingerprint(tmp_path))
    assert len(versions) == 1 + len(list(FOLDER.glob("*.py")))


def test_kernels_import_numba_numpy_and_the_standard_library_alone():
    allowed = {*sys.stdlib_module_names, "numpy", "numba", "geswarm.drafts", "geswarm.sim.kernels"}
    allowed |= {"numba.core", "numba.extending", "numba.misc.appdirs", "collections.abc"}
    for source in FOLDER.glob("*.py"):
        for node in ast.walk(ast.parse(source.read_text())):
            if isinstance(node, ast.Import):
                assert {name.name for name in node.names} <= allowed
            elif isinstance(node, ast.ImportFrom):
                assert node.module in allowed or node.module.startswith("geswarm.sim.kernels.")


@pytest.mark.parametrize("kind", [called, inlined], ids=["called", "inlined"])
def test_records_that_begin_alike_are_told_apart_without_a_warning(kind):
    @kind
    def sum_of(robot):
        return robot.x + robot.y

    @kernel_in_memory
    def run(robots):
        return sum_of(robots[0])

    few = np.ones(1, dtype=[("x", np.float32), ("y", np.float32)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for more in range(3):
            fields = [*few.dtype.descr, *((f"more{k}", np.float32) for k in range(more))]
            robots = np.ones(1, dtype=fields)
            assert run(robots) == 2.0
