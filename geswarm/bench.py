"""`geswarm bench`: how fast it is on this machine, with the interactive world as the yardstick."""

from __future__ import annotations

import json
import math
import platform
import random
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numba
import numpy as np

from geswarm.evolution import EvolutionRun, RunConfig, rule_grammar
from geswarm.ge import Settings
from geswarm.ge.mapping import CODON_LIMIT, Mapper
from geswarm.rules import load_preset, parse_text
from geswarm.sim import (
    CONTROL_STEP,
    Scenario,
    World,
    available_cores,
    evaluate,
    load_scenario,
    vocabulary_of,
)
from geswarm.sim.batch import Group
from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.kernels.state import LANES
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.startup import warm_up

Report: TypeAlias = Callable[[str], None]

_PRESETS = ("hand-coded", "evo8")
_REPEATS = 5
_SWARMS = (1_000, 10_000, 100_000)
_GENERATIONS = 12
_EPUCK_RULES = ("rule while STOP do p = 1, EXPLORATION(5)", "epuck-aac")
"""Robots on their own, and in the end in a crowd, which costs most."""


def run_bench(progress: Report | None = None) -> dict[str, Any]:
    """Measure; takes about a minute. Other work on the machine makes the figures worse.

    Times per robot and control step are processor time of one thread, the least of several repeats
    of two kernels in turn; runs, generations and threads are measured by the clock.

    Args:
        progress: Called with a line before each part.

    Returns:
        JSON values: `ns_per_robot_step` and `scalar_ns_per_robot_step` (simulations side by side;
        one simulation that interprets the rules; scenario `paper`, nanoseconds),
        `speedup_vs_scalar`, `thread_scaling` (two threads to one, None on one core),
        `runs_per_second` (of the paper's 5000 s, all cores), `generation_seconds` (of the paper's
        evolution), `swarm` (by size at the paper's density, one thread), `epucks` (milliseconds
        per run of 20 in `epuck-aac` by rules, one thread), and `mapping_genomes_per_second`
        (genomes of 200 codons, one thread).
    """
    report = progress or (lambda _: None)
    warm_up(report, interactive=True)
    report("control steps, side by side and in the interactive world")
    side_by_side, scalar = _robot_steps()
    report("runs of the paper, on one core and on all")
    runs, scaling = _runs()
    report("generations of the paper's evolution")
    generation = _generation()
    report("large swarms")
    swarms = [_swarm(robots) for robots in _SWARMS]
    warm_up(report, load_scenario("epuck-aac"))
    report("e-pucks with all their noise")
    epucks = [_epucks(rules) for rules in _EPUCK_RULES]
    report("mapping genomes")
    return {
        "ns_per_robot_step": side_by_side,
        "scalar_ns_per_robot_step": scalar,
        "speedup_vs_scalar": scalar / side_by_side,
        "thread_scaling": scaling,
        "runs_per_second": runs,
        "generation_seconds": generation,
        "swarm": swarms,
        "epucks": epucks,
        "mapping_genomes_per_second": _mapping(),
        "cpu": processor(),
        "numba": numba.__version__,
    }


def format_bench(figures: dict[str, Any]) -> str:
    """The figures of `run_bench` as text."""
    scaling = figures["thread_scaling"]
    threads = "-" if scaling is None else f"{scaling:.2f} x"
    lines = [
        ("per robot and control step, simulations side by side", _ns(figures, "")),
        ("per robot and control step, the interactive world of 4 robots", _ns(figures, "scalar_")),
        ("side by side is faster by", f"{figures['speedup_vs_scalar']:.1f} x"),
        ("two threads to one", threads),
        ("runs of 5000 s with 4 robots", f"{figures['runs_per_second']:.0f} per second"),
        ("a generation of the paper", f"{figures['generation_seconds']:.2f} s"),
        (
            "the paper's 1000 generations, from that",
            f"{figures['generation_seconds'] * 1000 / 60:.1f} minutes",
        ),
        *(
            (
                f"swarm of {swarm['robots']:,}",
                f"{swarm['ns_per_robot_step']:.0f} ns per robot and step, "
                f"{swarm['real_time_factor']:.0f} x real time",
            )
            for swarm in figures["swarm"]
        ),
        *(
            (f"run of 20 e-pucks, {each['rules']}", f"{each['ms_per_run']:.1f} ms")
            for each in figures["epucks"]
        ),
        ("mapping", f"{figures['mapping_genomes_per_second']:,.0f} genomes per second"),
        ("processor", figures["cpu"]),
        ("numba", figures["numba"]),
    ]
    width = max(len(name) for name, _ in lines)
    return "\n".join(f"{name:<{width}}  {value}" for name, value in lines)


def command(as_json: bool, report: Report) -> str:
    """What `geswarm bench` prints."""
    figures = run_bench(report)
    return json.dumps(figures) if as_json else format_bench(figures)


def _ns(figures: dict[str, Any], which: str) -> str:
    return f"{figures[f'{which}ns_per_robot_step']:.1f} ns"


