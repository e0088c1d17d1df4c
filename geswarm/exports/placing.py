"""Where labels and numbers go beside the arrows of a picture: where they cover the least."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.exports.geometry import SAMPLES, Box, Path, Point, normal

FloatArray: TypeAlias = npt.NDArray[np.float64]

FAULT = 1000.0
"""What covers something that must be seen costs at least this much."""

_ROUNDS, _TRIES = 4, 12
_UPON = 16.0  # against a label that interrupts its own arrow
_GAP, _STATE_GAP, _CURVE_GAP = 10.0, 14.0, 4.0  # between labels, to states, to other arrows
_CLOSE = 12.0  # to other arrows: not covered, but to be taken for theirs
_ALONG = (20, 17, 23, 14, 26, 11, 29)  # points of a path: its middle first
_FURTHER_OUT = (0.0, 22.0, 50.0, 90.0)
_SEEN_ENDS = (6, 33)  # of its own arrow, a label may cover points between these
BADGE = 22.0
"""Extent of a number on an arrow."""
_BADGE_ALONG = tuple(range(6, 33))


@dataclass(frozen=True)
class _Place:
    """Where a label could go.

    Attributes:
        upon: It lies upon its own arrow, instead of beside it.
        detour: How much is against it from the beginning.
    """

    box: Box
    upon: bool
    detour: float


class _Ground:
    """What is there already: states, and the arrows with all their points."""

    def __init__(self, paths: Sequence[Path], states: Sequence[Box]) -> None:
        self.states = states
        self.points = np.array([point for path in paths for point in path]).reshape(-1, 2)
        self.owners = np.repeat(np.arange(len(paths)), [len(path) for path in paths])
        self.along = np.concatenate([np.arange(len(path)) for path in paths])

    def cost(self, place: _Place, owner: int) -> float:
        """Of putting a label there; see `FAULT`."""
        box = place.box
        covered = sum(min(box.overlap(state)) > -_STATE_GAP for state in self.states)
        off = np.abs(self.points - (box.x, box.y)) - (box.width / 2, box.height / 2)
        distance = off.max(axis=1)
        own, foreign = self.owners == owner, self.owners != owner
        ends = (self.along < _SEEN_ENDS[0]) | (self.along > _SEEN_ENDS[1])
        hidden = np.count_nonzero((distance < _CURVE_GAP) & (foreign | ends))
        grazed = 0 if place.upon else np.count_nonzero((distance < 2) & own)
        away = max(0.0, float(distance[own].min()))
        nearest = float(distance[foreign].min(initial=np.inf))
        mistaken = away >= max(nearest, 1.0)  # for the label of another arrow
        detour = 0.4 * away + 2.0 * max(0.0, away + _CLOSE - nearest) + 10.0 * grazed
        return FAULT * (covered + hidden + mistaken) + detour + place.detour


def clearest(candidates: Iterable[Path], others: Sequence[Path], states: Sequence[Box]) -> Path:
    """The first of those curves that come least often near to other curves and states."""
    points = np.array([point for path in others for point in path]).reshape(-1, 2)

    def cost(path: Path) -> int:
        there = np.array(path)
        apart = np.hypot(*(there[:, None, :] - points[None, :, :]).transpose(2, 0, 1))
        near = int(np.count_nonzero(apart < _CLOSE))
        return near + sum(box.rounded_contains(point, _CLOSE) for point in path for box in states)

    return min(candidates, key=cost)


def place_labels(
    paths: Sequence[Path], states: Sequence[Box], extents: Sequence[Point]
) -> list[Box] | None:
    """A place for the label of every arrow; None if they do not find room.

    Args:
        paths: The arrows.
        states: Must stay visible.
        extents: Width and height of each label.
    """
    candidates = [list(_beside(*each)) for each in zip(paths, extents, strict=True)]
    choice = _Choice(paths, states, candidates)
    if any(costs.min() >= FAULT for costs in choice.alone):
        return None
    choice.settle()
    choice.make_room()
    return choice.places() if choice.total() < FAULT else None


def place_badges(paths: Sequence[Path], states: Sequence[Box]) -> list[Box]:
    """A place on every arrow for its number, as near to the arrow's start as can be."""
    candidates = [
        [_Place(Box(*path[at], BADGE, BADGE), True, 0.5 * abs(at - 12)) for at in _BADGE_ALONG]
        for path in paths
    ]
    choice = _Choice(paths, states, candidates)
    choice.settle()
    return choice.places()


