"""Where the parts of a state machine's picture go: states on an oval, arrows bowed apart.

Text stands at the arrows. If there is no room for all of it without covering something else, a
brief picture gets wider; in a full one arrows are numbered, and the text stands in a list below.
Machines of many states are laid out by Graphviz, if it is installed; else all is listed.
All lengths are in pixels, x to the right and y down; the layout is deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TypeAlias

from geswarm.exports import graphviz
from geswarm.exports.geometry import Box, Path, Point, bowed, loops
from geswarm.exports.placing import badges_apart, clearest, in_columns, place_badges, place_labels
from geswarm.rules.rates import Rate
from geswarm.rules.state_machine import State, StateMachine, Transition

Lines: TypeAlias = tuple[str, ...]

LINE_HEIGHT = 17.0
LABEL_SIZE, STATE_SIZE = 12.5, 16.0
_STATE_HEIGHT = 58.0
_MOST_NAMES = 4  # rules in a line of a brief picture
_GAP, _INITIAL_GAP = 3.0, 8.0  # between an arrow and a state
_OUTER_BOWS = (0.17, 0.13, 0.21, 0.25, 0.09, 0.05)
_INNER_BOWS = (0.045, 0.08, 0.11, 0.02, 0.15)
_CLEAR = 14.0  # between an arrow and a state that it passes
_LIST_GAP = 16.0
_TYPICAL = 0.00999  # probability whose text is as long as most
MOST_STATES = 8
"""On an oval; there would be no telling of the arrows between more."""
_MOST_BESIDE = 4  # states in a row, if they are only listed
_WIDER = (1.0, 1.2, 1.5)  # ovals that are tried until the text finds room
_PADDING = 24.0


@dataclass(frozen=True)
class Arrow:
    """All transitions from one state to another.

    Attributes:
        transitions: Their indices in the machine.
        path: Points of the curve from border to border; none if it is only listed.
        label: Where the text goes, if there is any.
        lines: The text of each transition; empty if the picture has none at its arrows.
        badge: Where its number goes if the text stands in the list; else None.
    """

    source: int
    target: int
    transitions: tuple[int, ...]
    path: Path
    label: Box
    lines: tuple[Lines, ...]
    badge: Box | None = None


@dataclass(frozen=True)
class Form:
    """How much a picture says, and the room that this takes.

    Attributes:
        arrow_lines: The text of a transition, one at least.
        radius: Of the oval of states, from its centre up, with text at the arrows.
        stretch: Of the oval, sideways.
        bare_radius: The radius if no text stands at the arrows.
        growth: By how much of it each state beyond the third widens the oval.
        spare: Height that a state leaves free below its text.
        listed: Whether text that finds no room stands in a list below; else the picture gets
            wider, up to a point, and the text is left out beyond it.
    """

    arrow_lines: Callable[[StateMachine, Transition], Lines]
    radius: float
    stretch: float
    bare_radius: float
    growth: float
    spare: float
    listed: bool


@dataclass(frozen=True)
class Layout:
    """A picture, laid out: boxes of the states, arrows, and the picture's size."""

    states: tuple[Box, ...]
    arrows: tuple[Arrow, ...]
    width: float
    height: float


def text_width(text: str, size: float) -> float:
    """About as wide as the wider of common sans-serif fonts sets it in bold."""
    # In whole hundredths: Python from 3.12 on adds fractions otherwise than before.
    ems = sum(77 if char.isupper() else 38 if char in " ,.()·" else 67 for char in text)
    return ems * size / 100


def state_lines(state: State) -> Lines:
    """The text of a state: its behaviour, then the internal states that distinguish it."""
    return (str(state.behaviour), *state.marks)


def heading_lines(machine: StateMachine, arrow: Arrow) -> Lines:
    """What stands above the text of an arrow in the list: from where to where."""
    if arrow.badge is None:
        return ()
    source, target = machine.states[arrow.source].label, machine.states[arrow.target].label
    return (source, "→ itself" if arrow.source == arrow.target else f"→ {target}")


def label_lines(machine: StateMachine, transition: Transition) -> Lines:
    """Condition, rate with the rules behind it, and effects of one transition, a line each."""
    rate = f"{transition.rate} · {_names(transition.rules)}"
    return str(transition.condition), rate, *machine.effects(transition)


def brief_lines(_: StateMachine, transition: Transition) -> Lines:
    """One line, with probability and rules."""
    rules = transition.rules
    names = _names(rules) if len(rules) <= _MOST_NAMES else f"{len(rules)} rules"
    sign = "≤" if transition.chances.varies else "="
    return (f"p {sign} {transition.probability:.3g} · {names}",)


def _names(rules: Sequence[int]) -> str:
    return " ".join(f"R{number}" for number in rules)


FULL = Form(
    label_lines, radius=265.0, stretch=1.5, bare_radius=210.0, growth=0.25, spare=0.0, listed=True
)
"""All that there is to know, to be printed."""

BRIEF = Form(
    brief_lines, radius=190.0, stretch=1.1, bare_radius=150.0, growth=0.25, spare=20.0, listed=False
)
"""Little text, for a small screen that tells the rest on demand."""


