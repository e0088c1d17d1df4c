"""Command lines: they run in the current directory, which the tests make."""

import io
import random
import shutil
import sys
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path

from hypothesis import strategies as st

from geswarm.app.main import main as geswarm_ui
from geswarm.cli import main as geswarm
from tests.robustness import mutations
from tests.robustness.doors import Door, RefusedError

QUICK = "duration: 1\n"
VALUES = (
    "evo8", "hand-coded", "-", "mine.rules", "quick.yaml", "paper", "nowhere", "", ".", "..",
    "\udcff", "a\0b", "x" * 300, "0", "1", "2", "-1", "1e3", "nan", "9" * 30, "9" * 5000, "--",
    "--json", "/dev/null/x", "[/x]", "text", "yaml", "json", "dot", "svg", "latex", "argos-lua",
    "automode", "modern",
    "out", "out/mine",
)  # fmt: skip
GESWARM = {
    "evaluate": ("--scenario", "--seed", "--json"),
    "compare": ("--seed", "--html", "--json"),
    "show": ("--as",),
    "check": (),
    "equal": ("--json",),
    "export": ("--to", "-o", "--scenario", "--experiment", "--strict"),
    "import": ("--from", "--as", "-o", "--number"),
    "nonsense": (),
}
GESWARM_UI = ("--scenario", "--preset", "--generations", "--population", "--evaluations", "--seed",
              "--out", "--resume", "--port", "--host", "--rules")  # fmt: skip
_QUICK_OPTIONS = {
    "evaluate": ["--scenario", "quick.yaml", "--runs", "2", "--workers", "1"],
    "compare": ["--scenario", "quick.yaml", "--runs", "2", "--workers", "1"],
}


def command_line(rng):
    """Standard input and arguments, of the right kind and of any other."""
    words = [rng.choice(VALUES) for _ in range(rng.choice((0, 1, 2, 3)))]
    if rng.random() < 0.3:
        options = [
            part
            for _ in range(rng.choice((0, 1, 2)))
            for part in (rng.choice(GESWARM_UI), rng.choice(VALUES))
        ]
        small = ["--no-ui", "--scenario", "quick.yaml", "--population", "2", "--generations", "1"]
        return geswarm_ui, "", [*small, "--out", "out/run", *options, *words[:1]]
    verb = rng.choice(list(GESWARM))
    for option in rng.sample(GESWARM[verb], rng.randint(0, min(2, len(GESWARM[verb])))):
        words += [option, rng.choice(VALUES)]
    typed = mutations.mutated_text(rng, ("rule do p = 1, PHOTOTAXIS", QUICK))
    return geswarm, typed, [verb, *words, *_QUICK_OPTIONS.get(verb, [])]


def run_command(command):
    """The exit status is 0, 1 or 2, with one message and no traceback if it is 2."""
    main, typed, arguments = command
    for path in Path().iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    Path("mine.rules").write_text("rule do p = 1, PHOTOTAXIS")
    Path("quick.yaml").write_text(QUICK)
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", how) for how in ("strict", "replace"))
    before, sys.stdin = sys.stdin, io.StringIO(typed)
    try:
        with redirect_stdout(out), redirect_stderr(err):
            status = main(arguments)
    except SystemExit as error:
        status = error.code
    finally:
        sys.stdin = before
    err.seek(0)
    said = err.read()
    assert status in (0, 1, 2), (status, said)
    assert "Traceback" not in said
    assert status != 2 or said.strip(), "exit 2 without a word"
    if status == 2:
        raise RefusedError(said)


@cache
def doors():
    """Both commands."""
    seeds = st.integers(0, 2**32).map(random.Random)
    return (
        Door("command line", run_command, (RefusedError,), command_line, seeds.map(command_line)),
    )
