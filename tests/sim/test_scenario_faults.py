"""What is wrong in a scenario file is told with its place."""

import pytest

from tests.sim.scenario_texts import PLAIN, messages, why_not


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{circle: 0}", "arena: circle: expected more than 0 and at most 10000 m, got 0"),
        ("{circle: wide}", "arena: circle: expected a number, got the text 'wide'"),
        ("{cirle: 1, circle: 2}", "unknown key arena: 'cirle'; did you mean circle?"),
        ("{circle: 1, rectangle: [1, 1]}", "arena: rectangle: expected one outline, there is circ"),
        ("{circle: 1, width: 1}", "arena: width: expected one outline, there is circle already"),
        ("{rectangle: 3}", "arena: rectangle: expected two numbers [width, length]"),
        ("{rectangle: [3, 0.1]}", "arena: rectangle: expected more than 0.17"),
        ("{length: 3}", "arena: length: expected both a width and a length"),
        ("{floor: grey}", "extends: expected an arena with an outline, such as"),
        ("{regular: {corners: 2, side: 1}}", "arena: regular: corners: expected at least 3"),
        ("{regular: {corners: 5}}", "arena: regular: expected one of side, radius, apothem"),
        ("{regular: {side: 1}}", "arena: regular: expected corners, too"),
        ("{regular: {corners: 5, sides: 1}}", "unknown key arena: regular: 'sides'; did you mean"),
        ("{polygon: [[0, 0], [1, 1]]}", "arena: polygon: expected 3 to 64 corners, got 2"),
        ("{polygon: [[0, 0], [1, 1], [2, x]]}", "arena: polygon: corner 3: expected a number"),
        ("{polygon: [[0, 0], [1, 1], [1]]}", "arena: polygon: corner 3: expected a place [x, y]"),
        ("{polygon: [[0, 0], [2, 2], [2, 0], [0, 2]]}", "arena: polygon: expected sides that do"),
        ("{polygon: [[0, 0], [1, 1], [2, 2]]}", "arena: polygon: expected sides that do not"),
        ("{polygon: [[0, 0], [0, 0], [2, 2], [2, 0]]}", "arena: polygon: expected sides that"),
        ("{circle: 1, floor: pink}", "arena: floor: expected grey, black, white, red, green, blue"),
        ("{circle: 1, obstacles: 1}", "arena: obstacles: expected a list of obstacles, got 1"),
        ("{circle: 1, obstacles: [{}]}", "arena: obstacles 1: expected one of box, disc, got none"),
        ("{circle: 1, obstacles: [1]}", "arena: obstacles 1: expected {box: ..., disc: ...}, got"),
        ("{circle: 1, obstacles: [{dsc: 1}]}", "unknown key arena: obstacles 1: 'dsc'; did you"),
        (
            "{circle: 1, obstacles: [{disc: {at: [0, 0]}}]}",
            "arena: obstacles 1: disc: expected rad",
        ),
        (
            "{circle: 1, obstacles: [{disc: {at: [5, 0], radius: 1}}]}",
            "arena: obstacles 1: lies outside the arena",
        ),
        (
            "{circle: 1, walls: [{from: [0, 0], to: [0, 0], thickness: 1}]}",
            "arena: walls 1: expected ends that are not at the same place",
        ),
        (
            "{circle: 1, walls: [{from: [5, 0], to: [6, 0], thickness: 1}]}",
            "arena: walls 1: lies outside the arena",
        ),
        (
            "{circle: 1, obstacles: [" + "{disc: {at: [0, 0], radius: 0.1}}, " * 65 + "]}",
            "arena: obstacles: expected at most 64 obstacles, got 65",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 0], radius: 1}}]}",
            "arena: patches 1: expected a f",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 0], radius: 1}, area: No-1}]}",
            "arena: patches 1: area: expected a name of lower-case letters",
        ),
        (
            "{circle: 1, patches: [{disc: {at: [0, 9], radius: 1}, area: a}]}",
            "arena: patches 1: lies outside the arena",
        ),
        (
            "{circle: 1, patches: [{band: {side: up, depth: 1}, area: a}]}",
            "arena: patches 1: band: side: expected south, north, west or east, got the text 'up'",
        ),
        (
            "{circle: 1, patches: ["
            + "".join(f"{{band: {{side: west, depth: 1}}, area: a{n}}}, " for n in range(7))
            + "]}",
            "arena: patches: expected at most 6 areas, got 7",
        ),
        ("{circle: 1, lights: [{at: [0, 0], beyond: 3}]}", "arena: lights 1: expected either at"),
        ("{circle: 1, lights: [{at: [0]}]}", "arena: lights 1: at: expected a place [x, y], got a"),
        ("{circle: 1, lights: [{beyond: -1}]}", "arena: lights 1: expected at least 0 and"),
        (
            "{circle: 1, lights: [{at: [0, 0], intensity: 0}]}",
            "arena: lights 1: intensity: expected more than 0",
        ),
        ("{circle: 1, start: {area: home}}", "arena: start: expected an area of one patch, home"),
        (
            "{circle: 1, start: {disc: {at: [3, 3], radius: 1}}}",
            "arena: start: lies outside the arena",
        ),
        ("{circle: 0.1}", "robots: 3 do not fit where they start, which has room for about 1"),
        (
            "{circle: 1, obstacles: [{box: {at: [0, 0], size: [3, 3]}}]}",
            "robots: 3 do not fit where they start, which has room for about 0",
        ),
    ],
)
def test_wrong_arenas(text, expected):
    assert why_not(text).removeprefix("extends: nothing").startswith(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("preconditions: [on_nest]", "preconditions 1: expected a name of capitals"),
        ("preconditions: 4", "preconditions: expected a list of names, got 4"),
        ("preconditions: [A, B, A]", "preconditions 3: A is given twice"),
        ("behaviours: []", "behaviours: expected 1 to 64 names, got 0"),
        ("behaviours: [STOP]", "behaviours: expected one of STOP, got 'RANDOM_WALK'"),
        ("initial_behaviour: HOP", "initial_behaviour: expected one of PHOTOTAXIS, ANTI-PHOTO"),
        ("initial_behaviour:", "initial_behaviour: expected a"),
        ("measures: [picked]", "measures: there is no measure 'collected'; known are picked, rob"),
        ("measures: [robots]", "measures 1: expected another name, robots has a meaning already"),
        ("measures: [max]", "measures 1: expected another name, max has a meaning already"),
        ("objective: gathered", "objective: there is no measure 'gathered'; known are picked"),
        ("objective: 2", "objective: expected an expression over measures, got 2"),
        ("objective: picked +", "objective: expected an expression over measures such as"),
        ("objective: {unit: x}", "objective: expected either maximise or minimise"),
        ("objective: {maximize: lost}", "unknown key objective: 'maximize'; did you mean maximise"),
        ("objective: {minimise: lost, unit: [1]}", "objective: unit: expected a unit of at most"),
        ("probabilities: [0.5, 0.1]", "probabilities: expected ascending probabilities, got 0.1"),
        ("probabilities: [2]", "probabilities: expected more than 0 and at most 1, got 2"),
        ("probabilities: 1", "probabilities: expected a list of 1 to 64 probabilities, got 1"),
        ("reference: ../x", "reference: expected the name of a rule set, or a file (.yaml, "),
        ("numbers: [1]", "numbers: expected {name: number}, got a list"),
        ("numbers: {Gain: 1}", "numbers: Gain: expected a name of lower-case letters"),
        ("numbers: {gain: x}", "numbers: gain: gain: expected a number, got the text 'x'"),
        ("avoidance_range: 0", "avoidance_range: expected at least 1e-06"),
        ("avoidance_range:", "avoidance_range: expected a"),
        (
            "arena: {circle: 3}\nmax_speed: 0.85",
            "max_speed: expected less than 0.85 m/s, or robots",
        ),
        ("objects: 0", "objects: expected at least 1 and at most 200000, got 0"),
        ("extends: aac\nobjects: 1", "objects: objects lie in the area called source"),
        ("extends: aac\nnest: x", "nest: expected a number, got the text 'x'"),
    ],
)
def test_wrong_words(text, expected):
    shown = [message.split(": ", 1)[1] for message in messages(text)]
    assert any(message.startswith(expected) for message in shown), shown
    assert all(len(message) < 300 for message in shown)


def test_lines_of_what_is_wrong():
    assert messages(
        PLAIN.strip() + "\narena:\n  circle: 2\n  patches:\n    - disc: {at: [0, 0], radius: -1}\n"
        "      floor: black\n    - disc:\n        at: [0, 0]\n        radius: 1\n"
        "      floor: blak\n      aria: x\n"
    ) == [
        "mine:11: arena: patches 1: disc: radius: expected more than 0 and at most 10000 m, got -1",
        "mine:17: unknown key arena: patches 2: 'aria'; did you mean area?",
        "mine:16: arena: patches 2: floor: expected grey, black, white, red, green, blue or "
        "yellow, got the text 'blak'",
    ]