class _Choice:
    """One of some places for each of several boxes, so that they leave one another alone."""

    def __init__(
        self,
        paths: Sequence[Path],
        states: Sequence[Box],
        candidates: Sequence[Sequence[_Place]],
    ) -> None:
        ground = _Ground(paths, states)
        self.boxes = [[place.box for place in each] for each in candidates]
        self.alone = [
            np.array([ground.cost(place, owner) for place in each])
            for owner, each in enumerate(candidates)
        ]
        self.chosen = [int(costs.argmin()) for costs in self.alone]

    def costs(self, at: int) -> FloatArray:
        """What each place for a box costs as the others stand."""
        places = np.array([(b.x, b.y, b.width, b.height) for b in self.boxes[at]])
        total = self.alone[at].copy()
        for other, choice in enumerate(self.chosen):
            if other != at:
                box = self.boxes[other][choice]
                apart_x = np.abs(places[:, 0] - box.x) - (places[:, 2] + box.width) / 2
                apart_y = np.abs(places[:, 1] - box.y) - (places[:, 3] + box.height) / 2
                total += FAULT * (np.maximum(apart_x, apart_y) < _GAP)
        return total

    def total(self) -> float:
        """What the whole choice costs."""
        return sum(float(self.costs(at)[choice]) for at, choice in enumerate(self.chosen))

    def places(self) -> list[Box]:
        """The places chosen."""
        return [boxes[choice] for boxes, choice in zip(self.boxes, self.chosen, strict=True)]

    def settle(self) -> None:
        """Choose again and again until nothing gets better."""
        order = sorted(range(len(self.boxes)), key=lambda at: -self.boxes[at][0].height)
        for _ in range(_ROUNDS):
            before = list(self.chosen)
            for at in order:
                self.chosen[at] = int(self.costs(at).argmin())
            if self.chosen == before:
                break

    def make_room(self) -> None:
        """Let each box that stands badly take a better place; those in its way make room."""
        for at in range(len(self.boxes)):
            now = self.costs(at)[self.chosen[at]]
            better = np.flatnonzero(self.alone[at] < now - 1)
            for choice in better[np.argsort(self.alone[at][better], kind="stable")][:_TRIES]:
                before, price = list(self.chosen), self.total()
                self.chosen[at] = int(choice)
                self.settle_others(at)
                if self.total() < price - 1:
                    break
                self.chosen = before

    def settle_others(self, fixed: int) -> None:
        """All but one choose again, once."""
        for at in range(len(self.boxes)):
            if at != fixed:
                self.chosen[at] = int(self.costs(at).argmin())


def _beside(path: Path, extent: Point) -> Iterator[_Place]:
    """Places for a label at both sides of a path and on it, its middle first."""
    width, height = extent
    for at in _ALONG:
        x, y = path[at]
        nx, ny = normal(path, at)
        reach = (abs(nx) * width + abs(ny) * height) / 2 + 10
        shift = 0.4 * abs(at - len(path) // 2)
        yield _Place(Box(x, y, width, height), True, shift + _UPON)
        for side in (1, -1):
            for further in _FURTHER_OUT:
                away = side * (reach + further)
                yield _Place(Box(x + away * nx, y + away * ny, width, height), False, shift)


def badges_apart(paths: Sequence[Path]) -> list[Box]:
    """A badge on each of many curves, away from those before it: soon found, not the best."""
    found: list[Box] = []
    for path in paths:

        def room(point: Point) -> float:
            apart = (math.hypot(point[0] - box.x, point[1] - box.y) for box in found)
            return min(min(apart, default=math.inf), 2 * BADGE)

        along = (path[at * (len(path) - 1) // SAMPLES] for at in _BADGE_ALONG)
        place = max(along, key=room)
        found.append(Box(*place, BADGE, BADGE))
    return found


def in_columns(extents: Sequence[Point], width: float, gap: float) -> tuple[list[Box], Point]:
    """Boxes one under the other in columns of the same height, as many as fit into a width.

    Returns:
        The boxes, from (0, 0) on, and the extent of them all.
    """
    if not extents:
        return [], (0.0, 0.0)
    column = max(extent[0] for extent in extents) + gap
    count = max(1, min(len(extents), math.floor((width + gap) / column)))
    height = max(extent[1] for extent in extents)
    while len(_filled(extents, height, gap)) > count:
        height += 10
    boxes, lowest = [], 0.0
    for number, heights in enumerate(_filled(extents, height, gap)):
        top = 0.0
        for extent in heights:
            middle = number * column + extent[0] / 2, top + extent[1] / 2
            boxes.append(Box(*middle, *extent))
            lowest, top = max(lowest, top + extent[1]), top + extent[1] + gap
    return boxes, (len(_filled(extents, height, gap)) * column - gap, lowest)


def _filled(extents: Sequence[Point], height: float, gap: float) -> list[list[Point]]:
    """Columns of at most a height."""
    columns: list[list[Point]] = [[]]
    for extent in extents:
        used = sum(other[1] + gap for other in columns[-1])
        if columns[-1] and used + extent[1] > height:
            columns.append([])
        columns[-1].append(extent)
    return columns
