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
"""LED colour of each behaviour code, told apart by the colour-blind too."""

POPULATION: tuple[Colour, ...] = (
    (109, 32, 119),  # purple
    (232, 68, 42),  # red
    (165, 227, 227),  # pale cyan
    (107, 42, 0),  # brown
    (230, 223, 160),  # sand
)
"""Of what individuals of a population have in common; none looks like an LED or an object."""

OBJECT: Colour = (236, 40, 160)
LIGHT: Colour = (255, 214, 92)

NEST: Colour = (186, 196, 226)
SOURCE: Colour = (230, 212, 184)
FLOOR: Colour = (232, 233, 234)
"""Ground zones: pale, so that robots and objects stand out."""


def behaviour_colour(code: int) -> Colour:
    """LED colour of a behaviour code; codes beyond the palette begin it again."""
    return BEHAVIOURS[code % len(BEHAVIOURS)]


def linear(colour: Colour) -> Colour:
    """The colour as linear light, which is what viser's batches take (its meshes take sRGB)."""
    r, g, b = (
        round(255 * (c / 3294.6 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4)) for c in colour
    )
    return r, g, b


def css(colour: Colour) -> str:
    """The colour as CSS writes it, for example `#faa60a`."""
    return "#{:02x}{:02x}{:02x}".format(*colour)
