"""Scenario, rule set and control table as the arrays and numbers that the kernels take."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from geswarm.rules.check import require_known_names
from geswarm.rules.control_table import ControlTable
from geswarm.rules.model import Action, BehaviourChange, Rule, RuleSet
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.sim import footbot
from geswarm.sim.kernels.state import ACTION, ROBOT, RULE, Physics
from geswarm.sim.scenario import Scenario

Records: TypeAlias = npt.NDArray[np.void]


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
        object_margin=scenario.object_margin,
        walk_min=scenario.random_walk[0],
        walk_max=scenario.random_walk[1],
        max_speed=scenario.max_speed,
        turn_gain=scenario.turn_gain,
        proximity_range=scenario.proximity_range,
        rab_range=scenario.rab_range,
        avoidance_gain=scenario.avoidance_gain,
        radius=footbot.RADIUS,
        wheel_base=footbot.WHEEL_BASE,
        control_step=footbot.CONTROL_STEP,
    )


def room_for(scenario: Scenario) -> tuple[Records, npt.NDArray[np.float64]]:
    """Arrays for the robots and the objects of one simulation, to be filled by a kernel."""
    return np.zeros(scenario.robots, dtype=ROBOT), np.zeros((scenario.objects, 2))


def encode_tables(
    tables: Sequence[ControlTable],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint8]]:
    """Control tables for drawing by one random number u: the first k with u < upto[k].

    Returns:
        `upto` (cumulative probabilities, likeliest outcome first, so that few comparisons are
        needed) and `outcomes` (their numbers), each of shape (tables, situations, outcomes).

    Raises:
        ValueError: A table is for another vocabulary than the one that the simulator implements.
    """
    for number, table in enumerate(tables):
        if table.vocabulary != FORAGING:
            raise ValueError(
                f"tables[{number}]: expected the foraging vocabulary, got one with "
                f"{', '.join(table.vocabulary.behaviour_index)}"
            )
    probabilities = np.stack([table.probabilities for table in tables])
    outcomes = np.argsort(-probabilities, axis=2, kind="stable")
    upto = np.cumsum(np.take_along_axis(probabilities, outcomes, axis=2), axis=2)
    # Rounding must not leave a gap below 1, nor an impossible outcome a part of it.
    possible = np.count_nonzero(probabilities > 0.0, axis=2)
    upto[np.arange(upto.shape[2]) >= possible[:, :, None] - 1] = 1.0
    return upto, outcomes.astype(np.uint8)


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
        if precondition.holds == value:
            mask |= 1 << vocabulary.precondition_index[precondition.name]
    return mask


def _behaviours(rule: Rule, vocabulary: Vocabulary) -> int:
    """Mask of the behaviours in which the rule may be active."""
    mask = 0
    for name in rule.behaviours or vocabulary.behaviour_index:
        mask |= 1 << vocabulary.behaviour_index[name]
    return mask


def _effect(action: Action, vocabulary: Vocabulary) -> tuple[int, int, int]:
    """(behaviour to change to or -1, internal-state bits to clear, bits to set)."""
    if isinstance(action, BehaviourChange):
        return vocabulary.behaviour_index[action.behaviour], 0, 0
    bit = 1 << vocabulary.state_index[action.state]
    return -1, bit, bit if action.value else 0
