"""Codes in which the same rules may act are one class: how a control table begins."""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import called
from geswarm.sim.kernels.table import MOST_RULES

_ALL = np.uint64(0xFFFFFFFFFFFFFFFF)
_ONE = np.uint64(1)
_UNKNOWN = -1


@called
def _distinct(room: Any, values: Any, first: int, end: int, codes: int, half: int) -> int:
    """Number the distinct sets of rules that some of the readings let through."""
    found = 0
    for code in range(codes):
        signature, rest = _ALL, code
        for reading in range(first, end):
            signature &= room.class_key[reading, rest % values[reading]]
            rest //= values[reading]
        at = 0
        while at < found and room.signatures[half, at] != signature:
            at += 1
        if at == found:
            room.signatures[half, at] = signature
            found += 1
        room.halves[half, code] = at
    return found


@called
def classify(encoded: Any, by_chance: Any, room: Any) -> int:
    """The class of each code, by which rules may act; how many classes there are.

    The readings are taken in two halves, so that only their distinct sets of rules are compared.
    So are the cells of readings by which rules act by chance; where none of these rules may act,
    the cell makes no difference.
    """
    values, readings = encoded.values, len(encoded.values)
    codes = 1
    for reading in range(readings):
        codes *= values[reading]
    half, low_codes = 0, 1
    while half < readings and low_codes * values[half] * low_codes <= codes * 2:
        low_codes *= values[half]
        half += 1
    lows = _distinct(room, values, 0, half, low_codes, 0)
    highs = _distinct(room, values, half, readings, codes // low_codes, 1)
    classes = 0
    for high in range(highs):
        for low in range(lows):
            signature = room.signatures[0, low] & room.signatures[1, high]
            for reading in range(0 if by_chance is None else readings):
                if not signature & room.drawing[reading]:
                    signature |= room.cell_bits[reading]
            at = 0
            while at < classes and room.signatures[2, at] != signature:
                at += 1
            if at == classes:
                if classes == room.start.shape[1]:
                    return -1
                room.signatures[2, at] = signature
                classes += 1
            room.pair_class[high, low] = at
    for code in range(codes):
        high, low = room.halves[1, code // low_codes], room.halves[0, code % low_codes]
        room.class_of_code[0, code] = room.pair_class[high, low]
    return classes


@called
def let_through(encoded: Any, by_chance: Any, room: Any, number: int) -> int:
    """Which rules each value of each reading lets through; the mask of the known bits.

    The bits of a register that the rules change and a sensor reads are rules like any other here:
    where they differ, so do the outcomes.
    """
    first_rule = encoded.rule_ends[number - 1] if number else 0
    rules = encoded.rule_ends[number] - first_rule
    first_action = encoded.action_ends[first_rule - 1] if first_rule else 0
    last_action = encoded.action_ends[first_rule + rules - 1] if rules else first_action
    touched = 0
    for a in range(first_action, last_action):
        touched |= encoded.changes[a, 0]
    for reading in range(len(encoded.values)):
        for value in range(encoded.values[reading]):
            key = _ALL
            for rule in range(rules):
                if not (encoded.accepted[first_rule + rule, reading] >> np.uint64(value)) & _ONE:
                    key ^= _ONE << np.uint64(rule)
            room.class_key[reading, value] = key
    known, extra = 0, rules
    for bit in range(len(encoded.known)):
        reading = encoded.known[bit]
        if reading == _UNKNOWN:
            continue
        known |= 1 << bit
        if reading >= 0 and (touched >> bit) & 1:
            for value in range(encoded.values[reading]):
                if not (value >> encoded.known_shift[bit]) & 1:
                    room.class_key[reading, value] ^= _ONE << np.uint64(extra)
            extra += 1
    if by_chance is not None:
        extra = _divide(encoded, by_chance, room, first_rule, rules, extra)
    return known if extra <= MOST_RULES else -1


@called
def _divide(
    encoded: Any, by_chance: Any, room: Any, first_rule: int, rules: int, extra: int
) -> int:
    """Number the cells of each reading: values for which no rule has another chance to act.

    The bits of a cell's number stand behind those of the rules, from `extra` on.

    Returns:
        How many bits there are then.
    """
    for reading in range(len(encoded.values)):
        room.drawing[reading], room.cell_bits[reading] = np.uint64(0), np.uint64(0)
        cells = 0
        for value in range(encoded.values[reading]):
            cell = value
            for other in range(value):
                if cell == value and _is_alike(by_chance, first_rule, rules, reading, value, other):
                    cell = other
            room.cell[value] = room.cell[cell] if cell < value else cells
            cells += cell == value
        bits = 0
        while (1 << bits) < cells:
            bits += 1
        if extra + bits > MOST_RULES:
            return MOST_RULES + 1
        for bit in range(bits):
            mask = _ONE << np.uint64(extra + bit)
            room.cell_bits[reading] |= mask
            for value in range(encoded.values[reading]):
                if not (room.cell[value] >> bit) & 1:
                    room.class_key[reading, value] ^= mask
        for rule in range(rules if bits else 0):
            if not _is_even(encoded, by_chance, first_rule + rule, reading):
                room.drawing[reading] |= _ONE << np.uint64(rule)
        extra += bits
    return extra


@called
def _is_even(encoded: Any, by_chance: Any, rule: int, reading: int) -> bool:
    """Whether a rule acts by the same chance with all values of a reading."""
    row = by_chance.rows[rule]
    if row >= 0:
        for value in range(1, encoded.values[reading]):
            if by_chance.holding[row, reading, value] != by_chance.holding[row, reading, 0]:
                return False
    return True


@called
def _is_alike(
    by_chance: Any, first_rule: int, rules: int, reading: int, value: int, other: int
) -> bool:
    """Whether each rule acts by the same chance with two values of a reading."""
    for rule in range(first_rule, first_rule + rules):
        row = by_chance.rows[rule]
        if row < 0:
            continue
        if by_chance.holding[row, reading, value] != by_chance.holding[row, reading, other]:
            return False
    return True