def lay_out(machine: StateMachine, form: Form = FULL) -> Layout:
    """Place states, arrows and text so that nothing covers anything else."""
    if len(machine.states) > MOST_STATES:
        return _lay_out_many(machine, form)
    for wider in _WIDER[:1] if form.listed else _WIDER:
        states = _place_states(machine, form, wider * form.radius)
        arrows = _arrows(machine, form, _paths(machine, states))
        labels = _labels_at_arrows(machine, form, arrows, states)
        if labels is not None:
            arrows = [replace(arrow, label=box) for arrow, box in zip(arrows, labels, strict=True)]
            return _at_origin(states, arrows)
    states = _place_states(machine, form, form.bare_radius)
    return _without_labels(machine, form, states, _paths(machine, states))


def _without_labels(
    machine: StateMachine, form: Form, states: Sequence[Box], paths: Mapping[tuple[int, int], Path]
) -> Layout:
    """The picture with its text in a list below, or, if it is brief, without text."""
    arrows = _arrows(machine, form, paths)
    if not form.listed:
        return _at_origin(states, [replace(arrow, lines=()) for arrow in arrows])
    curves = [arrow.path for arrow in arrows]
    many = len(states) > MOST_STATES
    badges = badges_apart(curves) if many else place_badges(curves, states)
    arrows = [replace(arrow, badge=box) for arrow, box in zip(arrows, badges, strict=True)]
    return _with_list(machine, _at_origin(states, arrows))


def _lay_out_many(machine: StateMachine, form: Form) -> Layout:
    """Many states, as Graphviz places them; without it a list of states and one of arrows."""
    sizes = [_state_box(state) for state in machine.states]
    gaps = [_INITIAL_GAP if state.initial else _GAP for state in machine.states]
    grown = [box.grown(gap) for box, gap in zip(sizes, gaps, strict=True)]
    found = graphviz.place([(box.width, box.height) for box in grown], list(machine.between))
    if found is not None:
        centres, paths = found
        states = [replace(box, x=x, y=y) for box, (x, y) in zip(sizes, centres, strict=True)]
        return _without_labels(machine, form, states, paths)
    extents = [(box.width, box.height) for box in grown]
    width = _MOST_BESIDE * max(wide for wide, _ in extents)
    places, _ = in_columns(extents, width, _LIST_GAP)
    states = [replace(box, x=at.x, y=at.y) for box, at in zip(sizes, places, strict=True)]
    first = states[0]
    arrows = _arrows(machine, form, dict.fromkeys(machine.between, ()))
    arrows = [replace(arrow, label=first, badge=first) for arrow in arrows]
    return _with_list(machine, _at_origin(states, arrows)) if arrows else _at_origin(states, [])


def _labels_at_arrows(
    machine: StateMachine, form: Form, arrows: Sequence[Arrow], states: Sequence[Box]
) -> list[Box] | None:
    if not arrows:
        return []
    extents = [label_extent(arrow.lines) for arrow in arrows]
    if not form.listed:  # on a page, nothing moves because a probability has other digits
        extents = [
            _larger(extent, label_extent(_typical_lines(machine, form, arrow)))
            for extent, arrow in zip(extents, arrows, strict=True)
        ]
    return place_labels([arrow.path for arrow in arrows], states, extents)


def _typical_lines(machine: StateMachine, form: Form, arrow: Arrow) -> list[Lines]:
    """The text of an arrow as it would be with probabilities of the usual length."""
    typical = Rate(_TYPICAL, _TYPICAL)
    entries = [replace(machine.transitions[at], chances=typical) for at in arrow.transitions]
    return [form.arrow_lines(machine, entry) for entry in entries]


def _larger(one: Point, other: Point) -> Point:
    return max(one[0], other[0]), max(one[1], other[1])


def _place_states(machine: StateMachine, form: Form, radius: float) -> list[Box]:
    """On an oval, the first at the top, clockwise; two of them beside each other."""
    count = len(machine.states)
    radius *= 1 + form.growth * max(0, count - 3) if count > 1 else 0.0
    first_angle = math.pi if count == 2 else -math.pi / 2
    radius *= 0.75 if count == 2 else 1.0
    boxes = []
    for at, state in enumerate(machine.states):
        angle = 2 * math.pi * at / count + first_angle
        x, y = form.stretch * radius * math.cos(angle), radius * math.sin(angle)
        boxes.append(_state_box(state).moved(x, y))
    return boxes


def _state_box(state: State) -> Box:
    """A state with room for its text, at the origin."""
    first, *others = state_lines(state)
    wide = [text_width(first, STATE_SIZE), *(text_width(row, LABEL_SIZE) for row in others)]
    return Box(0.0, 0.0, max(wide) + 44, _STATE_HEIGHT + LINE_HEIGHT * len(others))


