"""A state machine as a picture (SVG), drawn without other programs.

Every state is a group `.state` with `data-state`, every arrow a group `.arrow` with `data-source`,
`data-target` and `data-transitions`, every transition of its label a group `.transition` with
`data-transition` and `data-rules`: a page can light them up. Indices are those of the machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.sax.saxutils import escape, quoteattr

from geswarm.exports.colours import behaviour_colours, css, tint
from geswarm.exports.geometry import CORNER, Box, Path, Point
from geswarm.exports.layout import (
    BRIEF,
    FULL,
    LABEL_SIZE,
    LINE_HEIGHT,
    STATE_SIZE,
    Arrow,
    Form,
    Layout,
    heading_lines,
    lay_out,
    state_lines,
    text_width,
)
from geswarm.exports.placing import BADGE
from geswarm.rules.model import RuleSet
from geswarm.rules.state_machine import StateMachine
from geswarm.rules.vocabulary import FORAGING, Vocabulary

_INK, _MUTED, _EFFECT, _PAPER = "#1d2733", "#5c6b7a", "#b3126f", "#ffffff"
_HEADER, _FOOTER = 58.0, 34.0
_HEAD_LENGTH, _HEAD_SPREAD = 14.0, 0.4  # of an arrowhead; half its width per length
_FONT = "Inter, 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif"
_LINE_STYLES = (
    f'font-weight="600" fill="{_INK}"',
    f'fill="{_MUTED}"',
    f'font-weight="600" fill="{_EFFECT}"',
)
"""Of a transition's condition, its rate, and its effects."""
_LEGEND = (
    "p: probability per control step of 0.1 s, then the mean waiting time · R: the rules behind it"
)


