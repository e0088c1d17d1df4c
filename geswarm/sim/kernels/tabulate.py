"""The kernel that makes control tables of rule sets: codes -> classes -> rows -> slots."""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.classify import classify, let_through
from geswarm.sim.kernels.jit import called, kernel
from geswarm.sim.kernels.outcomes import decide, find, insert, without_zeros
from geswarm.sim.kernels.table import (
    IDENTITY,
    MOST_OUTCOMES,
    ROW_BEHAVIOURS,
    THRESHOLD_BITS,
)

_ALWAYS_1 = -3


@called
def _starts(encoded: Any, room: Any, codes: int) -> None:
    """What is known of the registers in each class: one of its codes says it for all."""
    for code in range(codes):
        start = 0
        for bit in range(len(encoded.known)):
            reading = encoded.known[bit]
            if reading == _ALWAYS_1:
                start |= 1 << bit
            elif reading >= 0:
                rest = code
                for other in range(reading):
                    rest //= encoded.values[other]
                value = rest % encoded.values[reading]
                start |= ((value >> encoded.known_shift[bit]) & 1) << bit
        room.start[0, room.class_of_code[0, code]] = start
        room.code_of_class[room.class_of_code[0, code]] = code


@called
def _mix(encoded: Any, room: Any, reading: int, codes: int, classes: int, behaviours: int) -> int:
    """A reading that fails is mixed in: classes become pairs of what is there and what is read."""
    stride = 1
    for other in range(reading):
        stride *= encoded.values[other]
    fails = encoded.fails[reading]
    room.pair_class[:classes, :classes] = -1
    mixed = 0
    for code in range(codes):
        value = code // stride % encoded.values[reading]
        seen, missed = room.class_of_code[0, code], room.class_of_code[0, code - value * stride]
        if room.pair_class[seen, missed] < 0:
            if mixed == room.start.shape[1]:
                return -1
            room.pair_class[seen, missed] = mixed
            room.start[1, mixed] = room.start[0, seen]
            for behaviour in range(behaviours):
                one, other = seen * ROW_BEHAVIOURS + behaviour, missed * ROW_BEHAVIOURS + behaviour
                row = mixed * ROW_BEHAVIOURS + behaviour
                if not _mix_rows(room, one, other, row, fails, room.start[0, seen]):
                    return -1
            mixed += 1
        room.class_of_code[1, code] = room.pair_class[seen, missed]
    for code in range(codes):
        room.class_of_code[0, code] = room.class_of_code[1, code]
    for each in range(mixed):
        room.start[0, each] = room.start[1, each]
        for row in range(each * ROW_BEHAVIOURS, each * ROW_BEHAVIOURS + behaviours):
            room.lengths[0, row] = room.lengths[1, row]
            for k in range(room.lengths[0, row]):
                room.keys[0, row, k] = room.keys[1, row, k]
                room.shares[0, row, k] = room.shares[1, row, k]
    return mixed


@called
def _mix_rows(room: Any, one: int, other: int, row: int, fails: float, start: int) -> bool:
    """(1 - fails) of one row and `fails` of the other."""
    keys, shares = room.keys[1, row], room.shares[1, row]
    length = room.lengths[0, one]
    for k in range(length):
        keys[k], shares[k] = room.keys[0, one, k], (1.0 - fails) * room.shares[0, one, k]
    for k in range(room.lengths[0, other]):
        at = find(keys, length, room.keys[0, other, k])
        if at < 0:
            if length == MOST_OUTCOMES:
                return False
            at = insert(keys, shares, length, room.keys[0, other, k], start)
            length += 1
        shares[at] += fails * room.shares[0, other, k]
    room.lengths[1, row] = without_zeros(keys, shares, length)
    return True


@called
def _spread(room: Any, tables: Any, row: int, slot: int, slots: int) -> None:
    """Fill up the emptiest slot from the fullest one, until all are full."""
    keys, shares, length = room.few_keys[0], room.few_shares[0], room.lengths[0, row]
    for k in range(slots):
        shares[k] = room.shares[0, row, k] * slots if k < length else 0.0
        keys[k] = room.keys[0, row, k if k < length else 0]
    full = 1 << THRESHOLD_BITS
    done = 2.0 * slots  # more than any share
    for _ in range(slots):
        low, high = 0, -1
        for k in range(slots):
            low = k if shares[k] < shares[low] else low
            if shares[k] < done and (high < 0 or shares[k] > shares[high]):
                high = k
        threshold = np.uint32(min(max(0.0, round(shares[low] * full)), full - 1.0))
        tables.thresholds[slot + low] = threshold << np.uint32(32 - THRESHOLD_BITS)
        tables.outcomes[2 * (slot + low)] = np.uint32(keys[low])
        tables.outcomes[2 * (slot + low) + 1] = np.uint32(keys[high])
        shares[high] -= 1.0 - shares[low]  # the last slot is its own: low is high
        shares[low] = done