def _seconds(work: Callable[..., object], *arguments: Any) -> float:
    """How long a call takes by the clock."""
    before = time.perf_counter()
    work(*arguments)
    return time.perf_counter() - before


def _cpu_seconds(work: Callable[..., object], *arguments: Any) -> float:
    """How long this thread works in a call."""
    before = time.thread_time()
    work(*arguments)
    return time.thread_time() - before


def _cpu_seconds_of_all(work: Callable[[], object]) -> float:
    """How long this process works in a call, its other threads included."""
    before = time.process_time()
    work()
    return time.process_time() - before


def _robot_steps() -> tuple[float, float]:
    """Nanoseconds per robot and control step: side by side, and interpreting one simulation."""
    scenario = load_scenario("paper")
    rule_sets = [load_preset(name) for name in _PRESETS]
    parts = parts_of(scenario)
    controllers = compile_controllers(rule_sets, fails(scenario, parts), parts)
    simulations = np.array([(lane % len(rule_sets), lane, 0, 0) for lane in range(LANES)])
    group = Group(controllers, scenario, simulations)
    worlds = [World(scenario, rules, seed=1) for rules in rule_sets]
    group_steps, world_steps = 10_000, 20_000
    wide, single = [], []
    for repeat in range(_REPEATS):
        wide.append(_cpu_seconds(group.run, repeat * group_steps, group_steps))
        single.append(sum(_cpu_seconds(world.step, world_steps) for world in worlds))
    robots = scenario.robots
    return (
        1e9 * min(wide) / (group_steps * robots * LANES),
        1e9 * min(single) / (world_steps * robots * len(worlds)),
    )


def _runs() -> tuple[float, float | None]:
    """Runs of the paper per second on all cores; how much faster two threads are than one."""
    scenario = load_scenario("paper")
    tables = [load_preset(name) for name in _PRESETS]
    simulations = [(number % len(tables), number, 0, 0) for number in range(4 * LANES)]

    def run_all(workers: int | None) -> None:
        evaluate(tables, scenario, simulations, workers=workers)

    turns = [[_seconds(run_all, workers) for workers in (1, 2, None)] for _ in range(_REPEATS)]
    one, two, every = (min(column) for column in zip(*turns, strict=True))
    return len(simulations) / every, one / two if available_cores() > 1 else None


def _generation() -> float:
    """Median seconds per generation of the paper's evolution, everything included."""
    settings = Settings(generations=_GENERATIONS)
    config = RunConfig(load_scenario("paper"), settings, seed=1)
    with tempfile.TemporaryDirectory() as folder:
        run = EvolutionRun.create(config, Path(folder) / "run")
        ends = [time.perf_counter()]
        try:
            run.run(on_generation=lambda _: ends.append(time.perf_counter()))
        finally:
            run.close()
    return float(np.median(np.diff(ends)))


def swarm_scenario(robots: int) -> Scenario:
    """The paper's scenario for so many robots: everything as dense, zones in proportion."""
    paper = load_scenario("paper")
    scale = math.sqrt(robots / paper.robots)
    return paper.with_changes(
        name=f"paper, {robots} robots",
        robots=robots,
        objects=round(paper.objects * robots / paper.robots),
        **{name: scale * getattr(paper, name) for name in ("width", "length", "nest", "source")},
    )


def _swarm(robots: int) -> dict[str, Any]:
    """Processor time of a large swarm's control step, in one thread."""
    world = World(swarm_scenario(robots), load_preset("evo8"), seed=1)
    steps = max(5, 1_000_000 // robots)
    world.step(2)
    seconds = min(_cpu_seconds(world.step, steps) for _ in range(_REPEATS))
    return {
        "robots": robots,
        "ns_per_robot_step": 1e9 * seconds / (steps * robots),
        "real_time_factor": CONTROL_STEP * steps / seconds,
    }


def _epucks(rules: str) -> dict[str, Any]:
    """Processor time of a run of 120 s, side by side with others, in one thread."""
    scenario = load_scenario("epuck-aac")
    words = vocabulary_of(scenario)
    rule_set = (parse_text if rules.startswith("rule") else load_preset)(rules, vocabulary=words)
    simulations = [(0, 1, 0, run) for run in range(LANES)]

    def run_all() -> None:
        evaluate([rule_set], scenario, simulations, workers=1)

    run_all()
    seconds = min(_cpu_seconds_of_all(run_all) for _ in range(_REPEATS))
    return {"rules": rules, "ms_per_run": 1e3 * seconds / len(simulations)}


def _mapping() -> float:
    """Genomes of 200 codons mapped per second."""
    mapper = Mapper(rule_grammar())
    numbers = random.Random(1)
    genomes = [tuple(numbers.randrange(CODON_LIMIT) for _ in range(200)) for _ in range(2000)]

    def map_all() -> None:
        for genome in genomes:
            mapper.map(genome)

    return len(genomes) / min(_cpu_seconds(map_all) for _ in range(_REPEATS))


def processor() -> str:
    """The processor's name and the number of cores."""
    name = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                name = line.partition(":")[2].strip()
                break
    except OSError:
        pass  # not Linux
    return f"{name}, {available_cores()} cores"
