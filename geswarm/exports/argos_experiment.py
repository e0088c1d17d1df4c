"""The experiment that belongs to a controller script: a scenario as an ARGoS 3 configuration.

ARGoS takes the colours of the floor from a picture, which is written beside the configuration.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

from geswarm.sim import CONTROL_STEP, Scenario, footbot

_WALL, _WALL_HEIGHT, _SKY = 0.1, 0.1, 2.0  # m
_PIXELS_PER_METRE = 100
_STEPS_PER_SECOND = round(1 / CONTROL_STEP)
_STEEPNESS = 2.0
"""Height of the light per distance: steep enough that neither walls nor robots cast shadows."""
_BRIGHTNESS = 10.0
"""Intensity of the light per distance: ARGoS' sensors see nothing beyond 2.5 intensities."""
_WHITE, _GREY, _BLACK = 255, 128, 0


def format_argos_experiment(scenario: Scenario, script: str, floor: str, seed: int = 1) -> str:
    """The configuration (XML).

    Args:
        scenario: Arena, zones, robots.
        script: Where ARGoS finds the controller script.
        floor: Where ARGoS finds the picture of the floor.
        seed: ARGoS' random seed; 0 would mean another one every time.
    """
    return "\n".join(_lines(scenario, script, floor, seed)) + "\n"


def format_floor(scenario: Scenario) -> str:
    """The picture of the floor (PPM, one column): nest white, source black, all else grey."""
    extent = scenario.length + 2 * _WALL
    rows = max(1, round(extent * _PIXELS_PER_METRE))
    pixels = []
    for row in range(rows):  # from the north, which is up
        north = (row + 0.5) * extent / rows - _WALL
        if north < scenario.source:
            shade = _BLACK
        else:
            shade = _WHITE if north > scenario.length - scenario.nest else _GREY
        pixels.append(f"{shade} {shade} {shade}")
    return "\n".join([f"P3\n1 {rows}\n255", *pixels]) + "\n"


def _lines(scenario: Scenario, script: str, floor: str, seed: int) -> Iterator[str]:
    yield '<?xml version="1.0" ?>'
    yield "<!-- Run in this directory: argos3 -c followed by the name of this file. -->"
    yield "<argos-configuration>"
    yield "  <!-- Objects are virtual: loop functions of your own, named here, set HAS_OBJECT"
    yield "       and read WANT_OBJECT and DROP_OBJECT of every robot's script. -->"
    yield "  <framework>"
    yield '    <system threads="0" />'
    yield (
        f'    <experiment length="{_metres(scenario.duration)}" '
        f'ticks_per_second="{_STEPS_PER_SECOND}" random_seed="{seed}" />'
    )
    yield "  </framework>"
    yield from _controller(script)
    yield from _arena(scenario, floor)
    grid = ",".join(str(max(1, math.floor(extent))) for extent in _arena_size(scenario))
    yield "  <physics_engines>"
    yield '    <dynamics2d id="dyn2d" />'
    yield "  </physics_engines>"
    yield "  <media>"
    yield f'    <range_and_bearing id="rab" check_occlusions="false" grid_size="{grid}" />'
    yield f'    <led id="leds" grid_size="{grid}" />'
    yield "  </media>"
    yield "</argos-configuration>"


def _controller(script: str) -> Iterator[str]:
    yield "  <controllers>"
    yield '    <lua_controller id="rules">'
    yield "      <actuators>"
    yield '        <differential_steering implementation="default" />'
    yield '        <range_and_bearing implementation="default" />'
    yield "      </actuators>"
    yield "      <sensors>"
    yield '        <footbot_light implementation="rot_z_only" show_rays="false" />'
    yield '        <footbot_proximity implementation="default" show_rays="false" />'
    yield '        <footbot_motor_ground implementation="rot_z_only" />'
    yield '        <range_and_bearing implementation="medium" medium="rab" />'
    yield "      </sensors>"
    yield f"      <params script={quoteattr(script)} />"
    yield "    </lua_controller>"
    yield "  </controllers>"


def _arena_size(scenario: Scenario) -> tuple[float, float, float]:
    return scenario.width + 2 * _WALL, scenario.length + 2 * _WALL, _SKY


def _arena(scenario: Scenario, floor: str) -> Iterator[str]:
    east, north = scenario.width / 2, scenario.length / 2
    size = _vector(*_arena_size(scenario))
    yield f'  <arena size="{size}" center="{_vector(0, 0, _SKY / 2 - 0.5)}">'
    yield f'    <floor id="floor" source="image" path={quoteattr(floor)} />'
    for side, x, y, across, along in (
        ("west", -east - _WALL / 2, 0.0, _WALL, scenario.length + 2 * _WALL),
        ("east", east + _WALL / 2, 0.0, _WALL, scenario.length + 2 * _WALL),
        ("south", 0.0, -north - _WALL / 2, scenario.width, _WALL),
        ("north", 0.0, north + _WALL / 2, scenario.width, _WALL),
    ):
        yield (
            f'    <box id="wall_{side}" size="{_vector(across, along, _WALL_HEIGHT)}" '
            'movable="false">'
        )
        yield f'      <body position="{_vector(x, y, 0)}" orientation="0,0,0" />'
        yield "    </box>"
    distance = scenario.light + scenario.length
    height, brightness = _STEEPNESS * distance, _BRIGHTNESS * distance
    yield "    <!-- Black for cameras, bright for light sensors: it stands outside the arena. -->"
    yield (
        f'    <light id="light" position="{_vector(0, north + scenario.light, height)}" '
        f'orientation="0,0,0" color="black" intensity="{_metres(brightness)}" medium="leds" />'
    )
    yield from _robots(scenario, east, north)
    yield "  </arena>"


def _robots(scenario: Scenario, east: float, north: float) -> Iterator[str]:
    """In the nest, as far from its walls as a body needs."""
    south_west = _vector(-east + footbot.RADIUS, -north + footbot.RADIUS, 0)
    end = min(-north + scenario.nest, north - footbot.RADIUS)
    yield "    <distribute>"
    yield (
        f'      <position method="uniform" min="{south_west}" '
        f'max="{_vector(east - footbot.RADIUS, end, 0)}" />'
    )
    yield '      <orientation method="uniform" min="0,0,0" max="360,0,0" />'
    yield f'      <entity quantity="{scenario.robots}" max_trials="200">'
    yield f'        <foot-bot id="robot" rab_range="{_metres(scenario.rab_range)}">'
    yield '          <controller config="rules" />'
    yield "        </foot-bot>"
    yield "      </entity>"
    yield "    </distribute>"


def _vector(*values: float) -> str:
    return ",".join(map(_metres, values))


def _metres(value: float) -> str:
    """A length to the micrometre, without an exponent and without idle zeros."""
    return f"{value:.6f}".rstrip("0").rstrip(".")
