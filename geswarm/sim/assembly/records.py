"""The arrays that an assembled kernel works on: blocks of 64 lanes."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.sim.assembly import ground, senses
from geswarm.sim.assembly.source import Layout
from geswarm.sim.kernels import contact
from geswarm.sim.kernels.single import F, I, U
from geswarm.sim.kernels.state import LANES
from geswarm.sim.terms.component import OTHER, CellMeasure
from geswarm.sim.terms.parts import Parts

Records: TypeAlias = npt.NDArray[np.void]
Record: TypeAlias = Any
Fields: TypeAlias = dict[str, type | tuple[type, tuple[int, ...]]]
"""Kinds of numbers by name, LANES of each, or an array of a shape."""

_OF_NEAR_PAIRS = [f"pair_{name}" for name in contact.OF_NEAR_PAIRS]
_LINE = 64
"""Bytes of a line of the cache."""

RULE = np.dtype(
    [
        ("fired", np.int64),  # how often some action of it was drawn, counted by the kernel
        ("enabled", np.int32),
        ("behaviours", np.uint32),  # mask of the instances in which it may be active
        ("first_action", np.int64),
        ("end_action", np.int64),
    ],
    align=True,
)
"""A rule to be interpreted; what it accepts of each reading is an array of its own."""

ACTION = np.dtype(
    [
        ("fired", np.int64),  # how often it was drawn, counted by the kernel
        ("threshold", np.uint32),  # drawn if `possible` and the random bits are no more than this
        ("possible", np.int32),
        ("target", np.int32),  # instance to change to, -1 for an action on registers
        ("clears", np.int32),  # mask of bits
        ("sets", np.int32),
        ("added", np.int32),  # to the counter
        ("least", np.int32),  # value of the counter then
        ("most", np.int32),
        ("restarts", np.int32),  # whether changing to the target starts something afresh
    ],
    align=True,
)
"""An action of a rule."""

CHANCE = np.dtype([("threshold", np.uint32), ("possible", np.int32)])
"""A probability as random bits are compared with it."""


def robot_type(parts: Parts, layout: Layout) -> np.dtype[np.void]:
    """A block of robots: robot i of 64 simulations, or robots 64 i to 64 i + 63 of a swarm."""
    return _in_lanes(_robot_fields(parts, layout))


def _robot_fields(parts: Parts, layout: Layout) -> Fields:
    fields: Fields = {}
    if layout.rules:
        fields |= {"percepts": I, "last_rule": I}
    if layout.wide:
        fields |= {"low_x": F, "low_y": F}
    fields |= ground.fields(parts.ground, layout.wide)
    if layout.swarm:
        # Whether there is such a robot; its cell; where it was when pairs were listed.
        fields |= {"exists": I, "cell": I, "listed_x": F, "listed_y": F}
    # These come last: numba takes a record that begins like another one for a kind of it.
    return fields | {
        **dict.fromkeys(("x", "y", "cos", "sin"), F),
        **dict.fromkeys(("behaviour", "state"), I),
        **dict.fromkeys(("key_low", "key_high"), U),
        **parts.own_fields,
        **_of_inert_bodies(parts),
        **_of_cells(parts),
    }


def _of_inert_bodies(parts: Parts) -> Fields:
    if not parts.body.is_inert:
        return {}
    rows = {name: (kind, (number, LANES)) for name, (kind, number) in senses.ROWS.items()}
    return {**senses.fields(parts.ground.lights), **rows}


def _of_cells(parts: Parts) -> Fields:
    """When each cell was visited last; that of the first robot is for all."""
    cells = [measure.cells for measure in parts.measures if isinstance(measure, CellMeasure)]
    return {"visits_sum": I, "visits": (I, (max(cells), LANES))} if cells else {}


def room(count: int, dtype: np.dtype[np.void]) -> Records:
    """Records of zeros, each field of which begins a line of the cache.

    numpy's own arrays begin anywhere, and a vector that lies in two lines takes twice as long.
    """
    size = count * dtype.itemsize
    whole = np.zeros(size + _LINE, dtype=np.uint8)
    begin = -whole.ctypes.data % _LINE
    return whole[begin : begin + size].view(dtype)


def work_fields(parts: Parts, layout: Layout) -> Fields:
    """What is kept between the loops of a step, for one block or one pair of blocks."""
    fields: Fields = {
        "d2": F,
        **dict.fromkeys(("place", "row", "word", "bits"), U),
        **dict.fromkeys(("restarts", "happens"), I),
        **dict.fromkeys(("kind", "object_near"), I),
        **{f"argument{number}": F for number in range(parts.arguments)},
    }
    fields |= dict.fromkeys(ground.kept(parts), F)
    if layout.swarm:
        fields |= dict.fromkeys(("dx", "dy", "per_d", "weight"), F)
    else:
        fields |= {"nearest": F, "touch": I, **parts.swarm_sums}
    if layout.rules:
        fields |= dict.fromkeys(("active", "fired", "memory"), I)
        fields |= {f"{sensor.name}_now": I for sensor in parts.sensors}
    if parts.body.is_inert:
        fields |= {"near": I, **dict.fromkeys(("dx", "dy", "per_d"), F), **_near_robots()}
        pairs = {**dict.fromkeys(("one", "two", "touching"), I), **dict.fromkeys(_OF_NEAR_PAIRS, F)}
        fields |= {name: (kind, (contact.MOST_PAIRS,)) for name, kind in pairs.items()}
        fields |= dict.fromkeys(("places_x", "places_y"), (F, (LANES, LANES)))
    return fields


def mine_fields(parts: Parts, layout: Layout) -> Fields:
    """What a robot needs at hand while it is compared with the others: its sums and their needs."""
    named = {"x", "y"}
    for one in parts.needed_sums:
        needs = {name.removeprefix(OTHER) for name in one.needs}  # it is the other one's other
        named |= {"state" if name in parts.shifts else name for name in needs}
        named |= set(one.outputs)
    return {name: kind for name, kind in _robot_fields(parts, layout).items() if name in named}


def _near_robots() -> dict[str, type]:
    """What `contact.settle` knows of each robot of one lane that may touch something."""
    walls = [f"wall{number}_{name}" for number in range(2) for name in contact.OF_A_WALL]
    whole = dict.fromkeys(("number", "walled", "met", "driven", "kept"), I)
    return {**whole, **dict.fromkeys((*contact.OF_THE_NEAR, *walls), F)}


OBJECT = np.dtype([("x", F, LANES), ("y", F, LANES)])
"""The object of one number in 64 simulations."""

GROUP = np.dtype([("codes", U, LANES), ("rows", U, LANES), ("instances", U, LANES)])
"""Where the control table of each lane begins in the arrays of all."""


def _in_lanes(fields: Fields) -> np.dtype[np.void]:
    shaped = {
        name: each if isinstance(each, tuple) else (each, LANES) for name, each in fields.items()
    }
    return np.dtype([(name, kind, shape) for name, (kind, shape) in shaped.items()], align=True)
