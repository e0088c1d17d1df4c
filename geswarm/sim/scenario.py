"""Scenarios: arena, zones, robots, objects, sensing, duration (paper, sections 3.1.1 and 3.2.2)."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from geswarm.rules.findings import Finding, Place, unknown_name
from geswarm.rules.model import CONTROL_STEP, clean_line
from geswarm.sim import scenario_file
from geswarm.sim.scenario_checks import PARAMETERS, ScenarioError, problems, written

__all__ = ["Scenario", "ScenarioError", "load_scenario", "parse_scenario", "scenario_names"]


@dataclass(frozen=True)
class Scenario:
    """One foraging experiment; x points east, y north, the origin is the centre of the arena.

    Attributes:
        name: What it is called; the name of its file without `.yaml`.
        robots: Number of robots N.
        objects: Number of objects that always lie at the source.
        duration: Length of a run (s).
        width: Extent of the arena from west to east (m).
        length: Extent of the arena from south to north (m).
        nest: Depth of the nest, a band along the south wall (m).
        source: Depth of the source, a band along the north wall (m).
        light: Distance of the light from the north wall, northwards (m).
        zone_miss: Probability that a robot perceives neither zone in a control step.
        grip_reach: Distance from the robot's centre within which it can grip an object (m).
        object_margin: Objects do not appear nearer to a wall than this, nor out of reach (m).
        random_walk: Shortest and longest time for which a random heading is kept (s).
        max_speed: Highest speed of a wheel (m/s).
        turn_gain: Turning speed per angle to the target (1/s).
        proximity_range: Distance from the body's edge at which a wall is sensed (m).
        rab_range: Distance between centres at which another robot is sensed (m).
        avoidance_gain: Weight of the avoidance vector.

    Raises:
        ScenarioError: Something is out of range; lists all of it.
    """

    name: str
    robots: int
    objects: int
    duration: float
    width: float
    length: float
    nest: float
    source: float
    light: float
    zone_miss: float
    grip_reach: float
    object_margin: float
    random_walk: tuple[float, float]
    max_speed: float
    turn_gain: float
    proximity_range: float
    rab_range: float
    avoidance_gain: float

    def __post_init__(self) -> None:
        values = {key: getattr(self, key) for key in PARAMETERS}
        findings = [
            Finding(Place(source=str(self.name), element=written(keys[0])), message)
            for keys, message in problems(values)
        ]
        if findings:
            raise ScenarioError(findings)
        for key, value in values.items():
            if key == "random_walk":
                object.__setattr__(self, key, (float(value[0]), float(value[1])))
            else:
                object.__setattr__(self, key, PARAMETERS[key].kind(value))

    @property
    def steps(self) -> int:
        """Number of control steps of a run."""
        return round(self.duration / CONTROL_STEP)

    def with_changes(self, **changes: Any) -> Scenario:
        """The same scenario with some attributes changed.

        Raises:
            ScenarioError: An attribute does not exist or a value is out of range.
        """
        known = [field.name for field in dataclasses.fields(self)]
        unknown = [
            Finding(Place(source=self.name), unknown_name("parameter", key, known).lower())
            for key in changes
            if key not in known
        ]
        if unknown:
            raise ScenarioError(unknown)
        return dataclasses.replace(self, **changes)

    def to_yaml(self) -> str:
        """A scenario file with every parameter; the name is that of the file it is saved to."""
        tree: dict[str, Any] = {}
        for key in PARAMETERS:
            value = getattr(self, key)
            if key in ("width", "length"):
                tree.setdefault("arena", {})[key] = value
            else:
                tree[key] = list(value) if key == "random_walk" else value
        return f"# {clean_line(self.name)}\n" + yaml.safe_dump(
            tree, sort_keys=False, default_flow_style=None
        )


def scenario_names() -> list[str]:
    """Names of the scenarios that come with GESwarm, `paper` first."""
    return scenario_file.built_in_names()


def load_scenario(name_or_path: str | Path) -> Scenario:
    """Load a scenario that comes with GESwarm, or a scenario file.

    A file gives what differs from the scenario that it `extends`, a name or a path relative to the
    file; without `extends` it gives what differs from `paper`.

    Args:
        name_or_path: A name such as `paper`, or a path to a YAML file.

    Raises:
        ScenarioError: It does not exist or is wrong; lists everything, with file and line.
    """
    name, values = scenario_file.read(str(name_or_path))
    return Scenario(name=name, **values)


def parse_scenario(text: str, name: str = "scenario") -> Scenario:
    """A scenario from the text of a scenario file; paths are relative to the working directory.

    Raises:
        ScenarioError: The text is wrong; lists everything, with line.
    """
    return Scenario(name=name, **scenario_file.parse(text, name))
