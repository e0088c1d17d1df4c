"""Boxes and curves of a state machine's picture.

All lengths are in pixels, x to the right and y down.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

Point: TypeAlias = tuple[float, float]
Path: TypeAlias = tuple[Point, ...]

CORNER = 29.0
"""Radius of a state's corners."""
_LOOP_HEIGHT, _LOOP_FOOT = 62.0, 38.0
SAMPLES = 40
"""Of a curve: it has one point more."""
_HALVINGS = 24  # until a crossing of a border is known to far less than a pixel


@dataclass(frozen=True)
class Box:
    """A rectangle by its centre and extents."""

    x: float
    y: float
    width: float
    height: float

    def grown(self, by: float) -> Box:
        """The box with a margin around it."""
        return replace(self, width=self.width + 2 * by, height=self.height + 2 * by)

    def moved(self, dx: float, dy: float) -> Box:
        """The box at another place."""
        return replace(self, x=self.x + dx, y=self.y + dy)

    def overlap(self, other: Box) -> Point:
        """How far two boxes lie over each other in x and y; negative: how far apart."""
        return (
            (self.width + other.width) / 2 - abs(self.x - other.x),
            (self.height + other.height) / 2 - abs(self.y - other.y),
        )

    def rounded_contains(self, point: Point, margin: float = 0.0) -> bool:
        """Whether a point lies inside, or nearer than a margin, if the corners are a state's."""
        x = max(0.0, abs(point[0] - self.x) - self.width / 2 + CORNER)
        y = max(0.0, abs(point[1] - self.y) - self.height / 2 + CORNER)
        return math.hypot(x, y) < CORNER + margin


def bowed(start: Box, end: Box, bow: float, gaps: Point) -> Path:
    """A curve from border to border that bows to the left of its way.

    Args:
        start: The state that it leaves.
        end: The state that it comes to.
        bow: How far it leaves the straight line, per length of that line; negative: to the right.
        gaps: How far its ends stay away from the borders.
    """
    dx, dy = end.x - start.x, end.y - start.y
    control = ((start.x + end.x) / 2 + 2 * bow * dy, (start.y + end.y) / 2 - 2 * bow * dx)

    def curve(t: float) -> Point:
        one, two, three = (1 - t) ** 2, 2 * t * (1 - t), t * t
        return (
            one * start.x + two * control[0] + three * end.x,
            one * start.y + two * control[1] + three * end.y,
        )

    return _between_borders(curve, start, end, gaps)


def loops(box: Box, centre: Point, gaps: Point) -> Iterator[Path]:
    """Loops on every side of a state; first those that look away from the picture's centre."""
    up = -1.0 if box.y <= centre[1] else 1.0
    left = -1.0 if box.x <= centre[0] else 1.0
    aside = box.width / 2 - CORNER
    for out, shifts in (
        ((0.0, up), (0.0, left * aside, -left * aside)),
        ((left, 0.0), (0.0,)),
        ((0.0, -up), (left * aside, 0.0, -left * aside)),
        ((-left, 0.0), (0.0,)),
    ):
        for shift in shifts:
            yield _loop(box, out, shift, gaps)


def _loop(box: Box, out: Point, shift: float, gaps: Point) -> Path:
    """A loop that leaves a state in a direction along an axis, so far from its middle."""
    across = abs(out[1]), abs(out[0])
    half = (abs(out[0]) * box.width + abs(out[1]) * box.height) / 2
    foot = min((across[0] * box.width + across[1] * box.height) / 4, _LOOP_FOOT)

    def curve(t: float) -> Point:
        swing = 3 * t * (1 - t) * (2 * t - 1)  # out to both sides, back at the ends
        aside = shift + foot * (2 * t - 1) * 0.8 + 2.2 * foot * swing
        away = half - 12 + 4 * t * (1 - t) * _LOOP_HEIGHT
        return box.x + away * out[0] + aside * across[0], box.y + away * out[1] + aside * across[1]

    return _between_borders(curve, box, box, gaps)


def _between_borders(curve: Callable[[float], Point], start: Box, end: Box, gaps: Point) -> Path:
    """The part of a curve between two borders; its parameter runs from 0 to 1."""

    def crossing(box: Box, gap: float, inside: float) -> float:
        outside = 0.5
        for _ in range(_HALVINGS):
            middle = (inside + outside) / 2
            if box.rounded_contains(curve(middle), gap):
                inside = middle
            else:
                outside = middle
        return outside

    first, last = crossing(start, gaps[0], 0.0), crossing(end, gaps[1], 1.0)
    return tuple(curve(first + (last - first) * at / SAMPLES) for at in range(SAMPLES + 1))


def evenly(points: Path, parts: int) -> Path:
    """The same curve in so many parts of equal length."""
    lengths = [math.dist(*pair) for pair in itertools.pairwise(points)]
    along = [0.0, *itertools.accumulate(lengths)]
    found, part = [], 0
    for at in range(parts + 1):
        wanted = along[-1] * at / parts
        while part < len(lengths) - 1 and along[part + 1] < wanted:
            part += 1
        share = (wanted - along[part]) / (lengths[part] or 1.0)
        (x, y), (next_x, next_y) = points[part], points[part + 1]
        found.append((x + share * (next_x - x), y + share * (next_y - y)))
    return tuple(found)


def normal(path: Path, at: int) -> Point:
    """Unit vector to the left of the way along a path, at one of its inner points."""
    (x, y), (next_x, next_y) = path[at - 1], path[at + 1]
    length = math.hypot(next_x - x, next_y - y) or 1.0
    return (next_y - y) / length, (x - next_x) / length