def _arrows(
    machine: StateMachine, form: Form, paths: Mapping[tuple[int, int], Path]
) -> list[Arrow]:
    arrows = []
    for (source, target), entries in machine.between.items():
        indices = [
            at
            for at, entry in enumerate(machine.transitions)
            if (entry.source, entry.target) == (source, target)
        ]
        lines = tuple(form.arrow_lines(machine, entry) for entry in entries)
        path = paths[source, target]
        nowhere = Box(*(path[0] if path else (0.0, 0.0)), 0.0, 0.0)
        arrows.append(Arrow(source, target, tuple(indices), path, nowhere, lines))
    return arrows


def _paths(machine: StateMachine, states: Sequence[Box]) -> dict[tuple[int, int], Path]:
    """Curves between states, then loops where there is room for them."""
    count = len(states)
    centre = (sum(box.x for box in states) / count, sum(box.y for box in states) / count)
    paths = {
        ends: _curve(machine, states, centre, *ends)
        for ends in machine.between
        if ends[0] != ends[1]
    }
    for at in [source for source, target in machine.between if source == target]:
        others = [box for other, box in enumerate(states) if other != at]
        ways = loops(states[at], centre, _gaps(machine, at, at))
        paths[at, at] = clearest(ways, list(paths.values()), others)
    return paths


def _gaps(machine: StateMachine, source: int, target: int) -> Point:
    """How far an arrow stays away from both of its states."""
    one, two = (_INITIAL_GAP if machine.states[at].initial else _GAP for at in (source, target))
    return one, two


def _curve(
    machine: StateMachine, states: Sequence[Box], centre: Point, source: int, target: int
) -> Path:
    """A curve that passes no third state, if one of those that are tried does not.

    The two directions between a pair of states bow apart: each to the left of its way. Neighbours
    on the oval are joined outside it, where there is most room.
    """
    start, end = states[source], states[target]
    middle = ((start.x + end.x) / 2 - centre[0], (start.y + end.y) / 2 - centre[1])
    outside = (end.y - start.y) * middle[0] - (end.x - start.x) * middle[1] >= -1e-6
    side = 1.0
    if not outside and (target, source) not in machine.between:
        side, outside = -1.0, True
    neighbours = (source - target) % len(states) in (1, len(states) - 1)
    bows = _OUTER_BOWS if outside and neighbours else _INNER_BOWS
    paths = [bowed(start, end, side * bow, _gaps(machine, source, target)) for bow in bows]
    others = [box for at, box in enumerate(states) if at not in (source, target)]
    return next((path for path in paths if not _passes(path, others)), paths[0])


def _passes(path: Path, states: Sequence[Box]) -> bool:
    return any(box.rounded_contains(point, _CLEAR) for point, box in product(path, states))


def label_extent(lines: Sequence[Lines], heading: Lines = ()) -> Point:
    """Width and height of a label."""
    rows = [row for entry in lines for row in entry]
    wide = [text_width(row, LABEL_SIZE) + 16 for row in rows]
    wide += [text_width(row, LABEL_SIZE) + 44 for row in heading]
    height = (len(rows) + len(heading)) * LINE_HEIGHT + (len(lines) - 1) * 5 + 8
    return max(wide), height + (6 if heading else 0)


def _with_list(machine: StateMachine, layout: Layout) -> Layout:
    """The picture with the text of its arrows in columns below it."""
    extents = [label_extent(arrow.lines, heading_lines(machine, arrow)) for arrow in layout.arrows]
    room = max(layout.width - 2 * _PADDING, 3 * max(width for width, _ in extents))
    boxes, (width, height) = in_columns(extents, room, _LIST_GAP)
    whole = max(layout.width, width + 2 * _PADDING)
    aside = (whole - layout.width) / 2
    left, top = (whole - width) / 2, layout.height
    arrows = tuple(
        replace(_moved(arrow, aside, 0.0), label=box.moved(left, top))
        for arrow, box in zip(layout.arrows, boxes, strict=True)
    )
    states = tuple(box.moved(aside, 0.0) for box in layout.states)
    return Layout(states, arrows, whole, top + height + _PADDING)


def _moved(arrow: Arrow, dx: float, dy: float) -> Arrow:
    return replace(
        arrow,
        label=arrow.label.moved(dx, dy),
        path=tuple((x + dx, y + dy) for x, y in arrow.path),
        badge=arrow.badge.moved(dx, dy) if arrow.badge else None,
    )


def _at_origin(states: Sequence[Box], arrows: Sequence[Arrow]) -> Layout:
    """Everything moved so that the picture begins at (0, 0) with some padding."""
    boxes = [*states, *(arrow.label for arrow in arrows)]
    points = [point for arrow in arrows for point in arrow.path]
    west = min([box.x - box.width / 2 for box in boxes] + [x for x, _ in points]) - _PADDING
    east = max([box.x + box.width / 2 for box in boxes] + [x for x, _ in points]) + _PADDING
    north = min([box.y - box.height / 2 for box in boxes] + [y for _, y in points]) - _PADDING
    south = max([box.y + box.height / 2 for box in boxes] + [y for _, y in points]) + _PADDING
    return Layout(
        tuple(box.moved(-west, -north) for box in states),
        tuple(_moved(arrow, -west, -north) for arrow in arrows),
        east - west,
        south - north,
    )
