"""The colours that the arena and the rule table share."""

from __future__ import annotations

from typing import TypeAlias

Colour: TypeAlias = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

BEHAVIOURS: tuple[Colour, ...] = (
    (250, 166, 10),  # PHOTOTAXIS: amber, to the light
    (31, 99, 222),  # ANTI-PHOTOTAXIS: blue, away from it
    (34, 178, 120),  # RANDOM_WALK: green
    (140, 86, 200),
    (120, 120, 120),
)
"""LED colour of each behaviour code, told apart with any of the usual colour-vision deficiencies."""

OBJECT: Colour = (232, 48, 142)
LIGHT: Colour = (255, 214, 92)

NEST: Colour = (184, 190, 214)
SOURCE: Colour = (222, 202, 180)
FLOOR: Colour = (226, 226, 222)
"""Ground zones: pale, so that robots and objects stand out."""


def behaviour_colour(code: int) -> Colour:
    """LED colour of a behaviour code; codes beyond the palette begin it again."""
    return BEHAVIOURS[code % len(BEHAVIOURS)]


def css(colour: Colour) -> str:
    """The colour as CSS writes it, for example `#faa60a`."""
    return "#{:02x}{:02x}{:02x}".format(*colour)
