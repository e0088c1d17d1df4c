"""Rule sets in numbers: which readings a rule accepts, what its actions do.

This is the one place that knows how the words of the rule language become readings, instances of
behaviours and registers of the simulator.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import Action, BehaviourChange, Precondition, RuleSet, StateChange, Term
from geswarm.rules.names import require_known_names
from geswarm.sim.assembly.records import ACTION, CHANCE, RULE, Records
from geswarm.sim.kernels.table import ROW_BEHAVIOURS, ByChance, Encoded
from geswarm.sim.terms.component import Register
from geswarm.sim.terms.parts import MOST_VALUES, Parts

Chances: TypeAlias = npt.NDArray[np.float64]
Change: TypeAlias = tuple[int, int, int, int, int]
"""Bits to clear, bits to set; added to the counter, its least and greatest value then."""
_NO_CHANGE: Change = (0, 0, 0, 0, 7)


@dataclass(frozen=True)
class Instances:
    """The behaviours of a rule set: a behaviour with other arguments is another one.

    Attributes:
        terms: As rules write them, in the order of their numbers.
        parts: What the scenario is composed of.
    """

    terms: tuple[Term, ...]
    parts: Parts

    @classmethod
    def of(cls, rule_set: RuleSet, parts: Parts, before: Iterable[Term] = ()) -> Instances:
        """Those that a scenario has without arguments, those before, those that actions start.

        Raises:
            RuleSetError: They are too many.
        """
        started: list[Term] = []
        for rule in rule_set.rules if parts.arguments else ():
            for action in rule.actions:
                started += action.behaviours
        terms = tuple(dict.fromkeys((*parts.plain_behaviours, *before, *started)))
        if len(terms) > ROW_BEHAVIOURS:
            raise RuleSetError(
                [
                    Finding(
                        Place(source=rule_set.name),
                        f"expected at most {ROW_BEHAVIOURS} behaviours, each other argument "
                        f"counting as another one, got {len(terms)}",
                    )
                ]
            )
        return cls(terms, parts)

    def number(self, term: Term) -> int:
        """The number of a behaviour."""
        return self.terms.index(term)

    @property
    def kinds(self) -> list[int]:
        """Position of each one's behaviour in the vocabulary."""
        return [self.parts.kinds[term.name] for term in self.terms]

    @property
    def arguments(self) -> npt.NDArray[np.float32]:
        """The arguments of each, float32, shape (instances, most arguments)."""
        rows = np.zeros((len(self.terms), self.parts.arguments), dtype=np.float32)
        for at, term in enumerate(self.terms):
            word = self.parts.behaviours[self.parts.kinds[term.name]].word
            for k, (argument, value) in enumerate(zip(word.arguments, term.arguments, strict=True)):
                rows[at, k] = argument.number(value)
        return rows

    @property
    def restarting(self) -> int:
        """Mask of those that start something afresh when they are changed to."""
        behaviours = self.parts.behaviours
        return sum(
            1 << at for at, kind in enumerate(self.kinds) if behaviours[kind].start is not None
        )

    def mask(self, behaviours: Iterable[Term]) -> int:
        """Those in which a rule may be active; none means any.

        What no action starts is left out: no robot ever executes it.
        """
        wanted = set(behaviours)
        return sum(1 << at for at, term in enumerate(self.terms) if not wanted or term in wanted)

    def effect(self, action: Action) -> tuple[int, Change]:
        """(instance to change to or -1, change of registers)."""
        if isinstance(action, BehaviourChange):
            return self.number(action.behaviour), _NO_CHANGE
        assert isinstance(action, StateChange)
        return -1, change_of(action, self.parts)


def change_of(action: StateChange, parts: Parts) -> Change:
    """What an action on a register does to its bits, or to the counter."""
    (register,) = (each for each in parts.registers if each.word.name == action.state)
    if not register.word.counts:
        mask = parts.mask(register)
        position = register.word.values.index(action.value)
        return mask, position << parts.shifts[register.name], 0, 0, 7
    value, most = int(action.value), register.values - 1
    if action.operation == "=":
        return 0, 0, 0, value, value
    return 0, 0, value if action.operation == "+=" else -value, 0, most


