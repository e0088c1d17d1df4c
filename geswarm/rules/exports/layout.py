"""Where the parts of a state machine's picture go: states on an oval, arrows bowed apart.

All lengths are in pixels, x to the right and y down; the drawing's corner is moved to the origin at
the end. The layout is deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from geswarm.rules.state_machine import State, StateMachine, Transition

Point: TypeAlias = tuple[float, float]
Lines: TypeAlias = tuple[str, ...]

LINE_HEIGHT = 17.0
LABEL_SIZE, STATE_SIZE = 12.5, 16.0
_STATE_HEIGHT, _LOOP = 58.0, 62.0
_MOST_LABELLED, _MOST_NAMES = 24, 4  # transitions of a brief picture; rules in a line of it
_OUTER_BOW, _INNER_BOW, _INNER_SHARE = 0.17, 0.045, 0.4
_GAP, _SAMPLES, _ROUNDS = 12.0, 40, 400
_PADDING = 24.0


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

    def contains(self, point: Point) -> bool:
        """Whether a point lies inside."""
        inside = abs(point[0] - self.x) < self.width / 2
        return inside and abs(point[1] - self.y) < self.height / 2

    def overlap(self, other: Box) -> Point:
        """How far two boxes lie over each other in x and y; negative: how far apart."""
        return (
            (self.width + other.width) / 2 - abs(self.x - other.x),
            (self.height + other.height) / 2 - abs(self.y - other.y),
        )


@dataclass(frozen=True)
class Arrow:
    """All transitions from one state to another.

    Attributes:
        transitions: Their indices in the machine.
        path: Points of the curve from border to border.
        label: Where the text goes, if there is any.
        lines: The text of each transition; empty if the picture has none at its arrows.
    """

    source: int
    target: int
    transitions: tuple[int, ...]
    path: tuple[Point, ...]
    label: Box
    lines: tuple[Lines, ...]


@dataclass(frozen=True)
class Form:
    """How much a picture says, and the room that this takes.

    Attributes:
        state_lines: The text of a state.
        arrow_lines: The text of an arrow's transitions, as in `Arrow`.
        radius: Of the oval of states, from its centre up.
        growth: By how much of it each state beyond the third widens the oval.
        stretch: Of the oval, sideways.
        spare: Height that a state leaves free below its text.
    """

    state_lines: Callable[[State], Lines]
    arrow_lines: Callable[[StateMachine, Sequence[Transition]], tuple[Lines, ...]]
    radius: float
    growth: float
    stretch: float
    spare: float


@dataclass(frozen=True)
class Layout:
    """A picture, laid out: boxes and text of the states, arrows, and the picture's size."""

    states: tuple[Box, ...]
    state_lines: tuple[Lines, ...]
    arrows: tuple[Arrow, ...]
    width: float
    height: float


def text_width(text: str, size: float) -> float:
    """About as wide as the wider of common sans-serif fonts sets it."""
    ems = sum(0.72 if char.isupper() else 0.34 if char in " ,.()" else 0.6 for char in text)
    return ems * size


def label_lines(machine: StateMachine, transition: Transition) -> Lines:
    """Condition, rate with the rules behind it, and effects of one transition, a line each."""
    rate = f"{transition.rate} · {_names(transition.rules)}"
    return str(transition.condition), rate, *machine.effects(transition)


def brief_lines(machine: StateMachine, transitions: Sequence[Transition]) -> tuple[Lines, ...]:
    """A line for each transition, with probability and rules; none if the machine has many."""
    if len(machine.transitions) > _MOST_LABELLED:
        return ()
    return tuple((_brief_line(entry),) for entry in transitions)


def _brief_line(transition: Transition) -> str:
    rules = transition.rules
    names = _names(rules) if len(rules) <= _MOST_NAMES else f"{len(rules)} rules"
    return f"p = {transition.probability:.3g} · {names}"


def _names(rules: Sequence[int]) -> str:
    return " ".join(f"R{number}" for number in rules)


