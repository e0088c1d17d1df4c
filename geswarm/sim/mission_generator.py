"""The mission generator MG1 of AutoMoDe's authors: random scenarios for e-pucks.

Arenas, discs, obstacles and how probable each choice is are those of its published parameters; a
patch may lie at any place that the arena has for its radius. Robots start uniformly over the area;
the published code draws the radius uniformly. Not here is the third way to start, anywhere but on
patches, which no region of start says: they start anywhere.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from itertools import combinations
from typing import NamedTuple, TypeAlias


class _Disc(NamedTuple):
    """Where a patch may be."""

    x: float
    y: float
    radius: float


class _Arena(NamedTuple):
    """What there may be in an arena; obstacles are (x, y, degrees)."""

    outline: str
    discs: tuple[_Disc, ...]
    obstacles: tuple[tuple[float, float, float], ...]
    obstacle_length: float
    light: tuple[float, float]
    sides: tuple[str, str]


def _around(distance: float, angles: Sequence[float]) -> list[tuple[float, float]]:
    """Places at some angles (degrees)."""
    turns = [math.radians(angle) for angle in angles]
    return [
        (round(distance * math.cos(a), 4) + 0.0, round(distance * math.sin(a), 4) + 0.0)
        for a in turns
    ]


def _triangle() -> _Arena:
    inner, outer = 2.4 / 2.0 / math.sqrt(3.0), 2.4 / math.sqrt(3.0)
    half = _around(outer / 2.0, (0, 120, 240))
    return _Arena(
        "corners: 3, side: 2.4, turn: 0",
        _discs([(0.0, 0.0), *half], _around(outer, (0, 120, 240))),
        tuple((x / 2.0, y / 2.0, turn) for (x, y), turn in zip(half, (0, -60, 60), strict=True)),
        0.25,
        (-inner - 0.2, 0.0),
        ("west", "east"),
    )


def _square() -> _Arena:
    outer = 1.94 / math.sqrt(2.0)
    inside = _around(outer * 2.0 / 3.0, (0, 90, 180, 270))
    return _Arena(
        "corners: 4, side: 1.94, turn: 0",
        _discs([(0.0, 0.0), *inside], _around(outer, (0, 90, 180, 270))),
        tuple(
            (x / 2.0, y / 2.0, turn) for (x, y), turn in zip(inside, (0, 90, 0, 90), strict=True)
        ),
        0.45,
        (0.0, -1.61),
        ("north", "south"),
    )


def _hexagon() -> _Arena:
    inner, outer = 1.29 * math.sqrt(3.0) / 2.0, 1.29
    towards_corners = _around(outer * 2.0 / 3.0, (90, 270))
    towards_walls = _around(inner * 2.0 / 3.0, (0, 180))
    beside = _around(inner / 3.0, (0, 90, 180, 270))
    return _Arena(
        "corners: 6, side: 1.29, turn: 30",
        _discs([(0.0, 0.0), *towards_corners, *towards_walls], _around(outer, (90, 270))),
        tuple((x, y, turn) for (x, y), turn in zip(beside, (0, 90, 0, 90), strict=True)),
        0.35,
        (0.0, -outer - 0.2),
        ("north", "south"),
    )


def _discs(
    inside: Sequence[tuple[float, float]], corners: Sequence[tuple[float, float]]
) -> tuple[_Disc, ...]:
    """Small and middle ones inside, large ones in corners."""
    small = [_Disc(x, y, radius) for radius in (0.15, 0.3) for x, y in inside]
    return (*small, *(_Disc(x, y, 0.4) for x, y in corners))


_ARENAS = {"triangle": _triangle(), "square": _square(), "hexagon": _hexagon()}
_OBSTACLES = {
    **dict.fromkeys(("foraging", "homing"), (0.2, 0.4, 0.3, 0.1)),
    "xor": (0.4, 0.3, 0.2, 0.1),
}
"""How probable 0 to 3 are."""
_LIT = {"foraging": 0.85, "homing": 0.3, "xor": 0.3}
"""How probable a light is."""
_ANY = (0.15, 0.3, 0.4)
_EVERYWHERE = "{disc: {at: [0, 0], radius: 1.4}}"
_Task: TypeAlias = tuple[list[str], str, str]
"""Patches, measure and objective, as the file has them."""


def mission(seed: int, number: int) -> str:
    """A scenario of MG1, the text of a file that extends `epuck-aac`.

    Args:
        seed: Of a series.
        number: In the series, from 1.
    """
    draw = random.Random(f"mg1 {seed} {number}")  # nosec B311
    kind = draw.choices(tuple(_TASKS), (0.2, 0.4, 0.4))[0]
    shape = draw.choice(tuple(_ARENAS))
    arena = _ARENAS[shape]
    patches, measure, objective = _TASKS[kind](draw, arena)
    count = draw.choices(range(4), _OBSTACLES[kind])[0]
    obstacles = draw.sample(arena.obstacles, count)
    lit = draw.random() < _LIT[kind]
    side = draw.choice(arena.sides)
    half = f"{{half_plane: {{side: {side}, at: 0}}}}"
    start = draw.choices((_EVERYWHERE, half), (2, 1))[0]
    lines = [
        f"# MG1, seed {seed}, mission {number}: {kind} in a {shape}.",
        "# Rays of e-pucks see obstacles as the wall that is nearest.",
        "extends: epuck-aac",
        f"robots: {draw.randint(15, 20)}",
        f"duration: {draw.choices((60, 120, 180), (0.25, 0.375, 0.375))[0]}",
        "arena:",
        f"  regular: {{{arena.outline}}}",
        f"  obstacles: [{', '.join(_obstacle(arena, *each) for each in obstacles)}]",
        "  patches:",
        *(f"    - {each}" for each in patches),
        f"  lights: [{_lamp(*arena.light) if lit else ''}]",
        f"  start: {start}",
        f"measures: [{measure}]",
        f"objective: {objective}",
        'reference: ""',  # a rule set by hand is for one mission
    ]
    return "\n".join(lines) + "\n"


def _obstacle(arena: _Arena, x: float, y: float, turn: float) -> str:
    size = f"size: [0.026, {arena.obstacle_length}]"
    return f"{{box: {{at: [{x:.4f}, {y:.4f}], {size}, angle: {turn}}}}}"


def _lamp(x: float, y: float) -> str:
    return f"{{at: [{x:.4f}, {y:.4f}], height: 0.4, intensity: 5}}"


def _foraging(draw: random.Random, arena: _Arena) -> _Task:
    nest, food = draw.sample(("white", "black"), 2)
    nests = draw.choices((1, 2), (0.95, 0.05))[0]
    sources = draw.choices((1, 2, 3), (0.5, 0.4, 0.1))[0]
    areas = [(nest, "nest")] * nests + [(food, "food")] * sources
    kinds = [_ANY] * nests + [(0.15, 0.4)] * sources
    return _patches(draw, arena, areas, kinds), "delivered", "{maximise: delivered, unit: items}"


def _homing(draw: random.Random, arena: _Arena) -> _Task:
    home, other = draw.sample(("white", "black"), 2)
    others = draw.choices((0, 1, 2), (0.55, 0.3, 0.15))[0]
    areas = [(home, "home")] + [(other, "")] * others
    patches = _patches(draw, arena, areas, [(0.3,)] + [_ANY] * others)
    if draw.random() < 0.5:
        return patches, "on_home", "{maximise: on_home, unit: robot-steps}"
    return patches, "max_group", "{maximise: max_group, unit: robots}"


def _xor(draw: random.Random, arena: _Arena) -> _Task:
    home, other = draw.sample(("white", "black"), 2)
    homes = draw.choices((2, 3), (0.8, 0.2))[0]
    others = int(homes == 2 and draw.random() < 0.4)
    areas = [(home, f"home{k + 1}") for k in range(homes)] + [(other, "")] * others
    patches = _patches(draw, arena, areas, [(0.3,)] * homes + [_ANY] * others)
    if draw.random() < 0.5:
        return patches, "larger_group", "{maximise: larger_group / robots, unit: steps}"
    return patches, "max_group", "{maximise: max_group / robots, unit: share of robots}"


def _patches(
    draw: random.Random,
    arena: _Arena,
    areas: Sequence[tuple[str, str]],
    kinds: Sequence[tuple[float, ...]],
) -> list[str]:
    """Discs of the radii on offer for each area, drawn until none lies on another."""
    while True:
        chosen = [draw.choice([d for d in arena.discs if d.radius in radii]) for radii in kinds]
        if all(math.dist(a[:2], b[:2]) >= a.radius + b.radius for a, b in combinations(chosen, 2)):
            break
    found = []
    for (x, y, radius), (colour, area) in zip(chosen, areas, strict=True):
        named = f", area: {area}" if area else ""
        disc = f"{{at: [{x:.4f}, {y:.4f}], radius: {radius}}}"
        found.append(f"{{disc: {disc}, floor: {colour}{named}}}")
    return found


_TASKS: dict[str, Callable[[random.Random, _Arena], _Task]] = {
    "foraging": _foraging,
    "homing": _homing,
    "xor": _xor,
}
