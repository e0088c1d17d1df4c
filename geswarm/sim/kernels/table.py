"""Control tables: a rule set as the outcome distribution of each situation, drawn by one number.

    readings -> code -> class -> row (class, behaviour) -> slot -> outcome

The readings of the sensors are one mixed-radix number, the code. Codes in which the same rules may
act, with the same chances, are one class. A row's outcomes are spread over a power of two of slots
of equal probability, each shared by at most two (alias method, Walker 1977): the upper bits of a
random number choose the slot, the next ones which of the two.

An outcome says how the robot's registers change, not what they become, so they are no part of the
row: first clear bits, then set bits; add to the counter, then keep it between two bounds. What a
rule set makes of a register that is read as a sensor is known, and so outcomes that come to the
same are one.

| bits of an outcome | |
| --- | --- |
| 0 | the behaviour was changed to and starts afresh |
| 1-5 | behaviour, as the rule set numbers it |
| 6-13, 14-21 | bits of the registers to clear, to set |
| 22-25, 26-28, 29-31 | added to the counter, plus 8; its least and greatest value then |

A reading that fails as a whole is mixed in: a code's distribution becomes that of what is read.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from geswarm.sim.kernels.jit import inlined

ROW_BEHAVIOURS = 32
"""Rows of a class; the most behaviours that a rule set can have."""
MOST_OUTCOMES = 128
"""Of one row."""
MOST_RULES = 64
"""Of a rule set, with one for each bit of a register that it changes and that is read, and of the
number of a reading's cell if rules act by chance."""
MOST_CLASSES = 1024
_MOST_READINGS, _MOST_CODES = 16, 65_536
_MOST_ROWS = MOST_CLASSES * ROW_BEHAVIOURS
THRESHOLD_BITS = 22
"""Of a slot's 32: as fine as it was when results were published that must come out again."""
IDENTITY = (8 << 22) | (7 << 29)
"""No change: of registers, nothing cleared or set; of the counter, 0 added, from 0 to 7."""


class Encoded(NamedTuple):
    """Rule sets in numbers, one after the other.

    Attributes:
        values: int64, how many values each reading has.
        fails: float64, with which probability each reading is 0 whatever it should be.
        known: int64, for each bit of the registers the reading that tells it at the start of a
            step, -1 for none, -2 and -3 for always 0 and 1.
        known_shift: int64, which bit of that reading.
        rule_ends: int64, shape (rule sets,), where the rules of each end.
        instances: int64, shape (rule sets,), how many behaviours each has.
        restarting: int64, shape (rule sets,), mask of those that start afresh when changed to.
        accepted: uint64, shape (rules, readings), values with which a rule may act, as bits.
        behaviours: int64, shape (rules,), mask of the behaviours in which it may act.
        action_ends: int64, shape (rules,), where the actions of each end.
        chances: float64, shape (actions,).
        targets: int64, shape (actions,), behaviour to change to, -1 for none.
        changes: int64, shape (actions, 5): bits to clear and to set; added to the counter, its
            least and greatest value.
    """

    values: Any
    fails: Any
    known: Any
    known_shift: Any
    rule_ends: Any
    instances: Any
    restarting: Any
    accepted: Any
    behaviours: Any
    action_ends: Any
    chances: Any
    targets: Any
    changes: Any


class ByChance(NamedTuple):
    """Preconditions that hold by chance.

    Attributes:
        rows: int64, shape (rules,), row of `holding` of a rule that acts by chance, else -1.
        holding: float64, shape (rules that act by chance, readings, 64), how probably each value of
            a reading lets the rule act; the chances of all readings multiply.
    """

    rows: Any
    holding: Any


class Tables(NamedTuple):
    """Control tables, one after the other; what `begins` says are positions in the flat arrays.

    Attributes:
        classes: uint16, the class of each code.
        rows: uint32, for each class and behaviour the first slot << 3 | logarithm of the slots.
        thresholds: uint32, random bits below this choose the slot's first outcome.
        outcomes: uint32, two for each slot.
        begins: int64, shape (tables, 3): first code, first row, slots so far.
    """

    classes: Any
    rows: Any
    thresholds: Any
    outcomes: Any
    begins: Any


ROOM = np.dtype(
    [
        ("class_key", np.uint64, (_MOST_READINGS, 64)),  # which rules a value of a reading lets by
        ("signatures", np.uint64, (3, _MOST_CODES)),
        ("halves", np.uint16, (2, _MOST_CODES)),
        ("pair_class", np.int32, (MOST_CLASSES, MOST_CLASSES)),
        ("class_of_code", np.int32, (2, _MOST_CODES)),
        ("code_of_class", np.int64, MOST_CLASSES),  # one of its codes
        ("drawing", np.uint64, _MOST_READINGS),  # rules that act by chance if a reading has cells
        ("cell_bits", np.uint64, _MOST_READINGS),  # of the number of a reading's cell
        ("cell", np.int64, 64),  # of each value of a reading
        ("start", np.int64, (2, MOST_CLASSES)),  # known values of the registers' bits in each class
        ("keys", np.int64, (2, _MOST_ROWS, MOST_OUTCOMES)),  # outcomes of each row, sorted
        ("shares", np.float64, (2, _MOST_ROWS, MOST_OUTCOMES)),  # how probable each is
        ("lengths", np.int64, (2, _MOST_ROWS)),  # how many they are
        ("marks", np.float64, _MOST_ROWS),  # equal for equal rows
        ("distinct", np.int64, _MOST_ROWS),  # rows that equal no earlier one
        ("few_keys", np.int64, (2, 2 * MOST_OUTCOMES)),
        ("few_shares", np.float64, (3, 2 * MOST_OUTCOMES)),
    ],
    align=True,
)
"""Working space for one rule set, as large as it may ever have to be.

A record, whose place is one number: a tuple of arrays is a hundred of them, which the compiler
would follow into each function. What is not used of it takes no memory.
"""


@inlined
def slot_of(bits: Any, slot_bits: Any) -> Any:
    """The slot of 2**slot_bits that random bits choose."""
    return np.uint32(
        np.uint32(bits >> np.uint32(1)) >> np.uint32(np.uint32(31) - np.uint32(slot_bits))
    )
