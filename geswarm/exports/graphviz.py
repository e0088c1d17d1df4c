"""Where Graphviz' `dot`, if it is installed, puts the states and arrows of a large machine."""

from __future__ import annotations

import shutil
import subprocess  # nosec B404
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from geswarm.exports.geometry import Path, Point, evenly

Ends: TypeAlias = tuple[int, int]

_PER_INCH = 72.0  # pixels
_SECONDS = 20.0
_SAMPLES = 10  # of each part of a curve
_PARTS = 160  # of a whole one, which may be long


def place(
    sizes: Sequence[Point], ends: Sequence[Ends]
) -> tuple[list[Point], dict[Ends, Path]] | None:
    """Centres of boxes and curves from border to border, in pixels, y down.

    Args:
        sizes: Width and height of each box.
        ends: The boxes that each curve joins.

    Returns:
        Centres, and a curve for each of `ends`; None if there is no `dot`, or it does not do it in
        some seconds.
    """
    command = shutil.which("dot")
    if command is None:
        return None
    graph = "\n".join(_graph(sizes, ends))
    try:
        done = subprocess.run(  # nosec B603
            [command, "-Tplain"],
            input=graph,
            capture_output=True,
            text=True,
            timeout=_SECONDS,
            check=True,
        )
        return _read(done.stdout, len(sizes), ends)
    except (OSError, subprocess.SubprocessError, ValueError, IndexError, KeyError):
        return None


def _graph(sizes: Sequence[Point], ends: Sequence[Ends]) -> Iterator[str]:
    yield "digraph {"
    yield 'nodesep=0.7; ranksep=0.9; node [shape=box, fixedsize=true, label=""]; edge [dir=none];'
    for at, (width, height) in enumerate(sizes):
        yield f"s{at} [width={width / _PER_INCH:.4f}, height={height / _PER_INCH:.4f}];"
    yield from (f"s{source} -> s{target};" for source, target in ends)
    yield "}"


def _read(
    plain: str, count: int, ends: Sequence[Ends]
) -> tuple[list[Point], dict[Ends, Path]] | None:
    """What `dot -Tplain` wrote: lines of `node NAME X Y ...` and `edge TAIL HEAD N X Y ...`."""
    centres: dict[int, Point] = {}
    curves: dict[Ends, Path] = {}
    for line in plain.splitlines():
        kind, *words = line.split()
        if kind == "node":
            centres[int(words[0][1:])] = _point(words[1], words[2])
        elif kind == "edge":
            source, target, points = int(words[0][1:]), int(words[1][1:]), int(words[2])
            numbers = words[3 : 3 + 2 * points]
            knots = [_point(numbers[at], numbers[at + 1]) for at in range(0, 2 * points, 2)]
            curves[source, target] = evenly(tuple(_curve(knots)), _PARTS)
    if not curves.keys() >= set(ends):
        return None
    return [centres[at] for at in range(count)], curves


def _point(x: str, y: str) -> Point:
    return float(x) * _PER_INCH, -float(y) * _PER_INCH


def _curve(knots: Sequence[Point]) -> Iterator[Point]:
    """Points of a chain of cubic Bézier curves, each of which begins where the last one ends."""
    yield knots[0]
    for first in range(0, len(knots) - 1, 3):
        part = knots[first : first + 4]
        for at in range(1, _SAMPLES + 1):
            t = at / _SAMPLES
            weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
            yield (
                sum(weight * x for weight, (x, _) in zip(weights, part, strict=True)),
                sum(weight * y for weight, (_, y) in zip(weights, part, strict=True)),
            )
