"""Scenario, rule set and control table as the arrays and numbers that the kernels take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.control_table import ControlTable
from geswarm.rules.model import CONTROL_STEP, Action, Rule, RuleSet
from geswarm.rules.names import require_known_names
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.sim import footbot
from geswarm.sim.compiled import fill_slots
from geswarm.sim.kernels.state import ACTION, BEHAVIOURS, ROBOT, RULE, SLOT, Physics
from geswarm.sim.kernels.table import MEMORIES
from geswarm.sim.scenario import Scenario
from geswarm.sim.scenario_checks import objects_from_walls

Records: TypeAlias = npt.NDArray[np.void]

_ALL_PAIRS_UP_TO = 32
"""Number of robots up to which comparing each with each is faster than a grid."""


def encode_scenario(scenario: Scenario) -> Physics:
    """The scenario in numbers; origin at the centre of the arena."""
    half_length = scenario.length / 2.0
    return Physics(
        half_width=scenario.width / 2.0,
        half_length=half_length,
        nest_edge=scenario.nest - half_length,
        source_edge=half_length - scenario.source,
        light_y=half_length + scenario.light,
        zone_miss=scenario.zone_miss,
        grip_reach=scenario.grip_reach,
        object_margin=objects_from_walls(scenario.object_margin, scenario.grip_reach),
        walk_min=scenario.random_walk[0],
        walk_max=scenario.random_walk[1],
        max_speed=scenario.max_speed,
        turn_gain=scenario.turn_gain,
        proximity_range=scenario.proximity_range,
        rab_range=scenario.rab_range,
        avoidance_gain=scenario.avoidance_gain,
        radius=footbot.RADIUS,
        wheel_base=footbot.WHEEL_BASE,
        control_step=CONTROL_STEP,
    )


def in_single_precision(physics: Physics) -> Physics:
    """The scenario in numbers of numpy.float32."""
    single: Any = np.array(physics, dtype=np.float32)
    return Physics(*single)


class Room(NamedTuple):
    """Arrays for one simulation, in the order in which the kernels take them.

    Attributes:
        robots: Of ROBOT, shape (robots,).
        slots: Of SLOT, for sorting a large swarm by cell, shape (robots,); empty for a small one.
        starts: int32, where each cell starts in `slots`, shape (columns, rows + 1).
        objects: float64, positions, shape (objects, 2).
        heads: int32, the first object of each cell of the source, shape (columns, rows).
        following: int32, the next object in the same cell, shape (objects,).
    """

    robots: Records
    slots: Records
    starts: npt.NDArray[np.int32]
    objects: npt.NDArray[np.float64]
    heads: npt.NDArray[np.int32]
    following: npt.NDArray[np.int32]


def room_for(scenario: Scenario) -> Room:
    """Room for one simulation, to be filled by a kernel."""
    large = scenario.robots > _ALL_PAIRS_UP_TO
    touch = 2.0 * (footbot.RADIUS + scenario.max_speed * CONTROL_STEP)
    sight = max(scenario.rab_range, 2.0 * touch)
    columns, rows = _grid(scenario.width, scenario.length, sight, 4 * scenario.robots)
    source_columns, source_rows = _grid(
        scenario.width, scenario.source, scenario.grip_reach, scenario.objects
    )
    return Room(
        robots=np.zeros(scenario.robots, dtype=ROBOT),
        slots=np.zeros(scenario.robots if large else 0, dtype=SLOT),
        starts=np.zeros((columns, rows + 1) if large else (0, 1), dtype=np.int32),
        objects=np.zeros((scenario.objects, 2)),
        heads=np.zeros((source_columns, source_rows), dtype=np.int32),
        following=np.zeros(scenario.objects, dtype=np.int32),
    )


def _grid(width: float, length: float, least: float, cells: int) -> tuple[int, int]:
    """Columns and rows of a grid of about so many cells, none narrower than `least`."""
    side = max(least, math.sqrt(width * length / cells))
    return max(1, int(width / side)), max(1, int(length / side))


@dataclass(frozen=True)
class Words:
    """Control tables as the kernels draw from them, see `geswarm.sim.kernels.table`.

    Attributes:
        words: uint32, shape (tables, situations, slots); a table may use fewer slots than there
            are.
        slot_bits: Logarithm of the number of slots that a table uses, uint32, shape (tables,). It
            depends on nothing but the table, or results would depend on what else is evaluated.
    """

    words: npt.NDArray[np.uint32]
    slot_bits: npt.NDArray[np.uint32]

    @property
    def row_bits(self) -> int:
        """Logarithm of the number of words from one situation to the next."""
        return int(self.words.shape[2].bit_length() - 1)


def encode_tables(tables: Sequence[ControlTable], zone_miss: float) -> Words:
    """Control tables for drawing by one random number.

    Raises:
        ValueError: A table is for another vocabulary than the one that the simulator implements.
    """
    for number, table in enumerate(tables):
        if table.space.vocabulary is not FORAGING:
            raise ValueError(
                f"tables[{number}]: expected the foraging vocabulary, got one with "
                f"{', '.join(table.space.vocabulary.behaviour_index)}"
            )
    probabilities = np.stack([table.probabilities for table in tables])
    outcomes = probabilities.shape[2]
    # Axes: table, HAS_OBJECT, zones, behaviour, DROP_OBJECT, WANT_OBJECT, outcome.
    seen = probabilities.reshape(len(tables), 2, 4, BEHAVIOURS, 2, 2, outcomes)
    lasting = seen[:, :, :, :, 0]  # DROP_OBJECT is false when a step begins
    mixed = (1.0 - zone_miss) * lasting + zone_miss * lasting[:, :, :1]
    by_memory = np.zeros((len(tables), 4, 2, BEHAVIOURS + 1, 2, outcomes))
    by_memory[:, :, :, :BEHAVIOURS] = mixed.swapaxes(1, 2)
    by_memory[:, :, :, BEHAVIOURS, :, 0] = 1.0  # there is no such behaviour
    rows = by_memory.reshape(len(tables), 4 * MEMORIES, outcomes)
    most = np.count_nonzero(rows, axis=2).max(axis=1)
    slot_bits = np.array([int(number - 1).bit_length() for number in most], dtype=np.uint32)
    words = np.zeros((*rows.shape[:2], 1 << int(slot_bits.max())), dtype=np.uint32)
    for of_table, table_words, bits in zip(rows, words, slot_bits, strict=True):
        slots = 1 << int(bits)
        room = np.empty(slots), np.empty(slots, dtype=np.uint32)
        fill_slots(of_table, table_words[:, :slots], *room)
    return Words(words, slot_bits)


def encode_rules(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> tuple[Records, Records]:
    """Rules and actions as records, in the rule set's own order, nothing fired yet.

    Rules that are switched off are there, too: indices are positions in the rule set.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    require_known_names(rule_set, vocabulary)
    all_actions = [action for rule in rule_set.rules for action in rule.actions]
    rules = np.zeros(len(rule_set.rules), dtype=RULE)
    actions = np.zeros(len(all_actions), dtype=ACTION)
    end = 0
    for record, rule in zip(rules, rule_set.rules, strict=True):
        true, false = (_percepts(rule, vocabulary, value) for value in (True, False))
        record["enabled"] = rule.enabled and not true & false
        record["sensed"] = true | false
        record["expected"] = true
        record["behaviours"] = _behaviours(rule, vocabulary)
        record["first_action"] = end
        end += len(rule.actions)
        record["end_action"] = end
    for record, action in zip(actions, all_actions, strict=True):
        record["p"] = action.p
        record["target"], record["clears"], record["sets"] = _effect(action, vocabulary)
    return rules, actions


def _percepts(rule: Rule, vocabulary: Vocabulary, value: bool) -> int:
    """Mask of the percepts that the rule expects to have this value."""
    mask = 0
    for precondition in rule.preconditions:
        if vocabulary.holds(precondition, value):
            mask |= 1 << vocabulary.precondition_index[precondition.percept.name]
    return mask


def _behaviours(rule: Rule, vocabulary: Vocabulary) -> int:
    """Mask of the behaviours in which the rule may be active."""
    mask = 0
    names = [behaviour.name for behaviour in rule.behaviours]
    for name in names or vocabulary.behaviour_index:
        mask |= 1 << vocabulary.behaviour_index[name]
    return mask


def _effect(action: Action, vocabulary: Vocabulary) -> tuple[int, int, int]:
    """(behaviour to change to or -1, internal-state bits to clear, bits to set)."""
    if not action.target:
        return vocabulary.behaviour_index[action.becomes], 0, 0
    bit = 1 << vocabulary.state_index[action.target]
    return -1, bit, bit if action.becomes == "true" else 0