def format_svg(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """The state machine of a rule set as a picture.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    return machine_svg(StateMachine.of(rule_set, vocabulary))


def machine_svg(machine: StateMachine) -> str:
    """A standalone SVG document."""
    layout = lay_out(machine, FULL)
    title = machine.name or "State machine"
    width = max(layout.width, text_width(_LEGEND, 12) + 48, text_width(title, 22) + 48)
    height = layout.height + _HEADER + _FOOTER
    shift = (width - layout.width) / 2
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" font-family={quoteattr(_FONT)} role="img">',
        f"<title>{escape(title)}: state machine</title>",
        f'<rect width="{width:.0f}" height="{height:.0f}" rx="14" fill="{_PAPER}"/>',
        f'<text x="24" y="38" font-size="22" font-weight="700" fill="{_INK}">'
        f"{escape(title)}</text>",
        f'<g transform="translate({shift:.1f} {_HEADER:.0f})">',
        *_arrows(machine, layout),
        *_states(machine, layout, FULL),
        "</g>",
        f'<text x="24" y="{height - 16:.0f}" font-size="12" fill="{_MUTED}">{_LEGEND}</text>',
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def brief_svg(machine: StateMachine) -> str:
    """A smaller drawing with little text, or none at the arrows if there are many.

    It is for a page that has a title and tells the rest.
    """
    layout = lay_out(machine, BRIEF)
    size = f"{layout.width:.0f} {layout.height:.0f}"
    width, height = size.split()
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" width="{width}" '
        f'height="{height}" role="group" aria-label="State machine">',
        *_arrows(machine, layout),
        *_states(machine, layout, BRIEF),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def _colour(machine: StateMachine, state: int) -> tuple[str, str]:
    """Strong and pale colour of a state's behaviour."""
    code = machine.position(machine.states[state].behaviour)
    colour = behaviour_colours(machine.space.vocabulary)[code]
    return css(colour), tint(colour)


def _states(machine: StateMachine, layout: Layout, form: Form) -> Iterator[str]:
    for at, (state, box) in enumerate(zip(machine.states, layout.states, strict=True)):
        strong, pale = _colour(machine, at)
        yield f'<g class="state" data-state="{at}">'
        if state.initial:
            yield f"<title>{escape(state.label)}: robots start here</title>"
            yield _rectangle("initial", box.grown(5), "none", strong, 1.5, CORNER + 5)
        yield _rectangle("body", box, pale, strong, 3, CORNER)
        first, *others = state_lines(state)
        y = box.y + 5.5 - form.spare / 2 - LINE_HEIGHT * len(others) / 2
        middle = f'x="{box.x:.1f}" text-anchor="middle"'
        yield (
            f'<text {middle} y="{y:.1f}" font-size="{STATE_SIZE}" '
            f'font-weight="700" fill="{_INK}">{escape(first)}</text>'
        )
        for row in others:
            y += LINE_HEIGHT
            yield (
                f'<text {middle} y="{y:.1f}" font-size="{LABEL_SIZE}" '
                f'fill="{_MUTED}">{escape(row)}</text>'
            )
        yield "</g>"


def _rectangle(name: str, box: Box, fill: str, stroke: str, width: float, radius: float) -> str:
    return (
        f'<rect class="{name}" x="{box.x - box.width / 2:.1f}" y="{box.y - box.height / 2:.1f}" '
        f'width="{box.width:.1f}" height="{box.height:.1f}" rx="{radius}" '
        f'fill="{fill}" stroke="{stroke}" stroke-width="{width}"/>'
    )


def _arrows(machine: StateMachine, layout: Layout) -> Iterator[str]:
    """All curves first, then all text, so that no curve runs over it."""
    for arrow in layout.arrows:
        if not arrow.path:
            continue
        strong, _ = _colour(machine, arrow.source)
        indices = " ".join(map(str, arrow.transitions))
        likeliest = max(machine.transitions[at].probability for at in arrow.transitions)
        yield (
            f'<g class="arrow" data-source="{arrow.source}" data-target="{arrow.target}" '
            f'data-transitions="{indices}">'
        )
        yield (
            f'<path d="{_shaft(arrow.path)}" fill="none" stroke="{strong}" '
            f'stroke-width="{1.6 + 1.8 * math.sqrt(likeliest):.2f}" stroke-linecap="round"/>'
        )
        yield f'<path d="{_head(arrow.path)}" fill="{strong}"/></g>'
    for number, arrow in enumerate(layout.arrows, start=1):
        if arrow.badge and arrow.path:
            yield from _badge(machine, arrow, number, arrow.badge.x, arrow.badge.y)
        if arrow.lines:
            yield from _label(machine, arrow, number)


def _shaft(path: Path) -> str:
    """A curve as far as into its arrowhead."""
    end_x, end_y = path[-1]
    points = [(x, y) for x, y in path if math.hypot(x - end_x, y - end_y) > _HEAD_LENGTH]
    points.append(_back(path, _HEAD_LENGTH - 4))
    return "M" + " L".join(f"{x:.1f} {y:.1f}" for x, y in points)


def _back(path: Path, length: float) -> Point:
    """The point at which the rest of a curve is so long, as the crow flies."""
    (x, y), at = path[-1], len(path) - 1
    while at > 0 and math.hypot(path[at][0] - x, path[at][1] - y) < length:
        at -= 1
    there = math.hypot(path[at][0] - x, path[at][1] - y) or 1.0
    return x + (path[at][0] - x) * length / there, y + (path[at][1] - y) * length / there


def _head(path: Path) -> str:
    """A triangle at the end of a curve."""
    (x, y), (base_x, base_y) = path[-1], _back(path, _HEAD_LENGTH)
    dx, dy = (base_x - x) * _HEAD_SPREAD, (base_y - y) * _HEAD_SPREAD
    corners = [(x, y), (base_x - dy, base_y + dx), (base_x + dy, base_y - dx)]
    return "M" + " L".join(f"{cx:.1f} {cy:.1f}" for cx, cy in corners) + " Z"


def _badge(machine: StateMachine, arrow: Arrow, number: int, x: float, y: float) -> Iterator[str]:
    """The number of an arrow, on it and in the list."""
    strong, _ = _colour(machine, arrow.source)
    yield (
        f'<circle class="badge" cx="{x:.1f}" cy="{y:.1f}" r="{BADGE / 2:.0f}" fill="{_PAPER}" '
        f'stroke="{strong}" stroke-width="1.5"/>'
    )
    yield (
        f'<text x="{x:.1f}" y="{y + 4:.1f}" text-anchor="middle" font-size="11.5" '
        f'font-weight="700" fill="{_INK}">{number}</text>'
    )


def _label(machine: StateMachine, arrow: Arrow, number: int) -> Iterator[str]:
    box = arrow.label
    yield _rectangle("paper", box, _PAPER, "none", 0, 6)
    bar = Box(box.x - box.width / 2, box.y, 3, box.height - 4)
    yield _rectangle("bar", bar, _colour(machine, arrow.source)[0], "none", 0, 1.5)
    x, y = box.x - box.width / 2 + 10, box.y - box.height / 2 + 4
    if heading := heading_lines(machine, arrow):
        yield from _badge(machine, arrow, number, x + 12, y + LINE_HEIGHT)
        for row in heading:
            y += LINE_HEIGHT
            yield _row(x + 28, y, f'font-weight="700" fill="{_INK}"', row)
        y += 6
    for at, rows in zip(arrow.transitions, arrow.lines, strict=True):
        transition = machine.transitions[at]
        rules = " ".join(map(str, transition.rules))
        yield f'<g class="transition" data-transition="{at}" data-rules="{rules}">'
        yield f"<title>{escape(machine.describe(transition))}</title>"
        for line, row in enumerate(rows):
            y += LINE_HEIGHT
            yield _row(x, y, _LINE_STYLES[min(line, 2)], row)
        yield "</g>"
        y += 5


def _row(x: float, y: float, style: str, text: str) -> str:
    """A line of a label; y is its lower edge."""
    return (
        f'<text x="{x:.1f}" y="{y - 4:.1f}" font-size="{LABEL_SIZE}" {style}>{escape(text)}</text>'
    )
