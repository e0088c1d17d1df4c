"""Rule sets in numbers: which readings a rule accepts, what its actions do, control tables.

This is the one place that knows how names of the rule language become readings, behaviours and
registers of the simulator.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.control_table import ControlTable
from geswarm.rules.model import Action, Precondition, RuleSet, Term
from geswarm.rules.names import require_known_names
from geswarm.rules.vocabulary import FORAGING as VOCABULARY
from geswarm.sim.assembly.records import ACTION, CHANCE, RULE, Records
from geswarm.sim.compiled import compile_tables
from geswarm.sim.kernels.table import (
    MOST_OUTCOMES,
    MOST_RULES,
    ROW_BEHAVIOURS,
    Encoded,
    Room,
    Tables,
)
from geswarm.sim.terms.foraging import FORAGING as PARTS
from geswarm.sim.terms.parts import MOST_STATE_BITS, Parts

Controller: TypeAlias = RuleSet | ControlTable
Change: TypeAlias = tuple[int, int, int, int, int]
"""Bits to clear, bits to set; added to the counter, its least and greatest value."""

_MOST_CLASSES = 1024
_NO_CHANGE: Change = (0, 0, 0, 0, 7)

_PERCEPTS: Mapping[str, tuple[str, Callable[[int], int]]] = {
    "ON_NEST": ("areas", lambda areas: areas & 1),
    "ON_SOURCE": ("areas", lambda areas: areas >> 1 & 1),
    "HAS_OBJECT": ("has_object", lambda holds: holds),
}
"""For each percept the sensor that it looks at, and for which readings it is true."""


@lru_cache(maxsize=4096)
def accepted(precondition: Precondition, parts: Parts = PARTS) -> tuple[int, int]:
    """(position of the sensor, the readings for which the precondition holds, as bits)."""
    name, test = _PERCEPTS[precondition.percept.name]
    (position,) = (at for at, each in enumerate(parts.sensors) if each.name == name)
    values = range(parts.sensors[position].values)
    holding = (value for value in values if VOCABULARY.holds(precondition, bool(test(value))))
    return position, sum(1 << value for value in holding)


@lru_cache(maxsize=4096)
def _accepted_by(preconditions: tuple[Precondition, ...], parts: Parts) -> tuple[int, ...]:
    """The readings of each sensor for which all preconditions hold, as bits."""
    masks = [(1 << sensor.values) - 1 for sensor in parts.sensors]
    for precondition in preconditions:
        position, values = accepted(precondition, parts)
        masks[position] &= values
    return tuple(masks)


@lru_cache(maxsize=4096)
def _behaviours(behaviours: tuple[Term, ...]) -> int:
    """Mask of the behaviours in which a rule may be active."""
    names = {behaviour.name for behaviour in behaviours} or VOCABULARY.behaviour_index
    return sum(1 << VOCABULARY.behaviour_index[name] for name in names)


def _effect(action: Action, parts: Parts) -> tuple[int, Change]:
    """(behaviour to change to or -1, change of registers)."""
    if not action.target:
        return VOCABULARY.behaviour_index[action.becomes], _NO_CHANGE
    bit = 1 << parts.shifts[action.target.lower()]
    return -1, (bit, bit if action.becomes == "true" else 0, 0, 0, 7)


def _restarting(parts: Parts) -> int:
    """Mask of the behaviours that start something afresh when they are changed to."""
    return sum(1 << code for code, each in enumerate(parts.behaviours) if each.start is not None)


def _known(parts: Parts) -> tuple[list[int], list[int]]:
    """For each bit of the registers the reading that tells it, see `Encoded`, and its bit."""
    readings, shifts = [], []
    for register in parts.registers:
        for bit in range(register.bits):
            if register.seen_by is not None:
                readings.append(parts.sensors.index(register.seen_by))
            else:
                fixed = -2 - (register.initially >> bit & 1)
                readings.append(fixed if register.momentary else -1)
            shifts.append(bit)
    return readings, shifts


def encode(rule_sets: Sequence[RuleSet], fails: Sequence[float], parts: Parts = PARTS) -> Encoded:
    """Enabled rules of rule sets in numbers.

    Args:
        rule_sets: What to encode.
        fails: With which probability each sensor reads 0 instead of what it should.
        parts: What the scenario is composed of.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    rule_ends, accepts, masks, action_ends = [], [], [], []
    chances, targets, changes = [], [], []
    for rule_set in rule_sets:
        require_known_names(rule_set, VOCABULARY)
        for rule in rule_set.rules:
            if not rule.enabled:
                continue
            accepts.append(_accepted_by(rule.preconditions, parts))
            masks.append(_behaviours(rule.behaviours))
            for action in rule.actions:
                target, change = _effect(action, parts)
                chances.append(action.p)
                targets.append(target)
                changes.append(change)
            action_ends.append(len(chances))
        rule_ends.append(len(masks))
    return _encoded(
        parts,
        fails,
        rule_ends=rule_ends,
        accepted=np.array(accepts, dtype=np.uint64).reshape(-1, len(parts.sensors)),
        behaviours=masks,
        action_ends=action_ends,
        chances=np.array(chances, dtype=np.float64),
        targets=targets,
        changes=np.array(changes, dtype=np.int64).reshape(-1, 5),
    )