FULL = Form(
    lambda state: (state.label,),
    lambda machine, entries: tuple(label_lines(machine, entry) for entry in entries),
    radius=265.0,
    growth=1 / 3,
    stretch=1.5,
    spare=0.0,
)
"""All that there is to know, to be printed."""

BRIEF = Form(
    lambda state: (state.behaviour, *state.marks),
    brief_lines,
    radius=170.0,
    growth=0.22,
    stretch=1.1,
    spare=20.0,
)
"""Little text, for a small screen that tells the rest on demand."""


def lay_out(machine: StateMachine, form: Form = FULL) -> Layout:
    """Place states, arrows and labels so that no label covers a state or another label."""
    lines = tuple(map(form.state_lines, machine.states))
    states = _place_states(lines, form)
    centre = (
        sum(box.x for box in states) / len(states),
        sum(box.y for box in states) / len(states),
    )
    arrows = [_arrow(machine, form, states, centre, *ends) for ends in machine.between]
    if any(arrow.lines for arrow in arrows):
        labels = _pushed_apart([arrow.label for arrow in arrows], states)
        arrows = [replace(arrow, label=box) for arrow, box in zip(arrows, labels, strict=True)]
    return _at_origin(states, lines, arrows)


def _place_states(lines: Sequence[Lines], form: Form) -> list[Box]:
    """On an oval, the first at the top, clockwise."""
    count = len(lines)
    radius = form.radius * (1 + form.growth * max(0, count - 3)) if count > 1 else 0.0
    boxes = []
    for at, (first, *others) in enumerate(lines):
        angle = 2 * math.pi * at / count - math.pi / 2
        wide = [text_width(first, STATE_SIZE), *(text_width(row, LABEL_SIZE) for row in others)]
        height = _STATE_HEIGHT + LINE_HEIGHT * len(others)
        x, y = form.stretch * radius * math.cos(angle), radius * math.sin(angle)
        boxes.append(Box(x, y, max(wide) + 44, height))
    return boxes