@lru_cache(maxsize=4096)
def accepted(precondition: Precondition, parts: Parts) -> tuple[int, int]:
    """(position of the sensor, the readings for which the precondition can hold, as bits)."""
    percept = parts.percepts_by_name[precondition.percept.name]
    holding = (
        reading
        for reading in range(percept.sensor.values)
        if parts.vocabulary.chance(precondition, percept.value(reading)) > 0.0
    )
    return parts.sensors.index(percept.sensor), sum(1 << reading for reading in holding)


@lru_cache(maxsize=4096)
def _accepted_by(preconditions: tuple[Precondition, ...], parts: Parts) -> tuple[int, ...]:
    """The readings of each sensor for which all preconditions can hold, as bits."""
    masks = [(1 << sensor.values) - 1 for sensor in parts.sensors]
    for precondition in preconditions:
        position, values = accepted(precondition, parts)
        masks[position] &= values
    return tuple(masks)


@lru_cache(maxsize=4096)
def _holding(preconditions: tuple[Precondition, ...], parts: Parts) -> Chances | None:
    """How probably each value of each sensor meets what holds by chance; None if nothing does.

    Returns:
        float64, shape (sensors, 64), read-only.
    """
    drawn = [each for each in preconditions if parts.vocabulary.is_drawn(each)]
    if not drawn:
        return None
    holding = np.ones((len(parts.sensors), MOST_VALUES))
    for precondition in drawn:
        percept = parts.percepts_by_name[precondition.percept.name]
        for reading in range(percept.sensor.values):
            chance = parts.vocabulary.chance(precondition, percept.value(reading))
            holding[parts.sensors.index(percept.sensor), reading] *= chance
    holding.setflags(write=False)
    return holding


def _flags(parts: Parts) -> list[Register]:
    return [register for register in parts.registers if not register.word.counts]


def _known(parts: Parts) -> tuple[list[int], list[int]]:
    """For each bit of the registers the reading that tells it, see `Encoded`, and its bit."""
    readings, shifts = [], []
    for register in _flags(parts):
        for bit in range(register.bits):
            if register.seen_by is not None:
                readings.append(parts.sensors.index(register.seen_by))
            else:
                fixed = -2 - (register.initially >> bit & 1)
                readings.append(fixed if register.momentary else -1)
            shifts.append(bit)
    return readings, shifts