def _encoded(parts: Parts, fails: Sequence[float], **rules: Any) -> Encoded:
    known, known_shift = _known(parts)
    number = len(rules["rule_ends"])
    rest = {
        "values": [sensor.values for sensor in parts.sensors],
        "fails": np.array(fails, dtype=np.float64),
        "known": known,
        "known_shift": known_shift,
        "instances": [len(parts.behaviours)] * number,
        "restarting": [_restarting(parts)] * number,
    }
    arrays = {
        name: value if isinstance(value, np.ndarray) else np.array(value, dtype=np.int64)
        for name, value in (rest | rules).items()
    }
    return Encoded(**arrays)


def compile_controllers(
    controllers: Sequence[Controller], fails: Sequence[float], parts: Parts = PARTS
) -> Tables:
    """Control tables for drawing by one random number.

    Args:
        controllers: Rule sets, or what they have been compiled to.
        fails: With which probability each sensor reads 0 instead of what it should.
        parts: What the scenario is composed of.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
        ValueError: A table is for another vocabulary, or a rule set is beyond a limit.
    """
    rule_sets = [each for each in controllers if isinstance(each, RuleSet) and _is_short(each)]
    if len(rule_sets) == len(controllers):
        return _compiled(encode(rule_sets, fails, parts), _dense([], parts), parts)
    tables = [
        ControlTable.compile(each) if isinstance(each, RuleSet) else each for each in controllers
    ]
    nothing = {"accepted": np.zeros((0, len(parts.sensors)), np.uint64), "chances": np.zeros(0)}
    encoded = _encoded(
        parts, fails, rule_ends=[0] * len(tables), behaviours=[], action_ends=[], targets=[],
        changes=np.zeros((0, 5), np.int64), **nothing,
    )  # fmt: skip
    return _compiled(encoded, _dense(tables, parts), parts)


def _is_short(rule_set: RuleSet) -> bool:
    """Whether the kernel can keep all rules apart; longer ones go by way of the dense table."""
    return len(rule_set.rules) <= MOST_RULES - MOST_STATE_BITS


def _dense(tables: Sequence[ControlTable], parts: Parts) -> npt.NDArray[np.float64]:
    """Outcome distributions of each code and behaviour, shape (tables, codes, behaviours, -1)."""
    for number, table in enumerate(tables):
        if table.space.vocabulary is not VOCABULARY:
            raise ValueError(
                f"tables[{number}]: expected the foraging vocabulary, got one with "
                f"{', '.join(table.space.vocabulary.behaviour_index)}"
            )
    behaviours = len(parts.behaviours)
    if not tables:
        return np.zeros((0, parts.codes, behaviours, 2 * behaviours * parts.states))
    sensed, state = divmod(_situation_of_code(parts), parts.states)
    situations = (sensed[:, None] * behaviours + np.arange(behaviours)) * parts.states
    situations += state[:, None]
    return np.stack([table.probabilities[situations] for table in tables])


def _situation_of_code(parts: Parts) -> npt.NDArray[np.int64]:
    """For each code what is sensed * states + the registers at the start of the step."""
    rest = np.arange(parts.codes)
    readings = []
    for sensor in parts.sensors:
        rest, reading = np.divmod(rest, sensor.values)
        readings.append(reading)
    state = np.full(parts.codes, parts.momentary_state)
    for register in parts.registers:
        if register.seen_by is not None:
            position = parts.sensors.index(register.seen_by)
            state |= readings[position] << parts.shifts[register.name]
    sensed = np.arange(parts.codes) % parts.sensed_codes
    return np.asarray(sensed * parts.states + state, dtype=np.int64)


