"""Control tables for drawing by one number: the alias method (Walker 1977).

A situation's outcomes are spread over a power of two of slots of equal probability, each shared by
at most two outcomes. The upper bits of a random number choose the slot, the next bits which of the
two: one look-up, whatever the number of outcomes. What differs between the lasting states is a
situation: DROP_OBJECT is always false when a step begins, and a missed zone is mixed into the
probabilities.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geswarm.sim.kernels.jit import inlined, kernel

THRESHOLD_BITS, OUTCOME_BITS = 22, 5
"""A slot's 32-bit word: how often the first outcome is chosen, the first and the other outcome."""
MEMORIES = 16
"""Situations per combination of zones; numbered zones * MEMORIES + memory."""

_OUTCOME_MASK = np.uint32((1 << OUTCOME_BITS) - 1)


@inlined
def memory_of(carried: int, behaviour: int, want: int) -> int:
    """What a robot keeps from one step to the next, as a number."""
    return carried << 3 | behaviour << 1 | want


@inlined
def slot_of(bits: np.uint32, slot_bits: int) -> Any:
    """The slot that random bits choose."""
    return np.uint32(
        np.uint32(bits >> np.uint32(1)) >> np.uint32(np.uint32(31) - np.uint32(slot_bits))
    )


@inlined
def outcome_of(word: np.uint32, bits: np.uint32, slot_bits: int) -> Any:
    """The outcome that random bits choose from a slot's word."""
    chance = np.uint32(np.uint32(bits << np.uint32(slot_bits)) >> np.uint32(32 - THRESHOLD_BITS))
    first = np.uint32(np.uint32(word >> np.uint32(OUTCOME_BITS)) & _OUTCOME_MASK)
    other = np.uint32(word & _OUTCOME_MASK)
    return first if chance < np.uint32(word >> np.uint32(2 * OUTCOME_BITS)) else other


def build_fill_slots(version: int) -> Any:
    """The kernel that makes words of probabilities; `version` becomes part of its cache key."""

    @kernel
    def fill_slots(probabilities: Any, words: Any, shares: Any, outcomes: Any) -> int:
        """Write the slots of each situation.

        Args:
            probabilities: float64, shape (situations, outcomes), rows sum to 1.
            words: uint32, shape (situations, slots); slots >= possible outcomes of any situation.
            shares: Working space, float64, shape (slots,).
            outcomes: Working space, uint32, shape (slots,).
        """
        for situation in range(len(words)):
            used = 0
            for k in range(probabilities.shape[1]):
                if probabilities[situation, k] > 0.0:
                    shares[used] = probabilities[situation, k] * len(shares)
                    outcomes[used] = k
                    used += 1
            shares[used:] = 0.0
            outcomes[used:] = outcomes[0]
            _pair_up(shares, outcomes, words[situation])
        return version

    return fill_slots


@inlined
def _pair_up(shares: Any, outcomes: Any, words: Any) -> None:
    """Fill up the emptiest slot from the fullest one, until all are full."""
    full = 1 << THRESHOLD_BITS
    done = 2.0 * len(words)  # more than any share
    for _ in range(len(words)):
        low, high = 0, -1
        for k in range(len(words)):
            low = k if shares[k] < shares[low] else low
            if shares[k] < done and (high < 0 or shares[k] > shares[high]):
                high = k
        threshold = np.uint32(min(max(0.0, round(shares[low] * full)), full - 1.0))
        words[low] = (threshold << 2 * OUTCOME_BITS) | (outcomes[low] << OUTCOME_BITS)
        words[low] |= outcomes[high]  # the last slot is its own: low is high
        shares[high] -= 1.0 - shares[low]
        shares[low] = done
