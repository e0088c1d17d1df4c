import itertools
from dataclasses import replace

import numpy as np
import pytest

from geswarm.app import palette
from geswarm.app.state.behaviours import MOST_COLOURED
from geswarm.rules.declarations import BehaviourName
from geswarm.rules.vocabulary import FORAGING
from geswarm.sim import load_scenario, scenario_names, vocabulary_of

# Machado, Oliveira and Fernandes 2009, severity 1: linear RGB as it is seen with the deficiency.
VISION = {
    "normal": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
CLEARLY_DIFFERENT = 20  # CIE76; about 2 is just noticeable


def lab(linear):
    xyz = TO_XYZ @ np.clip(linear, 0, 1) / TO_XYZ.sum(axis=1)
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def seen(colour, vision):
    scaled = np.array(colour) / 255
    linear = np.where(scaled <= 0.04045, scaled / 12.92, ((scaled + 0.055) / 1.055) ** 2.4)
    return lab(np.asarray(VISION[vision]) @ linear)


@pytest.mark.parametrize("vision", VISION)
def test_colours_are_told_apart_with_any_colour_vision(vision):
    assert len(palette.BEHAVIOURS) >= 12
    behaviours = palette.BEHAVIOURS
    for one, other in itertools.combinations([*behaviours, palette.OBJECT], 2):
        distance = np.linalg.norm(seen(one, vision) - seen(other, vision))
        assert distance > CLEARLY_DIFFERENT, (one, other)


@pytest.mark.parametrize("vision", VISION)
def test_nothing_of_a_population_can_be_taken_for_an_led(vision):
    assert len(palette.POPULATION) == MOST_COLOURED
    leds = palette.behaviour_colours(FORAGING)
    pairs = [
        *itertools.product(palette.POPULATION, [*leds, palette.OBJECT]),
        *itertools.combinations(palette.POPULATION, 2),
    ]
    for one, other in pairs:
        distance = np.linalg.norm(seen(one, vision) - seen(other, vision))
        assert distance > CLEARLY_DIFFERENT, (one, other)


def test_a_behaviour_has_the_same_colour_in_every_scenario():
    known = {}
    for scenario in map(load_scenario, scenario_names()):
        vocabulary = vocabulary_of(scenario)
        colours = palette.behaviour_colours(vocabulary)
        assert len(set(colours)) == len(colours)
        for name, colour in zip(vocabulary.behaviour_names, colours, strict=True):
            assert known.setdefault(name, colour) == colour


def test_behaviours_of_ones_own_take_the_colours_that_are_left():
    own = tuple(BehaviourName(f"OWN_{n}", "", "") for n in range(9))
    vocabulary = replace(FORAGING, behaviours=(own[0], *FORAGING.behaviours, *own[1:]))
    first, *foraging = palette.behaviour_colours(vocabulary)[:4]
    assert tuple(foraging) == palette.behaviour_colours(FORAGING)
    assert first == palette.BEHAVIOURS[6]
    assert palette.behaviour_colours(vocabulary)[-1] == palette.BEHAVIOURS[14 % 12]


def test_css():
    assert palette.css((250, 166, 10)) == "#faa60a"


def test_linear_light():
    assert palette.linear((0, 255, 10)) == (0, 255, 1)
    assert palette.linear((188, 188, 188)) == (128, 128, 128)  # half the light