def _compiled(encoded: Encoded, dense: npt.NDArray[np.float64], parts: Parts) -> Tables:
    """Run the kernel, with more room until all tables are there."""
    number, codes = len(encoded.rule_ends), parts.codes
    tables = Tables(
        classes=np.empty(number * codes, dtype=np.uint16),
        rows=np.empty(number * min(codes, 64) * ROW_BEHAVIOURS, dtype=np.uint32),
        thresholds=np.empty(number * 256, dtype=np.uint32),
        outcomes=np.empty(number * 512, dtype=np.uint32),
        begins=np.zeros((number + 1, 3), dtype=np.int64),
    )
    room = _room(parts)
    done = compile_tables(encoded, dense, room, tables, 0)
    while 0 <= done < number:
        tables = tables._replace(
            **{
                name: np.concatenate([each, np.empty_like(each)])
                for name, each in tables._asdict().items()
                if name in ("rows", "thresholds", "outcomes")
            }
        )
        done = compile_tables(encoded, dense, room, tables, done)
    if done < 0:
        raise ValueError(
            f"rule set {-1 - done}: its control table is too large: expected at most {MOST_RULES} "
            f"rules, {_MOST_CLASSES} classes of situations and {MOST_OUTCOMES} outcomes of one"
        )
    return tables


def _room(parts: Parts) -> Room:
    codes, readings = parts.codes, len(parts.sensors)
    classes = min(codes, _MOST_CLASSES)
    rows = classes * ROW_BEHAVIOURS
    return Room(
        class_key=np.zeros((readings, 64), dtype=np.uint64),
        signatures=np.empty((3, max(codes, classes)), dtype=np.uint64),
        halves=np.empty((2, codes), dtype=np.uint16),
        pair_class=np.empty((classes, classes), dtype=np.int32),
        class_of_code=np.empty((2, codes), dtype=np.int32),
        start=np.empty((2, classes), dtype=np.int64),
        keys=np.empty((2, rows, MOST_OUTCOMES), dtype=np.int64),
        shares=np.empty((2, rows, MOST_OUTCOMES)),
        lengths=np.zeros((2, rows), dtype=np.int64),
        few_keys=np.empty((2, 2 * MOST_OUTCOMES), dtype=np.int64),
        few_shares=np.empty((3, 2 * MOST_OUTCOMES)),
    )


def chance(p: float) -> tuple[int, int]:
    """(threshold, possible): random bits up to the threshold have probability p, if possible."""
    return max(0, math.ceil(p * 2.0**32) - 1), int(p > 0.0)


def chances(fails: Sequence[float], parts: Parts = PARTS) -> Records:
    """The sensors that may fail, as random bits decide it; of CHANCE."""
    failing = [p for p, sensor in zip(fails, parts.sensors, strict=True) if sensor.fails]
    return np.array([chance(p) for p in failing], dtype=CHANCE)


def rules_to_interpret(
    rule_set: RuleSet, parts: Parts = PARTS
) -> tuple[Records, npt.NDArray[np.uint64], Records]:
    """Rules, what they accept of each reading, actions; nothing fired yet.

    Rules that are switched off are there, too: indices are positions in the rule set.

    Returns:
        Of RULE; uint64, shape (rules, sensors); of ACTION.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    require_known_names(rule_set, VOCABULARY)
    all_actions = [action for rule in rule_set.rules for action in rule.actions]
    rules = np.zeros(len(rule_set.rules), dtype=RULE)
    actions = np.zeros(len(all_actions), dtype=ACTION)
    accepts = np.zeros((len(rules), len(parts.sensors)), dtype=np.uint64)
    end = 0
    for number, rule in enumerate(rule_set.rules):
        first, end = end, end + len(rule.actions)
        accepts[number] = _accepted_by(rule.preconditions, parts)
        rules[number] = (0, rule.enabled, _behaviours(rule.behaviours), first, end)
    for number, action in enumerate(all_actions):
        target, (clears, sets, *_) = _effect(action, parts)
        restarts = target >= 0 and _restarting(parts) >> target & 1
        actions[number] = (0, *chance(action.p), target, clears, sets, restarts)
    return rules, accepts, actions
