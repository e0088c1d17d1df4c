"""Prints which loops of the built-in kernels LLVM has vectorised; run in a process of its own."""

import sys
import tempfile

import llvmlite.binding as llvm
import numba

llvm.set_option("", "-pass-remarks=loop-vectorize")  # before anything is compiled
numba.config.CACHE_DIR = tempfile.mkdtemp()
plain = numba.njit


def with_lines(*arguments, **options):
    return plain(*arguments, **options, debug=True, _dbg_extend_lifetimes=False)


numba.njit = with_lines

import numpy as np  # noqa: E402

from geswarm.sim import load_scenario  # noqa: E402
from geswarm.sim.assembly import records  # noqa: E402
from geswarm.sim.assembly.kernel import assemble  # noqa: E402
from geswarm.sim.assembly.source import Layout  # noqa: E402
from geswarm.sim.encoding import grid_for  # noqa: E402
from geswarm.sim.terms.foraging import FORAGING  # noqa: E402

layout = Layout() if sys.argv[1] == "lanes" else Layout(swarm=True, rules=True)
kernel = assemble(FORAGING, layout)
whole = np.zeros(1, dtype=np.uint32)
common = (
    np.zeros(len(kernel.numbers), dtype=np.float32),
    np.zeros(1, dtype=records.robot_type(FORAGING, layout)),
    np.zeros((1, 2), dtype=np.float32) if layout.swarm else np.zeros(1, dtype=records.OBJECT),
    np.zeros(1, dtype=records.work_type(FORAGING, layout))[0],
)
if layout.swarm:
    rules = (np.zeros(0, dtype=records.RULE), np.zeros((0, 3), dtype=np.uint64))
    actions = (np.zeros(0, dtype=records.ACTION), np.zeros(1, dtype=records.CHANCE))
    grid = grid_for(load_scenario("paper"))
    kernel.run(*common, *rules, *actions, np.zeros(0, dtype=np.int64), grid, 0, 0)
else:
    group = np.zeros(1, dtype=records.GROUP)[0]
    kernel.run(*common, group, whole.astype(np.uint16), whole, whole, whole, 64, 0, 0)
print("file", kernel.run.py_func.__code__.co_filename)
