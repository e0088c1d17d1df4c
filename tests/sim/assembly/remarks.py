"""Prints which loops of a kernel LLVM has vectorised; run in a process of its own.

Its remarks name a loop by the line where it begins, and not at all where that has been moved out
of the loop; so the lines within loops of vectors are printed, too.

python remarks.py LAYOUT [SCENARIO or ARENA]: of foraging, of a built-in scenario, or of robots in
an arena of a kind of `arenas.KINDS`.
"""

import re
import sys
import tempfile
from pathlib import Path

import llvmlite.binding as llvm
import numba

llvm.set_option("", "-pass-remarks=loop-vectorize")  # before anything is compiled
numba.config.CACHE_DIR = tempfile.mkdtemp()
plain = numba.njit


def with_lines(*arguments, **options):
    return plain(*arguments, **options, debug=True, _dbg_extend_lifetimes=False)


numba.njit = with_lines

import numpy as np  # noqa: E402

from geswarm.sim import load_scenario, scenario_names  # noqa: E402
from geswarm.sim.assembly import records  # noqa: E402
from geswarm.sim.assembly.kernel import assemble  # noqa: E402
from geswarm.sim.assembly.source import Layout  # noqa: E402
from geswarm.sim.controllers.encoding import grid_for  # noqa: E402
from geswarm.sim.library.vocabulary import parts_of  # noqa: E402

PAPER = load_scenario("paper")
PARTS = parts_of(PAPER)
if len(sys.argv) > 2 and sys.argv[2] in scenario_names():
    PARTS = parts_of(load_scenario(sys.argv[2]))
elif len(sys.argv) > 2:
    sys.path.insert(0, str(Path(__file__).parents[3]))
    from hypothesis import Phase, given, settings

    from geswarm.sim.terms.ground import Ground
    from tests.sim.assembly.arenas import KINDS, parts_in

    @settings(max_examples=1, derandomize=True, phases=[Phase.generate], deadline=None)
    @given(KINDS[sys.argv[2]])
    def choose(arena):
        global PARTS
        PARTS = parts_in(Ground.of(arena))

    choose()
layout = Layout() if sys.argv[1] == "lanes" else Layout(swarm=True, rules=True)
kernel = assemble(PARTS, layout)
whole = np.zeros(1, dtype=np.uint32)
instances = (np.zeros(1, dtype=np.int32), np.zeros((1, PARTS.arguments), dtype=np.float32))
instances = instances if PARTS.arguments else ()
common = (
    np.zeros(len(kernel.numbers), dtype=np.float32),
    np.zeros(1, dtype=records.robot_type(PARTS, layout)),
    np.zeros((1, 2), dtype=np.float32) if layout.swarm else np.zeros(1, dtype=records.OBJECT),
)
if layout.swarm:
    rules = (np.zeros(0, dtype=records.RULE), np.zeros((0, len(PARTS.sensors)), dtype=np.uint64))
    actions = (np.zeros(0, dtype=records.ACTION), np.zeros(1, dtype=records.CHANCE))
    grid = grid_for(PAPER)
    kernel.run(*common, *rules, *actions, np.zeros(0, dtype=np.int64), *instances, grid, 0, 0)
else:
    group = np.zeros(1, dtype=records.GROUP)[0]
    kernel.run(*common, group, whole.astype(np.uint16), whole, whole, whole, *instances, 64, 0, 0)
print("file", kernel.run.py_func.__code__.co_filename)
(code,) = kernel.run.inspect_llvm().values()
scope = re.search(r'^(!\d+) = distinct !DISubprogram\(name: "run"', code, re.MULTILINE)[1]
lines = dict(
    re.findall(rf"^(!\d+) = !DILocation\(line: (\d+), .*scope: {scope}\)$", code, re.MULTILINE)
)
loops = re.findall(r"^vector\.body\d*:.*?^$", code, re.MULTILINE | re.DOTALL)
places = {lines.get(place) for loop in loops for place in re.findall(r"!dbg (!\d+)", loop)}
print("lines", *sorted(int(line) for line in places - {None, "0"}))
