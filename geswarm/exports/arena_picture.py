"""A plain picture of a scenario's arena, seen from above, as SVG."""

from __future__ import annotations

import html
import math
from collections.abc import Iterator

from geswarm.sim import Scenario
from geswarm.sim.arena.geometry import corners
from geswarm.sim.arena.model import Disc, Plain

_PER_METRE, _MARGIN, _LIGHT = 100.0, 0.06, 0.05
_FLOORS = {
    "grey": "#b4b4b4", "black": "#1e1e1e", "white": "#ffffff", "red": "#d2413c",
    "green": "#3ca050", "blue": "#3c6ed2", "yellow": "#f0d250",
}  # fmt: skip


def arena_picture(scenario: Scenario) -> str:
    """The arena: floor, patches, walls and obstacles, lights in yellow, where robots start dashed.

    A metre is 100 pixels, north is above.
    """
    arena = scenario.arena
    lights = [arena.place_of(light) for light in arena.lights if not light.beyond]
    half_width = max(arena.half_width, *(abs(x) + _LIGHT for x, _ in lights), 0.0) + _MARGIN
    half_length = max(arena.half_length, *(abs(y) + _LIGHT for _, y in lights), 0.0) + _MARGIN
    width, length = 2.0 * _PER_METRE * half_width, 2.0 * _PER_METRE * half_length
    box = f"{_at(-half_width)} {_at(-half_length)} {width:.1f} {length:.1f}"
    size = f'width="{width:.1f}" height="{length:.1f}"'
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {size}>',
            f"<title>{html.escape(scenario.name)}</title>",
            *_parts(scenario),
            "</svg>\n",
        ]
    )


def _parts(scenario: Scenario) -> Iterator[str]:
    arena = scenario.arena
    outline = _shape(arena.resolved(arena.outline))
    yield f'<clipPath id="inside">{outline}/></clipPath>'
    yield f'<g clip-path="url(#inside)">{outline} fill="{_FLOORS[arena.floor]}"/>'
    for patch in arena.patches:
        if patch.floor:
            yield f'{_shape(arena.resolved(patch.shape))} fill="{_FLOORS[patch.floor]}"/>'
    if arena.start is not None:
        dashed = 'fill="none" stroke="#1f63de" stroke-width="1.5" stroke-dasharray="6 4"/>'
        yield f"{_shape(arena.resolved(arena.start))} {dashed}"
    for obstacle in arena.obstacles:
        yield f'{_shape(obstacle)} fill="#6e4b28"/>'
    yield f'</g>{outline} fill="none" stroke="#6e4b28" stroke-width="4"/>'
    for light in arena.lights:
        if not light.beyond:
            x, y = arena.place_of(light)
            yield f'{_shape(Disc(x, y, _LIGHT))} fill="#faa60a" stroke="#6e4b28"/>'


def _shape(shape: Plain) -> str:
    """An element that is left open for how it looks."""
    if isinstance(shape, Disc):
        return f'<circle cx="{_at(shape.x)}" cy="{_at(-shape.y)}" r="{_at(shape.radius)}"'
    points = " ".join(f"{_at(x)},{_at(-y)}" for x, y in corners(shape).tolist())
    return f'<polygon points="{points}"'


def _at(metres: float) -> str:
    """A coordinate in pixels, no finer than is seen."""
    return f"{math.copysign(round(abs(metres) * _PER_METRE, 1), metres):.1f}"