def encode(
    rule_sets: Sequence[RuleSet],
    instances: Sequence[Instances],
    fails: Sequence[float],
    parts: Parts,
) -> tuple[Encoded, ByChance | None]:
    """Enabled rules of rule sets in numbers, and by which chances they may act if any does.

    Args:
        rule_sets: What to encode.
        instances: The behaviours of each.
        fails: With which probability each sensor reads 0 instead of what it should.
        parts: What the scenario is composed of.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    rule_ends, accepts, masks, action_ends = [], [], [], []
    rows: list[int] = []
    holding: list[Chances] = []
    chances, targets, changes = [], [], []
    for rule_set, own in zip(rule_sets, instances, strict=True):
        for rule in rule_set.rules:
            if not rule.enabled:
                continue
            accepts.append(_accepted_by(rule.preconditions, parts))
            own_chances = _holding(rule.preconditions, parts) if parts.drawn_sensors else None
            rows.append(-1 if own_chances is None else len(holding))
            holding += [] if own_chances is None else [own_chances]
            masks.append(own.mask(rule.behaviours))
            for action in rule.actions:
                target, change = own.effect(action)
                chances.append(action.p)
                targets.append(target)
                changes.append(change)
            action_ends.append(len(chances))
        rule_ends.append(len(masks))
    by_chance = None
    if parts.drawn_sensors:
        table = np.array(holding).reshape(-1, len(parts.sensors), MOST_VALUES)
        by_chance = ByChance(np.array(rows, dtype=np.int64), table)
    return encoded(
        parts,
        fails,
        rule_ends=rule_ends,
        instances=[len(own.terms) for own in instances],
        restarting=[own.restarting for own in instances],
        accepted=np.array(accepts, dtype=np.uint64).reshape(-1, len(parts.sensors)),
        behaviours=masks,
        action_ends=action_ends,
        chances=np.array(chances, dtype=np.float64),
        targets=targets,
        changes=np.array(changes, dtype=np.int64).reshape(-1, 5),
    ), by_chance


def encoded(parts: Parts, fails: Sequence[float], **rules: Any) -> Encoded:
    """Rules in numbers with what the scenario adds, as the kernel takes them."""
    known, known_shift = _known(parts)
    rest = {
        "values": [sensor.values for sensor in parts.sensors],
        "fails": np.array(fails, dtype=np.float64),
        "known": known,
        "known_shift": known_shift,
    }
    arrays = {
        name: value if isinstance(value, np.ndarray) else np.array(value, dtype=np.int64)
        for name, value in (rest | rules).items()
    }
    return Encoded(**arrays)


def chance(p: float) -> tuple[int, int]:
    """(threshold, possible): random bits up to the threshold have probability p, if possible."""
    return max(0, math.ceil(p * 2.0**32) - 1), int(p > 0.0)


def chances(fails: Sequence[float], parts: Parts) -> Records:
    """The sensors that may fail, as random bits decide it; of CHANCE."""
    failing = [p for p, sensor in zip(fails, parts.sensors, strict=True) if sensor.fails]
    return np.array([chance(p) for p in failing], dtype=CHANCE)


def chances_to_interpret(rule_set: RuleSet, parts: Parts) -> npt.NDArray[np.uint32]:
    """By which readings rules act by chance: random bits up to these thresholds let them.

    Args:
        rule_set: The rules; their names must be known.
        parts: What the scenario is composed of.

    Returns:
        Shape (rules, sensors on which percepts depend by chance, 64).
    """
    shape = (len(rule_set.rules), len(parts.drawn_sensors), MOST_VALUES)
    thresholds = np.full(shape, 0xFFFFFFFF, dtype=np.uint32)
    for number, rule in enumerate(rule_set.rules):
        holding = _holding(rule.preconditions, parts)
        for place, sensor in enumerate(parts.drawn_sensors if holding is not None else ()):
            assert holding is not None
            row = holding[parts.sensors.index(sensor)]
            thresholds[number, place] = [chance(p)[0] for p in row.tolist()]
    return thresholds


def rules_to_interpret(
    rule_set: RuleSet, own: Instances
) -> tuple[Records, npt.NDArray[np.uint64], Records]:
    """Rules, what they accept of each reading, actions; nothing fired yet.

    Rules that are switched off are there, too: indices are positions in the rule set.

    Args:
        rule_set: The rules.
        own: Their behaviours.

    Returns:
        Of RULE; uint64, shape (rules, sensors); of ACTION.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    parts = own.parts
    require_known_names(rule_set, parts.vocabulary)
    all_actions = [action for rule in rule_set.rules for action in rule.actions]
    rules = np.zeros(len(rule_set.rules), dtype=RULE)
    actions = np.zeros(len(all_actions), dtype=ACTION)
    accepts = np.zeros((len(rules), len(parts.sensors)), dtype=np.uint64)
    end = 0
    for number, rule in enumerate(rule_set.rules):
        first, end = end, end + len(rule.actions)
        accepts[number] = _accepted_by(rule.preconditions, parts)
        rules[number] = (0, rule.enabled, own.mask(rule.behaviours), first, end)
    for number, action in enumerate(all_actions):
        target, changes = own.effect(action)
        restarts = target >= 0 and own.restarting >> target & 1
        actions[number] = (0, *chance(action.p), target, *changes, restarts)
    return rules, accepts, actions
