"""The colours that the arena and the rule table share."""

from __future__ import annotations

from geswarm.exports.colours import BEHAVIOURS, Colour, behaviour_colours, css

__all__ = ["BEHAVIOURS", "Colour", "behaviour_colours", "css"]

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

FLOOR: Colour = (232, 233, 234)
"""Of a floor of one colour: pale, so that robots and objects stand out."""

FLOORS: dict[str, Colour] = {
    "grey": (172, 175, 182),
    "black": (34, 36, 42),
    "white": (250, 250, 250),
    "red": (206, 88, 78),
    "green": (112, 176, 112),
    "blue": (98, 134, 206),
    "yellow": (236, 208, 96),
}
"""How the colours of a floor are shown that robots tell apart."""

AREAS: dict[str, Colour] = {"nest": (186, 196, 226), "source": (230, 212, 184)}
OTHER_AREAS: tuple[Colour, ...] = (
    (192, 220, 194),
    (226, 196, 212),
    (188, 218, 224),
    (224, 222, 180),
    (210, 200, 228),
    (226, 204, 192),
)
"""Tints of areas that are not painted: pale like the floor."""


def between(one: Colour, other: Colour, part: float) -> Colour:
    """The colour a part of the way from one to another."""
    r, g, b = (round(a + part * (c - a)) for a, c in zip(one, other, strict=True))
    return r, g, b


def on_ground(ground: Colour) -> Colour:
    """Of words on a ground: of its hue, darker on a pale one and paler on a dark one."""
    mean = sum(ground) / 3
    if mean < 130.0:
        return between(ground, (255, 255, 255), 0.42)
    darker = 0.8 if mean < 240.0 else 0.72
    r, g, b = (max(0, min(255, round(darker * (mean + 1.9 * (c - mean))))) for c in ground)
    return r, g, b


def linear(colour: Colour) -> Colour:
    """The colour as linear light, which is what viser's batches take (its meshes take sRGB)."""
    r, g, b = (
        round(255 * (c / 3294.6 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4)) for c in colour
    )
    return r, g, b
