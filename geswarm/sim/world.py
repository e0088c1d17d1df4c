"""The interactive world: one simulation that can be watched, dragged about and given new rules."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP, RuleSet, Term, Value
from geswarm.rules.names import require_known_names
from geswarm.rules.space import Space
from geswarm.rules.vocabulary import Vocabulary
from geswarm.sim.arena.places import is_in_area, nearest_free, nearest_in_source
from geswarm.sim.batch import fitness_of
from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.program import (
    Instances,
    chances,
    chances_to_interpret,
    rules_to_interpret,
)
from geswarm.sim.controllers.spaces import (
    behaviours_of,
    counted_in,
    sensed_values,
    state_values,
    states_of_bits,
)
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import Scenario
from geswarm.sim.swarm import Swarm

NEEDS_RESET = ("robots", "objects", "width", "length", "nest", "source")
"""Parameters of a scenario that a run cannot go on with if they change."""
_MOST_COUNTED = 4_000_000
"""Situations times outcomes up to which decisions are counted."""


def can_go_on(before: Scenario, after: Scenario) -> bool:
    """Whether a run in one scenario can go on in another one: only numbers of robots differ."""
    return (
        (before.robots, before.objects) == (after.robots, after.objects)
        and replace(before.arena, lights=()) == replace(after.arena, lights=())
        and parts_of(before) is parts_of(after)
    )


@dataclass(frozen=True)
class WorldState:
    """What there is to see at one moment; read-only copies, shape (robots,) unless said otherwise.

    Attributes:
        x: Eastward positions of the robots' centres (m), float64.
        y: Northward positions (m), float64.
        theta: Orientations, counter-clockwise from east (rad), in [-pi, pi], float64.
        behaviour: Positions of the behaviours in the vocabulary, uint8.
        instance: Positions in `behaviours`, uint8.
        internal_states: Internal states as bits, int64; see `World.internal_states`.
        percepts: Readings of the last control step as one number, int64, see `World.perceived`; of
            a robot that has been put somewhere since, the areas and the object there.
        carried: Whether the robot holds an object, bool.
        last_rule: Index of the rule that fired last, -1 if none has since the rules were set.
        objects: Positions of the objects (m), float64, shape (objects, 2).
        rule_counts: How often each rule has fired since the rules were set, int64, shape (rules,).
        action_counts: The same for each action of each rule.
        steps: Control steps since the start.
        behaviours: What robots execute, with arguments.
        measures: What the scenario measures, counted since the start, by name.
        fitness: Value of the objective, so far.
    """

    x: npt.NDArray[np.float64]
    y: npt.NDArray[np.float64]
    theta: npt.NDArray[np.float64]
    behaviour: npt.NDArray[np.uint8]
    instance: npt.NDArray[np.uint8]
    internal_states: npt.NDArray[np.int64]
    percepts: npt.NDArray[np.int64]
    carried: npt.NDArray[np.bool_]
    last_rule: npt.NDArray[np.int64]
    objects: npt.NDArray[np.float64]
    rule_counts: npt.NDArray[np.int64]
    action_counts: tuple[tuple[int, ...], ...]
    steps: int
    behaviours: tuple[Term, ...]
    measures: Mapping[str, float]
    fitness: float

    @property
    def time(self) -> float:
        """Simulated time since the start (s)."""
        return self.steps * CONTROL_STEP


class World:
    """One simulation whose robots interpret the rules one by one, so that it knows which fired.

    A rule fires in a control step if it is active and at least one of its actions is drawn. Rule
    indices are positions in the rule set, counting rules that are switched off. Not thread-safe.
    """

    def __init__(self, scenario: Scenario, rule_set: RuleSet, seed: int = 0) -> None:
        """Place robots and objects.

        Raises:
            RuleSetError: The rule set cannot be run.
            ValueError: The seed is out of range.
        """
        self._seed = seed
        self._instances: Instances | None = None
        self._enter(scenario)
        self.set_rules(rule_set)
        self.reset(seed)

    def _enter(self, scenario: Scenario) -> None:
        """Make room for a scenario."""
        self._scenario = scenario
        self._swarm = Swarm(scenario, rules=True)
        self._parts = self._swarm.parts
        self._misses = chances(fails(scenario, self._parts), self._parts)
        self._measures = tuple(each.name for each in self._parts.measures)

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self._scenario

    @property
    def rule_set(self) -> RuleSet:
        """The rules that the robots run."""
        return self._rule_set

    @property
    def seed(self) -> int:
        """The seed of the present run."""
        return self._seed

    @property
    def steps(self) -> int:
        """Control steps since the start."""
        return self._swarm.steps

    @property
    def time(self) -> float:
        """Simulated time since the start (s)."""
        return self.steps * CONTROL_STEP

    @property
    def vocabulary(self) -> Vocabulary:
        """What the rules may mention."""
        return self._parts.vocabulary

    @property
    def measures(self) -> dict[str, float]:
        """What the scenario measures, counted since the start, by name."""
        return {name: self._swarm.measured(name) for name in self._measures}

    @property
    def fitness(self) -> float:
        """Value of the objective, so far."""
        return fitness_of(self._scenario, self.measures).item()

    @property
    def decisions(self) -> npt.NDArray[np.int64]:
        """How often robots came from each situation to each outcome since the rules were set.

        What `ControlTable.probabilities` says of them, counted; read-only, shape (situations,
        outcomes), numbered by `geswarm.rules.Space.of` the vocabulary and the rules. All 0 where
        there are too many to be counted.
        """
        space = Space.of(self.vocabulary, self._rule_set)
        counted = counted_in(space, self._decisions, self._own.terms, self._parts)
        counted.setflags(write=False)
        return counted

    def numbers_in(self, space: Space) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """The robots' behaviours and internal states as a space numbers them, -1 for others."""
        behaviours = behaviours_of(self._own.terms, space)[self._swarm.of_robots("behaviour")]
        return behaviours, states_of_bits(self._parts, space)[self._swarm.of_robots("state")]

    def perceived(self, percepts: int) -> dict[str, Value]:
        """What `WorldState.percepts` says of one robot: the value of each reading, by name."""
        return sensed_values(self._parts, percepts)

    def internal_states(self, states: int) -> dict[str, Value]:
        """What `WorldState.internal_states` says of one robot: values by name."""
        return state_values(self._parts, states)

    @property
    def state(self) -> WorldState:
        """Everything there is to see, as it is now."""
        swarm = self._swarm
        of_robots = swarm.of_robots
        reach_x = self._scenario.arena.half_width - self._scenario.robot.radius
        reach_y = self._scenario.arena.half_length - self._scenario.robot.radius
        instance = of_robots("behaviour")
        measures = self.measures
        return WorldState(
            x=_frozen(_inside(of_robots("x"), -reach_x, reach_x)),
            y=_frozen(_inside(of_robots("y"), -reach_y, reach_y)),
            theta=_frozen(np.arctan2(of_robots("sin"), of_robots("cos"), dtype=np.float64)),
            behaviour=_frozen(self._kinds[instance].astype(np.uint8)),
            instance=_frozen(instance.astype(np.uint8)),
            internal_states=_frozen(of_robots("state").astype(np.int64)),
            percepts=_frozen(of_robots("percepts").astype(np.int64)),
            carried=_frozen(self._carried() != 0),
            last_rule=_frozen(of_robots("last_rule").astype(np.int64)),
            objects=_frozen(self._swarm.objects.astype(np.float64)),
            rule_counts=_frozen(self._rules["fired"]),
            action_counts=tuple(
                tuple(self._actions["fired"][first:end].tolist())
                for first, end in self._rules[["first_action", "end_action"]].tolist()
            ),
            steps=self.steps,
            behaviours=self._own.terms,
            measures=measures,
            fitness=fitness_of(self._scenario, measures).item(),
        )

    def step(self, n: int = 1) -> None:
        """Run n control steps of 0.1 s.

        Raises:
            ValueError: n is negative.
        """
        if n < 0:
            raise ValueError(f"n: expected at least 0, got {n}")
        rules = (self._rules, self._accepted, self._actions, self._misses)
        instances = (self._kinds, self._arguments) if self._parts.arguments else ()
        holding = (self._holding,) if self._parts.drawn_sensors else ()
        self._swarm.run((*rules, self._decisions.reshape(-1), *holding, *instances), n)

    def set_rules(self, rule_set: RuleSet) -> None:
        """Give all robots new rules from the next step on; only what has fired is forgotten.

        Raises:
            RuleSetError: The rule set cannot be run; the world keeps its rules.
        """
        require_known_names(rule_set, self.vocabulary)
        now = self._swarm.blocks["behaviour"]
        in_use = () if self._instances is None else self._in_use()
        own = Instances.of(rule_set, self._parts, in_use)
        self._rules, self._accepted, self._actions = rules_to_interpret(rule_set, own)
        self._holding = chances_to_interpret(rule_set, self._parts)
        if self._instances is not None and own.terms != self._instances.terms:
            numbers = [own.terms.index(t) if t in own.terms else 0 for t in self._instances.terms]
            now[:] = np.array(numbers, dtype=now.dtype)[now]
        self._rule_set, self._instances = rule_set, own
        self._kinds = np.array(own.kinds, dtype=np.int32)
        self._arguments = own.arguments
        self._decisions = np.zeros(self._counted, dtype=np.int64)
        self._swarm.blocks["last_rule"] = -1

    @property
    def _own(self) -> Instances:
        assert self._instances is not None
        return self._instances

    def _in_use(self) -> tuple[Term, ...]:
        """The behaviours that robots execute now: they go on with them under other rules."""
        used = np.unique(self._swarm.of_robots("behaviour"))
        return tuple(self._own.terms[at] for at in used.tolist())

    @property
    def _counted(self) -> tuple[int, ...]:
        """Shape in which decisions are counted, see `spaces.counted_in`."""
        parts = self._parts
        starts = (parts.most_instances, parts.states)
        shape = (parts.sensed_codes, *starts, *starts, 2)
        return shape if math.prod(shape) <= _MOST_COUNTED else (0, *starts, *starts, 2)

    def set_scenario(self, scenario: Scenario) -> bool:
        """Go on in another scenario from the next step on, or start again in it.

        The run goes on as it is if robots, objects, arena and terms are the same: a random heading
        is kept for its old time, and objects stay where they lie. Otherwise it starts again with
        the same seed.

        Returns:
            True if the run goes on.

        Raises:
            RuleSetError: The rules cannot be run there; the world stays as it is.
        """
        goes_on = can_go_on(self._scenario, scenario)
        before = self._swarm
        parts = parts_of(scenario)
        if parts is not self._parts:
            require_known_names(self._rule_set, parts.vocabulary)
            Instances.of(self._rule_set, parts)
        self._enter(scenario)
        if goes_on:
            self._swarm.go_on_as(before)
        else:
            self._instances = None
            self.set_rules(self._rule_set)
            self.reset()
        return goes_on

    def reset(self, seed: int | None = None) -> None:
        """Start again, with the same seed unless another one is given.

        Raises:
            ValueError: The seed is out of range.
        """
        seed = self._seed if seed is None else seed
        if not 0 <= seed < 2**63:
            raise ValueError(f"seed: expected 0 <= seed < 2**63, got {seed}")
        self._seed = seed
        self._rules["fired"] = 0
        self._actions["fired"] = 0
        self._decisions[:] = 0
        self._swarm.start(seed)
        self._swarm.blocks["last_rule"] = -1
        self._show_percepts(slice(None))

    def move_robot(self, i: int, x: float, y: float) -> None:
        """Put robot i at (x, y) (m), or at the nearest place inside the walls.

        If that is on top of another robot, both are pushed apart in the next step.

        Raises:
            IndexError: There is no such robot.
            ValueError: A coordinate is not finite.
        """
        _require_place(i, self._scenario.robots, "robot", x, y)
        arena, robot = self._scenario.arena, slice(i, i + 1)
        radius = self._scenario.robot.radius
        now = self._swarm.of_robots("x")[i].item(), self._swarm.of_robots("y")[i].item()
        self._swarm.place_robot(i, *nearest_free(arena, (x, y), now, radius))
        self._show_percepts(robot)

    def move_object(self, i: int, x: float, y: float) -> None:
        """Put object i at (x, y) (m), or at the nearest place where objects may lie in the source.

        Raises:
            IndexError: There is no such object.
            ValueError: A coordinate is not finite.
        """
        _require_place(i, self._scenario.objects, "object", x, y)
        self._swarm.objects[i] = nearest_in_source(self._scenario, (x, y))

    def _carried(self) -> npt.NDArray[Any]:
        """Whether each robot holds an object; nobody does where there are none."""
        if "carried" not in self._parts.own_fields:
            return np.zeros(self._scenario.robots, dtype=np.int32)
        return self._swarm.of_robots("carried")

    def _show_percepts(self, which: slice) -> None:
        """What robots perceive of the floor and of what they hold where they have just been put.

        For the eye only: they sense for themselves at the beginning of the next step.
        """
        x, y = (self._swarm.of_robots(name)[which] for name in ("x", "y"))
        arena, sensed, size = self._scenario.arena, self._swarm.of_robots("percepts")[which], 1
        for sensor in self._parts.sensors:
            reading = sensed // size % sensor.values
            if sensor.name == "areas":
                reading_now = sum(
                    is_in_area(arena, name, x, y).astype(np.int32) << bit
                    for bit, name in enumerate(arena.areas)
                )
            elif sensor.name == "has_object":
                reading_now = (self._carried()[which] != 0).astype(np.int32)
            else:
                reading_now = reading
            if size < self._parts.sensed_codes:
                sensed = sensed + (reading_now - reading) * size
            size *= sensor.values
        self._swarm.put("percepts", which, sensed)


def _inside(places: npt.NDArray[np.float32], low: float, high: float) -> npt.NDArray[np.float64]:
    """What was rounded beyond the walls is inside."""
    return np.clip(places.astype(np.float64), low, high)


def _frozen(array: np.ndarray[tuple[int, ...], np.dtype[np.generic]]) -> np.ndarray:
    """A read-only copy."""
    copy = array.copy()
    copy.setflags(write=False)
    return copy


def _require_place(i: int, number: int, kind: str, x: float, y: float) -> None:
    if not 0 <= i < number:
        raise IndexError(f"expected {kind} 0 to {number - 1}, got {i}")
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(f"expected finite coordinates, got ({x}, {y})")
