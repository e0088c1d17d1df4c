"""Scenarios: everything that distinguishes one swarm experiment from another, as data."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass
from functools import cache
from pathlib import Path
from typing import Any

from geswarm.rules.findings import Finding, Place, unknown_name
from geswarm.rules.model import CONTROL_STEP
from geswarm.sim.arena.checks import Problem
from geswarm.sim.arena.model import Arena, normalised
from geswarm.sim.bodies import BODIES, FOOT_BOT, Body
from geswarm.sim.scenario import file as scenario_file
from geswarm.sim.scenario import yaml_form as scenario_yaml
from geswarm.sim.scenario.checks import (
    OF_THE_ARENA,
    PARAMETERS,
    ScenarioError,
    number_problems,
    problems,
    written,
)
from geswarm.sim.scenario.objective import Objective

__all__ = [
    "Scenario",
    "ScenarioError",
    "load_scenario",
    "parse_scenario",
    "scenario_about",
    "scenario_names",
]


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """One experiment; x points east, y north.

    Attributes:
        name: What it is called; the name of its file without `.yaml`.
        robots: Number of robots N.
        objects: Number of objects that always lie in the area called source; 0 for none.
        duration: Length of a run (s).
        arena: Where it takes place.
        zone_miss: Probability that a robot perceives no area in a control step.
        grip_reach: Distance from the robot's centre within which it can grip an object (m).
        object_range: Distance from the robot's centre at which it sees an object (m).
        object_margin: Objects do not appear nearer to a wall than this, nor out of reach (m).
        random_walk: Shortest and longest time for which a random heading is kept (s).
        max_speed: Highest speed of a wheel (m/s).
        turn_gain: Turning speed per angle to the target (1/s).
        proximity_range: Distance from the body's edge at which a wall is sensed (m).
        rab_range: Distance between centres at which another robot is sensed (m).
        avoidance_gain: Weight of the avoidance vector.
        avoidance_range: Distance between centres at which robots keep away from each other (m);
            None for `rab_range`.
        body: The kind of robot, `foot-bot` or `e-puck`.
        evaluations: By how many runs evolution judges where its preset says one: more where runs
            are short, or differ much.
        preconditions: Names of the percepts on offer.
        behaviours: Names of the behaviours on offer.
        registers: Names of the internal states on offer.
        initial_behaviour: What robots do at the start; the first behaviour if it is not given.
        measures: What is counted in a run.
        objective: What a run is worth.
        probabilities: Values of p on offer, ascending.
        reference: Name of the hand-written rule set to compare with; empty for none.
        terms: A Python file with terms of one's own.
        numbers: Further numbers that such terms name.

    Raises:
        ScenarioError: Something is out of range; lists all of it.
    """

    name: str
    robots: int
    objects: int = 0
    duration: float
    arena: Arena
    zone_miss: float = 0.0
    grip_reach: float = 0.12
    object_range: float = 0.5
    object_margin: float = 0.10
    random_walk: tuple[float, float] = (5.0, 15.0)
    max_speed: float = 0.10
    turn_gain: float = 2.0
    proximity_range: float = 0.10
    rab_range: float = 0.5
    avoidance_gain: float = 1.0
    avoidance_range: float | None = None
    body: str = FOOT_BOT.name
    evaluations: int = 1
    preconditions: tuple[str, ...]
    behaviours: tuple[str, ...]
    registers: tuple[str, ...] = ()
    initial_behaviour: str = ""
    measures: tuple[str, ...]
    objective: Objective
    probabilities: tuple[float, ...] = (0.001, 0.005, 0.01, 0.025, 0.05, 0.075, 0.1, 1.0)
    reference: str = ""
    terms: Path | None = None
    numbers: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        values = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        findings = [
            Finding(Place(source=str(self.name), element=written(keys[0])), message)
            for keys, message in problems(values)
        ]
        if findings:
            raise ScenarioError(findings)
        for key, value in values.items():
            object.__setattr__(self, key, _plain(key, value))
        if not self.initial_behaviour:
            object.__setattr__(self, "initial_behaviour", self.behaviours[0])

    @property
    def steps(self) -> int:
        """Number of control steps of a run."""
        return round(self.duration / CONTROL_STEP)

    @property
    def robot(self) -> Body:
        """What its robots are."""
        return BODIES[self.body]

    @property
    def width(self) -> float:
        """Extent of the arena from west to east, around the origin (m)."""
        return 2.0 * self.arena.half_width

    @property
    def length(self) -> float:
        """Extent of the arena from south to north, around the origin (m)."""
        return 2.0 * self.arena.half_length

    @property
    def nest(self) -> float:
        """Depth of the nest, if it is a band in the south (m); else 0."""
        band = self.arena.zone("nest")
        return band.depth if band else 0.0

    @property
    def source(self) -> float:
        """Depth of the source, if it is a band in the north (m); else 0."""
        band = self.arena.zone("source")
        return band.depth if band else 0.0

    @property
    def light(self) -> float:
        """Distance of the only light from the northern side, if it is beyond that (m); else 0."""
        return self.arena.far_light.y if self.arena.far_light else 0.0

    def with_changes(self, **changes: Any) -> Scenario:
        """The same scenario with some attributes changed.

        Args:
            changes: Fields, or `width`, `length`, `nest`, `source` or `light` (m) of an arena that
                is a rectangle, or has such a band, or such a light.

        Raises:
            ScenarioError: An attribute does not exist or a value is out of range.
        """
        known = [field.name for field in dataclasses.fields(self)] + list(OF_THE_ARENA)
        wrong = [
            Finding(Place(source=self.name), unknown_name("parameter", key, known).lower())
            for key in changes
            if key not in known
        ] or [
            Finding(Place(source=self.name, element=written(keys[0])), message)
            for keys, message in number_problems(changes)
        ]
        if wrong:
            raise ScenarioError(wrong)
        arena = changes.pop("arena", self.arena)
        for key in OF_THE_ARENA:
            if key in changes and isinstance(arena, Arena):
                try:
                    arena = arena.with_number(key, changes.pop(key))
                except ValueError as error:
                    place = Place(source=self.name, element=written(key))
                    raise ScenarioError([Finding(place, str(error))]) from error
        return dataclasses.replace(self, arena=arena, **changes)

    def to_yaml(self) -> str:
        """A scenario file with every parameter; the name is that of the file it is saved to."""
        return scenario_yaml.format_scenario(self, short=self._is_foraging)

    @property
    def _is_foraging(self) -> bool:
        """Whether all but its numbers is what a file inherits that says nothing."""
        numbers = {key: getattr(self, key) for key in PARAMETERS}
        try:
            return load_scenario("paper").with_changes(name=self.name, **numbers) == self
        except ScenarioError:
            return False


def _plain(key: str, value: Any) -> Any:
    """A value that was found right, in the type of its field."""
    if key == "arena":
        return normalised(value)
    if key == "numbers":
        return tuple((name, float(number)) for name, number in value)
    if key in ("random_walk", "probabilities"):
        return tuple(float(number) for number in value)
    if key == "avoidance_range":
        return None if value is None else float(value)
    if key in PARAMETERS:
        return PARAMETERS[key].kind(value)
    return tuple(value) if isinstance(value, list) else value


@cache
def _defaults() -> dict[str, Any]:
    fields = dataclasses.fields(Scenario)
    return {field.name: field.default for field in fields if field.default is not MISSING}


def scenario_names() -> list[str]:
    """Names of the scenarios that come with GESwarm, `paper` first."""
    return list(scenario_file.built_in_names())


def scenario_about(name: str) -> str:
    """What a scenario that comes with GESwarm is about: the comment that its file begins with."""
    return scenario_file.about(name)


def load_scenario(name_or_path: str | Path) -> Scenario:
    """Load a scenario that comes with GESwarm, or a scenario file.

    A file gives what differs from the scenario that it `extends`, a name or a path relative to the
    file; without `extends` it gives what differs from `paper`. One that extends `nothing` gives
    all that has no default.

    Args:
        name_or_path: A name such as `paper`, or a path to a YAML file.

    Raises:
        ScenarioError: It does not exist or is wrong; lists everything, with file and line.
    """
    name = str(name_or_path)
    return _built_in(name) if name in scenario_file.built_in_names() else _read(name)


@cache
def _built_in(name: str) -> Scenario:
    """One that comes with GESwarm; commands ask for the same ones again and again."""
    return _read(name)


def _read(name_or_path: str) -> Scenario:
    name, values = scenario_file.read(name_or_path, _defaults(), _term_problems)
    return Scenario(name=name, **values)


def parse_scenario(text: str, name: str = "scenario", folder: Path | None = None) -> Scenario:
    """A scenario from the text of a scenario file.

    Args:
        text: What the file would hold.
        name: What the scenario is called.
        folder: Where the text lies, if it is that of a trusted file: paths are relative to it, and
            terms of one's own may be named, which are code. None for a text from anywhere else,
            where they are refused, and paths are relative to the working directory.

    Raises:
        ScenarioError: The text is wrong; lists everything, with line.
    """
    fields = scenario_file.parse(text, name, _defaults(), _term_problems, folder)
    return Scenario(name=name, **fields)


def _term_problems(fields: Mapping[str, Any]) -> Iterator[Problem]:
    """What the library of terms finds wrong with the fields of a scenario, right otherwise."""
    from geswarm.sim.library.term_checks import term_problems  # the library is made of scenarios

    return term_problems(Scenario(name="scenario", **fields))
