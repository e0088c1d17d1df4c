"""Components of a scenario -> source of a kernel -> module; compiled on its first call."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from geswarm.sim.assembly import acting, deciding, inert, measuring, meeting, records
from geswarm.sim.assembly.loading import load
from geswarm.sim.assembly.source import Layout, Source
from geswarm.sim.kernels.single import F, I, U
from geswarm.sim.terms.component import Component
from geswarm.sim.terms.parts import Parts

_IMPORTS = """\
import numpy as np

from geswarm.sim.kernels import geometry
from geswarm.sim.kernels.draws import FIRST_ACTION, OUTCOME, draw_bits
from geswarm.sim.kernels.jit import kernel
from geswarm.sim.kernels.motion import {motion}
from geswarm.sim.kernels.{search}
from geswarm.sim.kernels.scratch import on_the_stack
from geswarm.sim.kernels.single import ONE, TWO, ZERO, F, I, U, fma, inverse_root
from geswarm.sim.kernels.state import LANES
from geswarm.sim.kernels.table import slot_of
"""
_OF_INERT_BODIES = """\
from geswarm.sim.kernels import epuck
from geswarm.sim.kernels.contact import nearer, settle
from geswarm.sim.kernels.draws import E_PUCK, MESSAGE, dice_of, thrown
from geswarm.sim.kernels.single import above_zero
"""
_SEARCH = {
    False: "nearest import FAR, distance2",
    True: "nearest import insert_object, is_near, nearest_object, remove_object, sort_objects\n"
    "from geswarm.sim.kernels.pairs import gather_pairs, have_moved, list_pairs",
}


@dataclass(frozen=True)
class Assembled:
    """A kernel and the names of the scenario's numbers that it takes, in their order.

    Attributes:
        run: The kernel.
        numbers: Names, in the order of its first argument.
        source: Its text.
    """

    run: Any
    numbers: tuple[str, ...]
    source: str


@lru_cache(maxsize=64)
def assemble(parts: Parts, layout: Layout) -> Assembled:
    """The kernel that runs control steps of a kind of scenario.

    It returns how many steps it has run: fewer than it was asked for if the pairs of a swarm were
    more than there is room for.
    """
    text, numbers = source_of(parts, layout)
    module = load(f"{parts.name}_{layout.name}", text, component_modules(parts))
    return Assembled(module.run, numbers, text)


def source_of(parts: Parts, layout: Layout) -> tuple[str, tuple[str, ...]]:
    """The text of a kernel, and the names of the scenario's numbers that it takes."""
    body = Source(parts, layout, depth=1)
    _steps(body)
    head = Source(parts, layout)
    head(f'"""Assembled from the components of {parts.name}; not to be edited."""\n')
    head(_imports(parts, layout))
    head(_constants(parts, layout))
    own = {"work": records.work_fields(parts, layout)}
    if not layout.swarm:
        own["mine"] = records.mine_fields(parts, layout)
    for name, fields in own.items():
        _record(head, name.upper(), fields)
    head("\n\n@kernel")
    head(f"def run({', '.join(arguments(parts, layout))}):")
    head.depth = 1
    head("\n".join(f"{name} = on_the_stack({name.upper()})" for name in own))
    for number, name in enumerate(body.numbers):
        head(f"{name} = numbers[{number}]")
    return head.text + body.text, tuple(body.numbers)


def arguments(parts: Parts, layout: Layout) -> tuple[str, ...]:
    """What a kernel takes, in this order.

    numbers: float32, the scenario's; robots, objects: see `records`; group, classes, rows,
    thresholds, outcomes: control tables, see `kernels.table`; rules, accepted, actions, misses,
    decisions: rules to be interpreted and what is counted; holding: thresholds by which readings
    let rules act by chance; kinds, arguments: of each instance of a behaviour; grid: see
    `kernels.pairs`; width: lanes in use; first, steps: control steps.
    """
    table = ("group", "classes", "rows", "thresholds", "outcomes")
    rules = ("rules", "accepted", "actions", "misses", "decisions")
    return (
        *("numbers", "robots", "objects"),
        *(rules if layout.rules else table),
        *(("holding",) if layout.rules and parts.drawn_sensors else ()),
        *(("kinds", "arguments") if parts.arguments else ()),
        "grid" if layout.swarm else "width",
        *("first", "steps"),
    )


def component_modules(parts: Parts) -> tuple[str, ...]:
    """The modules in which the components are written."""
    return tuple(sorted({each.module for each in _called(parts) if each.module}))


def _called(parts: Parts) -> tuple[Component, ...]:
    return tuple(each for each in (*parts.components, *parts.needed_sums) if each.function)


def _imports(parts: Parts, layout: Layout) -> str:
    push = "push_apart" if layout.swarm else "pushed_apart"
    turn = (f"advance_exactly, {push}, turn_far, wheels", f"{push}, turn, wheels")
    search = _SEARCH[layout.swarm]
    lines = _IMPORTS.format(motion=turn[0 if layout.wide else 1], search=search)
    if parts.body.is_inert:
        lines += _OF_INERT_BODIES
    modules = component_modules(parts)
    return lines + "".join(f"import {module}\n" for module in modules)


def _constants(parts: Parts, layout: Layout) -> str:
    lines = [f"{each.name} = {each.module}.{each.name}.inlined" for each in _called(parts)]
    if layout.rules:
        lines += [f"BEHAVIOURS = {parts.most_instances}", f"STATES = {parts.states}"]
    return "\n" + "\n".join(lines)


def _record(source: Source, name: str, fields: records.Fields) -> None:
    """A type of record that the kernel has for itself."""
    letters: dict[type, str] = {F: "F", I: "I", U: "U"}
    with source.inside(f"{name} = np.dtype(["):
        for field, each in fields.items():
            kind, shape = each if isinstance(each, tuple) else (each, "LANES")
            source(f'("{field}", {letters[kind]}, {shape}),')
    source("], align=True)")


def _steps(source: Source) -> None:
    swarm = source.layout.swarm
    if swarm and any(effect.nearest for effect in source.parts.effects):
        sides = ", ".join(f"objects_{side}" for side in ("west", "south", "east", "north"))
        source(f"sort_objects(objects, grid, {sides})")
    with source.inside("for step in range(first, first + steps):"):
        if source.parts.body.is_inert:
            inert.step(source)
        else:
            _step(source)
        measuring.measures(source, "step")
    measuring.measures(source, "end")
    source("return steps")


def _step(source: Source) -> None:
    """A step of robots that move at once."""
    meeting.sums(source)
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        deciding.decide(source)
        acting.start_afresh(source)
        acting.effects(source)
        acting.move(source)
    meeting.collide(source)
