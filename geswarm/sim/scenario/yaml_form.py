"""Writing scenario files, with everything that decides how a run goes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

from geswarm.rules.model import clean_line
from geswarm.sim.arena.model import Arena, Band, Box, Disc, HalfPlane, Light, Patch, Polygon, Shape
from geswarm.sim.bodies import FOOT_BOT
from geswarm.sim.scenario import file as scenario_file
from geswarm.sim.scenario.checks import OF_THE_ARENA, PARAMETERS
from geswarm.sim.scenario.objective import Objective

if TYPE_CHECKING:
    from geswarm.sim.scenario.model import Scenario


def format_scenario(scenario: Scenario, short: bool) -> str:
    """The text of a scenario file.

    Args:
        scenario: To write.
        short: Whether only numbers tell it from the paper's.
    """
    tree = _numbers(scenario) if short else _everything(scenario)
    text = yaml.safe_dump(tree, sort_keys=False, default_flow_style=None)
    return f"# {clean_line(scenario.name)}\n{text}"


def _numbers(scenario: Scenario) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for key in PARAMETERS:
        value = getattr(scenario, key)
        if key in ("width", "length"):
            tree.setdefault("arena", {})[key] = value
        else:
            tree[key] = list(value) if key == "random_walk" else value
    return tree


def _everything(scenario: Scenario) -> dict[str, Any]:
    tree: dict[str, Any] = {"extends": scenario_file.NOTHING}
    for key in PARAMETERS:
        if key == "width":
            tree["arena"] = _arena(scenario.arena)
        elif key not in OF_THE_ARENA:
            value = getattr(scenario, key)
            tree[key] = list(value) if key == "random_walk" else value
    if scenario.avoidance_range is not None:
        tree["avoidance_range"] = scenario.avoidance_range
    if scenario.robot is not FOOT_BOT:
        tree["body"] = scenario.body
    if scenario.evaluations != 1:
        tree["evaluations"] = scenario.evaluations
    for key in ("preconditions", "behaviours", "registers", "measures", "probabilities"):
        tree[key] = list(getattr(scenario, key))
    tree["initial_behaviour"] = scenario.initial_behaviour
    tree["objective"] = _objective(scenario.objective)
    tree["reference"] = scenario.reference
    if scenario.terms is not None:
        tree["terms"] = str(scenario.terms)
    if scenario.numbers:
        tree["numbers"] = dict(scenario.numbers)
    return tree


def _objective(objective: Objective) -> dict[str, Any]:
    tree = {"maximise" if objective.maximise else "minimise": objective.expression}
    return {**tree, "unit": objective.unit} if objective.unit else tree


def _arena(arena: Arena) -> dict[str, Any]:
    tree: dict[str, Any]
    if isinstance(arena.outline, Box):
        tree = {"width": arena.outline.width, "length": arena.outline.length}
    elif isinstance(arena.outline, Disc):
        tree = {"circle": arena.outline.radius}
    else:
        tree = _shape(arena.outline)
    tree["floor"] = arena.floor
    for key, parts in (
        ("obstacles", [_shape(each) for each in arena.obstacles]),
        ("patches", [_patch(each) for each in arena.patches]),
        ("lights", [_light(each) for each in arena.lights]),
    ):
        if parts:
            tree[key] = parts
    if arena.start is not None:
        tree["start"] = _start(arena, arena.start)
    return tree


def _start(arena: Arena, start: Shape) -> dict[str, Any]:
    """The region of start, by the name of the area that it is if there is one."""
    for name in arena.areas:
        if [patch.shape for patch in arena.patches if patch.area == name] == [start]:
            return {"area": name}
    return _shape(start)


def _shape(shape: Shape) -> dict[str, Any]:
    if isinstance(shape, Disc):
        return {"disc": {"at": [shape.x, shape.y], "radius": shape.radius}}
    if isinstance(shape, Box):
        box: dict[str, Any] = {"at": [shape.x, shape.y], "size": [shape.width, shape.length]}
        return {"box": {**box, "angle": shape.angle} if shape.angle else box}
    if isinstance(shape, Polygon):
        return {"polygon": [list(point) for point in shape.points]}
    if isinstance(shape, HalfPlane):
        return {"half_plane": {"side": shape.side, "at": shape.at}}
    assert isinstance(shape, Band)
    return {"band": {"side": shape.side, "depth": shape.depth}}


def _patch(patch: Patch) -> dict[str, Any]:
    tree = _shape(patch.shape)
    if patch.floor:
        tree["floor"] = patch.floor
    if patch.area:
        tree["area"] = patch.area
    return tree


def _light(light: Light) -> dict[str, Any]:
    place: dict[str, Any] = {"at": [light.x, light.y]}
    if light.beyond:
        place = {"beyond": light.y, **({"x": light.x} if light.x else {})}
    return {**place, "height": light.height, "intensity": light.intensity}