def _arrow(
    machine: StateMachine,
    form: Form,
    states: Sequence[Box],
    centre: Point,
    source: int,
    target: int,
) -> Arrow:
    indices = tuple(
        at
        for at, entry in enumerate(machine.transitions)
        if (entry.source, entry.target) == (source, target)
    )
    lines = form.arrow_lines(machine, machine.between[source, target])
    if source == target:
        path, away, share = *_loop(states[source], centre), 1.0
    else:
        alone = (target, source) not in machine.between
        path, away, share = _curve(states[source], states[target], centre, alone)
    middle = path[len(path) // 2]
    width, height = label_extent(lines)
    reach = share * ((abs(away[0]) * width + abs(away[1]) * height) / 2 + 12)
    label = Box(middle[0] + away[0] * reach, middle[1] + away[1] * reach, width, height)
    return Arrow(source, target, indices, path, label, lines)


def label_extent(lines: Sequence[Lines]) -> Point:
    """Width and height of a label."""
    if not lines:
        return 0.0, 0.0
    rows = [row for entry in lines for row in entry]
    width = max(text_width(row, LABEL_SIZE) for row in rows)
    return width + 16, len(rows) * LINE_HEIGHT + (len(lines) - 1) * 5 + 8


def _curve(
    start: Box, end: Box, centre: Point, alone: bool
) -> tuple[tuple[Point, ...], Point, float]:
    """A bow cut off at both boxes; to which side the label goes, and how far (1: clear of it).

    The two directions between a pair of states bow apart: each to the left of its way. The one
    inside the oval runs through its label, the one outside leaves it on its outer side.
    """
    dx, dy = end.x - start.x, end.y - start.y
    length = math.hypot(dx, dy)
    left = (dy / length, -dx / length)
    middle = ((start.x + end.x) / 2, (start.y + end.y) / 2)
    outside = left[0] * (middle[0] - centre[0]) + left[1] * (middle[1] - centre[1]) >= -1e-6
    if alone and not outside:
        left, outside = (-left[0], -left[1]), True
    bow = 2 * length * (_OUTER_BOW if outside else _INNER_BOW)
    control = (middle[0] + bow * left[0], middle[1] + bow * left[1])
    points = [
        (
            (1 - t) ** 2 * start.x + 2 * t * (1 - t) * control[0] + t * t * end.x,
            (1 - t) ** 2 * start.y + 2 * t * (1 - t) * control[1] + t * t * end.y,
        )
        for t in (step / _SAMPLES for step in range(_SAMPLES + 1))
    ]
    return _outside(points, start, end), left, 1.0 if outside else _INNER_SHARE


def _loop(box: Box, centre: Point) -> tuple[tuple[Point, ...], Point]:
    """A loop on the side of a state that looks away from the centre of the picture."""
    up = -1.0 if box.y <= centre[1] else 1.0
    foot = min(box.width / 4, 38.0)
    points = []
    for step in range(_SAMPLES + 1):
        t = step / _SAMPLES
        swing = 3 * t * (1 - t) * (2 * t - 1)  # out to both sides, back at the ends
        x = box.x + foot * (2 * t - 1) * 0.8 + 2.2 * foot * swing
        y = box.y + up * (box.height / 2 - 4 + 4 * t * (1 - t) * _LOOP)
        points.append((x, y))
    return _outside(points, box, box), (0.0, up)


def _outside(points: list[Point], start: Box, end: Box) -> tuple[Point, ...]:
    """The part of a curve between the borders of two boxes, with a little room at both ends."""
    first = next((at for at, p in enumerate(points) if not start.grown(3).contains(p)), 0)
    last = next(
        (at for at in range(len(points) - 1, -1, -1) if not end.grown(5).contains(points[at])),
        len(points) - 1,
    )
    return tuple(points[first : max(last, first + 1) + 1])


def _pushed_apart(labels: Sequence[Box], states: Sequence[Box]) -> list[Box]:
    """Move labels, as little as it takes, until they touch neither each other nor a state.

    One that does not find room between states that way leaves them up or down.
    """
    boxes = list(labels)
    for turn in range(_ROUNDS):
        moved = False
        for at in range(len(boxes)):
            for state in states:
                if push := _push(boxes[at], state.grown(6), upright=turn > _ROUNDS / 4):
                    boxes[at], moved = boxes[at].moved(*push), True
            for other in range(len(boxes)):
                if other != at and (push := _push(boxes[at], boxes[other])):
                    boxes[at] = boxes[at].moved(push[0] / 2, push[1] / 2)
                    boxes[other] = boxes[other].moved(-push[0] / 2, -push[1] / 2)
                    moved = True
        if not moved:
            break
    return boxes


def _push(box: Box, other: Box, upright: bool = False) -> Point | None:
    """The shortest way for one box to leave another alone; None if it already does.

    Args:
        box: Is moved.
        other: Stays.
        upright: Only up or down.
    """
    dx, dy = (overlap + _GAP for overlap in box.overlap(other))
    if dx <= 1e-6 or dy <= 1e-6:
        return None
    if dx < dy and not upright:
        return (math.copysign(dx, box.x - other.x), 0.0)
    return (0.0, math.copysign(dy, box.y - other.y))


def _at_origin(states: Sequence[Box], lines: tuple[Lines, ...], arrows: Sequence[Arrow]) -> Layout:
    """Everything moved so that the picture begins at (0, 0) with some padding."""
    boxes = [*states, *(arrow.label for arrow in arrows)]
    points = [point for arrow in arrows for point in arrow.path]
    west = min([box.x - box.width / 2 for box in boxes] + [x for x, _ in points]) - _PADDING
    east = max([box.x + box.width / 2 for box in boxes] + [x for x, _ in points]) + _PADDING
    north = min([box.y - box.height / 2 for box in boxes] + [y for _, y in points]) - _PADDING
    south = max([box.y + box.height / 2 for box in boxes] + [y for _, y in points]) + _PADDING
    return Layout(
        tuple(box.moved(-west, -north) for box in states),
        lines,
        tuple(
            replace(
                arrow,
                label=arrow.label.moved(-west, -north),
                path=tuple((x - west, y - north) for x, y in arrow.path),
            )
            for arrow in arrows
        ),
        east - west,
        south - north,
    )