@called
def _write(room: Any, tables: Any, at: Any, classes: int, behaviours: int) -> bool:
    """Slots of each distinct row, at `at` (code, row, slot) on; False if there is no room.

    All rows with more than one outcome have as many slots as the longest needs.
    """
    most = 1
    for row in range(classes * ROW_BEHAVIOURS):
        if row % ROW_BEHAVIOURS < behaviours:
            most = max(most, room.lengths[0, row])
    slot_bits = 0
    while (1 << slot_bits) < most:
        slot_bits += 1
    if at[1] + classes * ROW_BEHAVIOURS > len(tables.rows):
        return False
    slot, distinct = at[2], 0
    for row in range(classes * ROW_BEHAVIOURS):
        if row % ROW_BEHAVIOURS >= behaviours:
            tables.rows[at[1] + row] = 0
            continue
        same = _same_row(room, row, distinct)
        if same >= 0:
            tables.rows[at[1] + row] = tables.rows[at[1] + same]
            continue
        room.distinct[distinct] = row
        distinct += 1
        bits = slot_bits if room.lengths[0, row] > 1 else 0
        if slot + (1 << bits) > len(tables.thresholds):
            return False
        tables.rows[at[1] + row] = np.uint32((slot << 3) | bits)
        _spread(room, tables, row, slot, 1 << bits)
        slot += 1 << bits
    at[1] += classes * ROW_BEHAVIOURS
    at[2] = slot
    return True


@called
def _same_row(room: Any, row: int, distinct: int) -> Any:
    """Which of the rows that are distinct so far has the same distribution, or -1."""
    length = room.lengths[0, row]
    mark = float(length)
    for k in range(length):
        mark += room.shares[0, row, k] * (1.0 + room.keys[0, row, k])
    room.marks[row] = mark
    for at in range(distinct):
        other = room.distinct[at]
        if room.marks[other] != mark or room.lengths[0, other] != length:
            continue
        same = True
        for k in range(length):
            same = same and room.keys[0, other, k] == room.keys[0, row, k]
            same = same and room.shares[0, other, k] == room.shares[0, row, k]
        if same:
            return other
    return -1


@called
def _unfold(dense: Any, encoded: Any, room: Any, codes: int, behaviours: int) -> int:
    """Distributions that are given for each code, behaviour and outcome; each code is a class.

    Returns -1 if these are too many classes, or a row has too many outcomes.

    Args:
        dense: float64, shape (codes, behaviours, outcomes); an outcome is (behaviour * states +
            what the registers become) * 2 + restart.
        encoded: What is known of the registers: all.
        room: Working space.
        codes: Number of codes.
        behaviours: Number of behaviours.
    """
    if codes > room.start.shape[1]:
        return -1
    states = dense.shape[2] // (2 * behaviours)
    for code in range(codes):
        room.class_of_code[0, code] = code
    _starts(encoded, room, codes)
    for code in range(codes):
        start = room.start[0, code]
        for behaviour in range(behaviours):
            row, length = code * ROW_BEHAVIOURS + behaviour, 0
            for outcome in range(dense.shape[2]):
                if dense[code, behaviour, outcome] > 0.0:
                    if length == MOST_OUTCOMES:
                        return -1
                    becomes = outcome // 2 % states
                    differs = becomes ^ start
                    key = IDENTITY | (outcome // 2 // states << 1) | (outcome & 1)
                    room.keys[0, row, length] = key | (differs << 6) | ((becomes & differs) << 14)
                    room.shares[0, row, length] = dense[code, behaviour, outcome]
                    length += 1
            room.lengths[0, row] = length
    return codes


def build_compile_tables(version: int) -> Any:
    """The kernel that makes control tables; `version` becomes part of its cache key."""

    @kernel
    def compile_tables(
        encoded: Any, by_chance: Any, dense: Any, room: Any, tables: Any, first: int
    ) -> int:
        """Make the control tables of rule sets first, first + 1 ...

        What is None is not compiled, which takes a fifth of the time.

        Args:
            encoded: Of Encoded.
            by_chance: Of ByChance, or None: no precondition holds by chance.
            dense: float64, shape (rule sets, codes, behaviours, outcomes): what rule sets come to,
                see `_unfold`; or None: it is worked out.
            room: Of ROOM.
            tables: Of Tables, with what has been made so far.
            first: Which rule set to begin with.

        Returns:
            How many tables there are now: all, or fewer if there is no room in `tables`; -1 less
            the number of a rule set that has too many outcomes, classes or rules.
        """
        codes = 1
        for reading in range(len(encoded.values)):
            codes *= encoded.values[reading]
        for number in range(first, len(encoded.rule_ends)):
            at = tables.begins[number]
            behaviours = encoded.instances[number]
            if dense is not None:
                classes = _unfold(dense[number], encoded, room, codes, behaviours)
                if classes < 0:
                    return -1 - number
            else:
                known = let_through(encoded, by_chance, room, number)
                classes = classify(encoded, by_chance, room) if known >= 0 else -1
                if classes < 0:
                    return -1 - number
                _starts(encoded, room, codes)
                for each in range(classes):
                    signature, start = room.signatures[2, each], room.start[0, each] & known
                    for behaviour in range(behaviours):
                        row = each * ROW_BEHAVIOURS + behaviour
                        if not decide(
                            encoded, by_chance, room, number, row, behaviour, signature, start,
                            known,
                        ):  # fmt: skip
                            return -1 - number
            for reading in range(len(encoded.values)):
                if encoded.fails[reading] > 0.0:
                    classes = _mix(encoded, room, reading, codes, classes, behaviours)
                    if classes < 0:
                        return -1 - number
            end = tables.begins[number + 1]
            end[0], end[1], end[2] = at[0] + codes, at[1], at[2]
            if not _write(room, tables, end, classes, behaviours):
                return number
            for code in range(codes):
                tables.classes[at[0] + code] = room.class_of_code[0, code]
        return len(encoded.rule_ends) + 0 * version

    return compile_tables
