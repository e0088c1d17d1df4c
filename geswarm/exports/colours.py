"""Colours of behaviours: the same in pictures, in the arena and in the rule table."""

from __future__ import annotations

from typing import TypeAlias

from geswarm.rules.vocabulary import Vocabulary

Colour: TypeAlias = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

BEHAVIOURS: tuple[Colour, ...] = (
    (250, 166, 10),  # PHOTOTAXIS: amber, to the light
    (31, 99, 222),  # ANTI-PHOTOTAXIS: blue, away from it
    (34, 178, 120),  # RANDOM_WALK: green
    (195, 150, 255),  # STOP: lilac
    (135, 75, 45),  # ATTRACTION: brown
    (105, 255, 135),  # REPULSION: bright green
    (120, 0, 255),  # violet
    (240, 45, 0),  # red
    (255, 180, 240),  # pale pink
    (165, 30, 90),  # crimson
    (135, 165, 75),  # olive
    (180, 240, 195),  # mint
)
"""LED colours of behaviours, told apart by the colour-blind too."""

_WITH_OWN_COLOUR = (
    "PHOTOTAXIS",
    "ANTI-PHOTOTAXIS",
    "RANDOM_WALK",
    "STOP",
    "ATTRACTION",
    "REPULSION",
)


def behaviour_colours(vocabulary: Vocabulary) -> tuple[Colour, ...]:
    """LED colour of each behaviour; those of the library have the same one in all scenarios.

    Others take the colours that are left; beyond the palette it begins again.
    """
    names = vocabulary.behaviour_names
    places = [*_WITH_OWN_COLOUR, *(name for name in names if name not in _WITH_OWN_COLOUR)]
    return tuple(BEHAVIOURS[places.index(name) % len(BEHAVIOURS)] for name in names)


def tint(colour: Colour) -> str:
    """A pale ground for it, as CSS writes it."""
    r, g, b = (round(c + 0.85 * (255 - c)) for c in colour)
    return css((r, g, b))


def css(colour: Colour) -> str:
    """The colour as CSS writes it, for example `#faa60a`."""
    return "#{:02x}{:02x}{:02x}".format(*colour)
