"""The interactive world: one simulation that can be watched, dragged about and given new rules."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geswarm.rules.model import CONTROL_STEP, RuleSet
from geswarm.rules.space import Space
from geswarm.rules.vocabulary import FORAGING
from geswarm.sim import footbot
from geswarm.sim.encoding import encode_scenario, fails
from geswarm.sim.program import chances, rules_to_interpret
from geswarm.sim.scenario import Scenario
from geswarm.sim.swarm import Swarm

NEEDS_RESET = ("robots", "objects", "width", "length", "nest", "source")
"""Parameters of a scenario that a run cannot go on with if they change."""


def can_go_on(before: Scenario, after: Scenario) -> bool:
    """Whether a run in one scenario can go on in another one."""
    return all(getattr(before, name) == getattr(after, name) for name in NEEDS_RESET)


_SPACE = Space.of(FORAGING)


@dataclass(frozen=True)
class WorldState:
    """What there is to see at one moment; read-only copies, shape (robots,) unless said otherwise.

    Bits and codes are positions in `geswarm.rules.vocabulary.FORAGING`.

    Attributes:
        x: Eastward positions of the robots' centres (m), float64.
        y: Northward positions (m), float64.
        theta: Orientations, counter-clockwise from east (rad), in [-pi, pi], float64.
        behaviour: Behaviour codes, uint8.
        internal_states: Internal states as bits, uint8.
        percepts: Percepts of the last control step as bits, uint8; of a robot that has been put
            somewhere since, what there is to perceive there.
        carried: Whether the robot holds an object, bool.
        last_rule: Index of the rule that fired last, -1 if none has since the rules were set.
        objects: Positions of the objects (m), float64, shape (objects, 2).
        rule_counts: How often each rule has fired since the rules were set, int64, shape (rules,).
        action_counts: The same for each action of each rule.
        steps: Control steps since the start.
        picked: Objects picked up since the start.
        collected: Objects dropped inside the nest.
        lost: Objects dropped elsewhere.
    """

    x: npt.NDArray[np.float64]
    y: npt.NDArray[np.float64]
    theta: npt.NDArray[np.float64]
    behaviour: npt.NDArray[np.uint8]
    internal_states: npt.NDArray[np.uint8]
    percepts: npt.NDArray[np.uint8]
    carried: npt.NDArray[np.bool_]
    last_rule: npt.NDArray[np.int64]
    objects: npt.NDArray[np.float64]
    rule_counts: npt.NDArray[np.int64]
    action_counts: tuple[tuple[int, ...], ...]
    steps: int
    picked: int
    collected: int
    lost: int

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
        self._scenario = scenario
        self._physics = encode_scenario(scenario)
        self._misses = chances(fails(scenario))
        self._swarm = Swarm(scenario, rules=True)
        self._seed = seed
        self.set_rules(rule_set)
        self.reset(seed)

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
    def picked(self) -> int:
        """Objects picked up since the start."""
        return int(self._swarm.measured("picked"))

    @property
    def collected(self) -> int:
        """Objects dropped inside the nest since the start."""
        return int(self._swarm.measured("collected"))

    @property
    def lost(self) -> int:
        """Objects dropped outside the nest since the start."""
        return int(self._swarm.measured("lost"))

    @property
    def decisions(self) -> npt.NDArray[np.int64]:
        """How often robots came from each situation to each outcome since the rules were set.

        What `ControlTable.probabilities` says of them, counted; a read-only copy, shape
        (situations, outcomes), numbered by `geswarm.rules.Space`.
        """
        return _frozen(self._decisions)

    @property
    def state(self) -> WorldState:
        """Everything there is to see, as it is now."""
        swarm = self._swarm
        of_robots = swarm.of_robots
        reach_x, reach_y = self._reach(footbot.RADIUS)
        return WorldState(
            x=_frozen(_inside(of_robots("x"), -reach_x, reach_x)),
            y=_frozen(_inside(of_robots("y"), -reach_y, reach_y)),
            theta=_frozen(np.arctan2(of_robots("sin"), of_robots("cos"), dtype=np.float64)),
            behaviour=_frozen(of_robots("behaviour").astype(np.uint8)),
            internal_states=_frozen(of_robots("state").astype(np.uint8)),
            percepts=_frozen(of_robots("percepts").astype(np.uint8)),
            carried=_frozen(of_robots("carried").astype(np.bool_)),
            last_rule=_frozen(of_robots("last_rule").astype(np.int64)),
            objects=_frozen(self._object_places()),
            rule_counts=_frozen(self._rules["fired"]),
            action_counts=tuple(
                tuple(self._actions["fired"][first:end].tolist())
                for first, end in self._rules[["first_action", "end_action"]].tolist()
            ),
            steps=self.steps,
            picked=self.picked,
            collected=self.collected,
            lost=self.lost,
        )

    def step(self, n: int = 1) -> None:
        """Run n control steps of 0.1 s.

        Raises:
            ValueError: n is negative.
        """
        if n < 0:
            raise ValueError(f"n: expected at least 0, got {n}")
        rules = (
            self._rules,
            self._accepted,
            self._actions,
            self._misses,
            self._decisions.reshape(-1),
        )
        self._swarm.run(rules, n)

    def set_rules(self, rule_set: RuleSet) -> None:
        """Give all robots new rules from the next step on; only what has fired is forgotten.

        Raises:
            RuleSetError: The rule set cannot be run; the world keeps its rules.
        """
        self._rules, self._accepted, self._actions = rules_to_interpret(rule_set)
        self._rule_set = rule_set
        self._decisions = np.zeros((_SPACE.situations, _SPACE.outcomes), dtype=np.int64)
        self._swarm.blocks["last_rule"] = -1

    def set_scenario(self, scenario: Scenario) -> bool:
        """Go on in another scenario from the next step on, or start again in it.

        The run goes on as it is if robots, objects, arena and zones are the same: a random heading
        is kept for its old time, and objects stay where they lie. Otherwise it starts again with
        the same seed.

        Returns:
            True if the run goes on.
        """
        goes_on = can_go_on(self._scenario, scenario)
        before = self._swarm
        self._scenario = scenario
        self._physics = encode_scenario(scenario)
        self._misses = chances(fails(scenario))
        self._swarm = Swarm(scenario, rules=True)
        if goes_on:
            self._swarm.go_on_as(before)
        else:
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
        reach_x, reach_y = self._reach(footbot.RADIUS)
        self._swarm.place_robot(i, min(max(x, -reach_x), reach_x), min(max(y, -reach_y), reach_y))
        self._show_percepts(slice(i, i + 1))

    def move_object(self, i: int, x: float, y: float) -> None:
        """Put object i at (x, y) (m), or at the nearest place where objects may lie in the source.

        Raises:
            IndexError: There is no such object.
            ValueError: A coordinate is not finite.
        """
        _require_place(i, self._scenario.objects, "object", x, y)
        low, high = self._where_objects_lie()
        self._swarm.objects[i] = np.clip((x, y), low, high)

    def _show_percepts(self, which: slice) -> None:
        """What robots perceive where they have just been put, should they notice the zones.

        For the eye only: they sense for themselves at the beginning of the next step.
        """
        y = self._swarm.of_robots("y")[which]
        carried = self._swarm.of_robots("carried")[which] != 0
        bits = FORAGING.precondition_index
        sensed = np.where(y < self._physics.nest_edge, 1 << bits["ON_NEST"], 0)
        sensed |= np.where(y > self._physics.source_edge, 1 << bits["ON_SOURCE"], 0)
        sensed |= np.where(carried, 1 << bits["HAS_OBJECT"], 0)
        self._swarm.put("percepts", which, sensed)

    def _reach(self, margin: float) -> tuple[float, float]:
        """How far from the centre something may be, eastwards and northwards."""
        return self._physics.half_width - margin, self._physics.half_length - margin

    def _where_objects_lie(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """South-western and north-eastern corner."""
        reach_x, north = self._reach(self._physics.object_margin)
        return (-reach_x, self._physics.source_edge), (reach_x, north)

    def _object_places(self) -> npt.NDArray[np.float64]:
        return np.clip(self._swarm.objects.astype(np.float64), *self._where_objects_lie())


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
