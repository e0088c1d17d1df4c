"""Outcome distributions while a control table is made: what rules make of them, one by one.

A distribution is a list of outcomes, see `table`, sorted, and how probable each is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import called
from geswarm.sim.kernels.table import IDENTITY, MOST_OUTCOMES, ROW_BEHAVIOURS

_ONE = np.uint64(1)
_OPERATIONS = 0xFFFFFFC0


@called
def _order(key: int, start: int) -> Any:
    """Outcomes are sorted by behaviour, then what the registers become, then restart."""
    clears, sets = (key >> 6) & 255, (key >> 14) & 255
    becomes = (start & ~clears) | sets
    return (((((key >> 1) & 31) << 8 | becomes) << 1 | (key & 1)) << 18) | (key >> 22 << 8) | clears


@called
def _changed(key: int, changes: Any, start: int, known: int) -> Any:
    """The outcome after one more change of registers."""
    clears = ((key >> 6) & 255) | changes[0]
    sets = (((key >> 14) & 255) & ~changes[0]) | changes[1]
    # Of what is known only what differs in the end is a change.
    becomes = (start & ~clears) | sets
    differs = (becomes ^ start) & known
    clears = (clears & ~known) | differs
    sets = (sets & ~known) | (becomes & differs)
    added, least, most = changes[2], changes[3], changes[4]
    low = min(max(((key >> 26) & 7) + added, least), most)
    high = min(max(((key >> 29) & 7) + added, least), most)
    total = min(max(((key >> 22) & 15) - 8 + added, -7), 7)
    return (
        (key & 63) | (clears << 6) | (sets << 14) | ((total + 8) << 22) | (low << 26) | (high << 29)
    )


@called
def insert(keys: Any, shares: Any, length: int, key: int, start: int) -> Any:
    """Where an outcome is in a sorted list, inserted with probability 0 if it was not there.

    The list is longer by one then: the caller compares.
    """
    order = _order(key, start)
    at = 0
    while at < length and _order(keys[at], start) < order:
        at += 1
    if at == length or keys[at] != key:
        for k in range(length, at, -1):
            keys[k], shares[k] = keys[k - 1], shares[k - 1]
        keys[at], shares[at] = key, 0.0
    return at


@called
def _act(
    chance: float, target: int, changes: Any, restarting: int, start: int, known: int,
    keys: Any, shares: Any, length: int, before_keys: Any, before: Any,
) -> Any:  # fmt: skip
    """Mix in what an action does; the new length of the list, or -1 if it is too long."""
    for k in range(length):
        before_keys[k], before[k] = keys[k], shares[k]
    old = length
    for k in range(old):  # room for all outcomes first: done sums up in their order
        key = _after(before_keys[k], target, changes, restarting, start, known)
        at = find(keys, length, key)
        if at < 0:
            if length == MOST_OUTCOMES:
                return -1
            insert(keys, shares, length, key, start)
            length += 1
    for k in range(length):
        shares[k] *= 1.0 - chance
    done = before[MOST_OUTCOMES:]
    done[:length] = 0.0
    for k in range(old):
        key = _after(before_keys[k], target, changes, restarting, start, known)
        done[find(keys, length, key)] += before[k]
    for k in range(length):
        shares[k] += chance * done[k]
    return without_zeros(keys, shares, length)


@called
def _after(key: int, target: int, changes: Any, restarting: int, start: int, known: int) -> Any:
    """The outcome after an action."""
    if target < 0:
        return _changed(key, changes, start, known)
    if (key >> 1) & 31 == target:
        return key
    return (key & _OPERATIONS) | (target << 1) | ((restarting >> target) & 1)


@called
def find(keys: Any, length: int, key: int) -> Any:
    """Where an outcome stands in a list, -1 if it does not."""
    for k in range(length):
        if keys[k] == key:
            return k
    return -1


@called
def without_zeros(keys: Any, shares: Any, length: int) -> Any:
    """Leave out what is impossible; how many are left."""
    kept = 0
    for k in range(length):
        if shares[k] > 0.0:
            keys[kept], shares[kept] = keys[k], shares[k]
            kept += 1
    return kept


@called
def _chance(encoded: Any, by_chance: Any, rule: int, code: int) -> float:
    """How probably a rule's preconditions hold, of which those that are true or false do."""
    row, chance = by_chance.rows[rule], 1.0
    if row >= 0:
        for reading in range(len(encoded.values)):
            chance *= by_chance.holding[row, reading, code % encoded.values[reading]]
            code //= encoded.values[reading]
    return chance


@called
def decide(encoded: Any, by_chance: Any, room: Any, number: int, row: int, behaviour: int,
            signature: Any, start: int, known: int) -> bool:  # fmt: skip
    """Outcomes of one class and behaviour; False if they are too many."""
    first_rule = encoded.rule_ends[number - 1] if number else 0
    keys, shares = room.keys[0, row], room.shares[0, row]
    active_keys, active = room.few_keys[0], room.few_shares[0]
    keys[0], shares[0], length = (behaviour << 1) | IDENTITY, 1.0, 1
    restarting = encoded.restarting[number]
    for rule in range(first_rule, encoded.rule_ends[number]):
        if not (signature >> np.uint64(rule - first_rule)) & _ONE:
            continue
        acting, waiting, chance = 0, 0, 1.0
        if by_chance is not None:
            code = room.code_of_class[row // ROW_BEHAVIOURS]
            chance = _chance(encoded, by_chance, rule, code)
        for k in range(length):
            if (encoded.behaviours[rule] >> ((keys[k] >> 1) & 31)) & 1:
                active_keys[acting], active[acting] = keys[k], shares[k] * chance
                acting += 1
                if chance < 1.0:
                    keys[waiting], shares[waiting] = keys[k], shares[k] * (1.0 - chance)
                    waiting += 1
            else:
                keys[waiting], shares[waiting] = keys[k], shares[k]
                waiting += 1
        first_action = encoded.action_ends[rule - 1] if rule else 0
        if acting:
            for a in range(first_action, encoded.action_ends[rule]):
                acting = _act(
                    encoded.chances[a], encoded.targets[a], encoded.changes[a], restarting, start,
                    known, active_keys, active, acting, room.few_keys[1], room.few_shares[1],
                )  # fmt: skip
                if acting < 0:
                    return False
        length = waiting
        for k in range(acting):
            if length == MOST_OUTCOMES and find(keys, length, active_keys[k]) < 0:
                return False
            at = find(keys, length, active_keys[k])
            if at < 0:
                at = insert(keys, shares, length, active_keys[k], start)
                length += 1
            shares[at] += active[k]
    room.lengths[0, row] = length
    return True
