"""Words that lie on the floor, as flat meshes, in the font that Pillow brings along."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from .shapes import Mesh

Runs = npt.NDArray[np.float64]
"""Where a row of a picture is inked: from and to, shape (runs, 2), pixels."""

_CAPITAL = 64
"""Height of a capital in the picture that a mesh is made of, pixels."""

_ABOVE = 0.5  # room above and below capitals for tails and accents, by their height
_BOLD = 1  # pixels around each stroke


def text_width(text: str, height: float) -> float:
    """Width of `text`, metres."""
    return float(np.ptp(_vertices(text)[..., 0])) * height


def painted(text: str, height: float) -> Mesh:
    """The letters of `text` at z = 0, readable from the south, centred on the origin.

    Args:
        text: One line of what the font has: letters without accents, digits, signs.
        height: Of a capital, metres.
    """
    corners = _vertices(text)
    first = 4 * np.arange(len(corners))[:, None]
    faces = np.concatenate([first + np.array(half) for half in ((0, 1, 2), (0, 2, 3))])
    upright = np.zeros((corners.size // 2, 3), dtype=np.float32)
    upright[:, :2] = height * corners.reshape(-1, 2)
    return Mesh(upright, faces.astype(np.uint32))


@cache
def _vertices(text: str) -> npt.NDArray[np.float64]:
    """Quadrilaterals that make up a text whose capitals are 1 high, shape (n, 4, 2)."""
    font, top, base = _font()
    above = round(_ABOVE * _CAPITAL)
    size = round(font.getlength(text)) + 2 * _CAPITAL, round(base - top) + 2 * above
    picture = Image.new("L", size)
    pen = ImageDraw.Draw(picture)
    pen.text((_CAPITAL, above - top), text, fill=255, font=font, stroke_width=_BOLD)
    rows = [_runs(row) for row in np.asarray(picture) / 255.0]
    quads = [_between(*two, -float(y)) for y, two in enumerate(pairwise(rows))]
    corners = np.concatenate(quads)
    middle = (corners[..., 0].min() + corners[..., 0].max()) / 2.0
    found: npt.NDArray[np.float64] = corners - np.array((middle, (1 - size[1]) / 2.0))
    return found / (base - top)


def _runs(row: npt.NDArray[np.float64]) -> Runs:
    """Where more than half of a row's pixels is covered, to a part of a pixel."""
    at = np.nonzero(np.diff(row >= 0.5))[0]
    return (at + (0.5 - row[at]) / (row[at + 1] - row[at])).reshape(-1, 2)


def _between(upper: Runs, lower: Runs, y: float) -> npt.NDArray[np.float64]:
    """The ink between a row at y and the next one below it, shape (n, 4, 2).

    Runs that go on in one of the other row are joined; others end half way.
    """
    meet = (upper[:, None, 0] < lower[None, :, 1]) & (lower[None, :, 0] < upper[:, None, 1])
    one = (meet.sum(axis=1) == 1)[:, None] & (meet.sum(axis=0) == 1)[None, :]
    above, below = np.nonzero(meet & one)
    end_above, end_below = np.delete(upper, above, axis=0), np.delete(lower, below, axis=0)
    parts = (
        (upper[above], lower[below], y, y - 1.0),
        (end_above, end_above, y, y - 0.5),
        (end_below, end_below, y - 0.5, y - 1.0),
    )
    found = []
    for over, under, top, bottom in parts:
        x = np.column_stack((under, over[:, ::-1]))
        ys = np.broadcast_to((bottom, bottom, top, top), x.shape)
        found.append(np.stack((x, ys), axis=2))
    return np.concatenate(found)


@cache
def _font() -> tuple[ImageFont.FreeTypeFont, float, float]:
    """The font, and where in it the top of a capital and the line that it stands on are."""
    _, top, _, base = _sized(100.0).getbbox("H")
    font = _sized(100.0 * _CAPITAL / (base - top))
    _, top, _, base = font.getbbox("H")
    return font, top, base


def _sized(size: float) -> ImageFont.FreeTypeFont:
    font = ImageFont.load_default(size)
    assert isinstance(font, ImageFont.FreeTypeFont), "Pillow was built without FreeType"
    return font
