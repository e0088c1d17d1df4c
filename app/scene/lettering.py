"""Words painted on the floor: stroke letters as flat meshes, so that no font has to be loaded."""

from __future__ import annotations

import math

from .shapes import Mesh, Point, line, merged

_ADVANCE = 0.92
"""From one letter to the next, in letter heights."""

_STROKE_WIDTH = 0.13


def _arc(x: float, y: float, rx: float, ry: float, start: float, end: float) -> tuple[Point, ...]:
    """Points of an elliptic arc; angles in degrees, counter-clockwise from east."""
    steps = max(2, round(abs(end - start) / 18))
    angles = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return tuple((x + rx * math.cos(a), y + ry * math.sin(a)) for a in angles)


# Strokes of each letter in a box 0.6 wide and 1 high.
_STROKES: dict[str, tuple[tuple[Point, ...], ...]] = {
    " ": (),
    "1": (((0.12, 0.8), (0.34, 1), (0.34, 0)),),
    "C": (_arc(0.32, 0.5, 0.32, 0.5, 48, 312),),
    "E": (((0.56, 1), (0, 1), (0, 0), (0.56, 0)), ((0, 0.52), (0.46, 0.52))),
    "m": (
        ((0, 0), (0, 0.62)),
        (*_arc(0.15, 0.47, 0.15, 0.15, 180, 0), (0.3, 0)),
        (*_arc(0.45, 0.47, 0.15, 0.15, 180, 0), (0.6, 0)),
    ),
    "N": (((0, 0), (0, 1), (0.6, 0), (0.6, 1)),),
    "O": (_arc(0.32, 0.5, 0.32, 0.5, 0, 360),),
    "R": (
        ((0, 0), (0, 1), (0.3, 1), *_arc(0.3, 0.74, 0.28, 0.26, 90, -90), (0, 0.48)),
        ((0.3, 0.48), (0.6, 0)),
    ),
    "S": ((*_arc(0.3, 0.745, 0.28, 0.255, 35, 270), *_arc(0.3, 0.245, 0.29, 0.245, 90, -145)),),
    "T": (((-0.02, 1), (0.62, 1)), ((0.3, 1), (0.3, 0))),
    "U": (((0, 1), (0, 0.3), *_arc(0.3, 0.3, 0.3, 0.3, 180, 360), (0.6, 1)),),
}


def text_width(text: str, height: float) -> float:
    """Width of `text`, metres."""
    return (len(text) * _ADVANCE - (_ADVANCE - 0.6)) * height


def painted(text: str, height: float) -> Mesh:
    """The letters of `text` at z = 0, readable from the south, centred on the origin.

    Args:
        text: Of the characters C E N O R S T U, 1, m and space.
        height: Of a letter, metres.
    """
    left = -text_width(text, height) / 2
    strokes = [
        [(left + height * (place * _ADVANCE + x), height * (y - 0.5)) for x, y in stroke]
        for place, letter in enumerate(text)
        for stroke in _STROKES[letter]
    ]
    return merged([line(stroke, _STROKE_WIDTH * height) for stroke in strokes])
