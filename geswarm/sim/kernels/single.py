"""Single-precision functions that become a few vector instructions: no branches, no calls.

Bounds of the errors are the largest found against double precision over the whole range.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import types
from numba.extending import intrinsic

from geswarm.sim.kernels.jit import inlined

F, I, U = np.float32, np.int32, np.uint32  # noqa: E741
"""Conversions: numba widens the result of every operation on 32-bit integers to 64 bits, and the
wider number would halve the lanes of a vector."""

ZERO, HALF, ONE, TWO = F(0.0), F(0.5), F(1.0), F(2.0)
_QUARTER_TURN, _HALF_TURN = F(math.pi / 2.0), F(math.pi)
_PER_TURN = F(0.5 / math.pi)
_PER_2_24 = F(2.0**-24)
_BEHIND = F(1e-6)  # straight behind: the sine of half a turn is 0 but for rounding

_A0, _A1, _A2 = F(0.99999434), F(0.16695926), F(0.07070501)  # minimax, arcsine up to sqrt(1/2)
_A3, _A4, _A5 = F(0.07104285), F(-0.04452855), F(0.11112715)
_C1, _C2, _C3, _C4, _C5 = (F((-1) ** k / math.factorial(2 * k)) for k in range(1, 6))
_S1, _S2, _S3, _S4, _S5 = (F((-1) ** k / math.factorial(2 * k + 1)) for k in range(1, 6))


def _fma(_context: Any, _a: Any, _b: Any, _c: Any) -> Any:
    """Signature and code of `fma`."""

    def generate(_: Any, builder: Any, _signature: Any, numbers: Any) -> Any:
        return builder.fma(*numbers)

    return types.float32(types.float32, types.float32, types.float32), generate


fma: Any = intrinsic(_fma)
"""fma(a, b, c) is a * b + c, rounded once: one instruction, the same bits wherever it runs."""


@inlined
def above_zero(x: Any) -> Any:
    """The number, or 0 if it is negative."""
    return x if x > ZERO else ZERO


@inlined
def within(x: Any, reach: Any) -> Any:
    """The number, or the nearer end of [-reach, reach]."""
    x = x if x < reach else reach
    return x if x > -reach else -reach


@inlined
def fraction(bits: Any) -> Any:
    """A uniform random number in [0, 1) from random bits."""
    return F(I(U(bits) >> U(8))) * _PER_2_24


@inlined
def inverse_root(x: Any) -> Any:
    """1 / sqrt(x) to 5e-6 of its value; large and finite for 0.

    Halving the exponent gives a first guess; two Newton steps follow.
    """
    y = I(I(0x5F375A86) - I(F(x).view(np.int32) >> I(1))).view(np.float32)
    half = HALF * x
    y = y * fma(-half * y, y, F(1.5))
    return y * fma(-half * y, y, F(1.5))


@inlined
def cos_sin(angle: Any) -> tuple[Any, Any]:
    """Cosine and sine to 6e-7, for angles in [-pi/2, pi/2]."""
    q = angle * angle
    cos = fma(q, fma(q, fma(q, fma(q, fma(q, _C5, _C4), _C3), _C2), _C1), ONE)
    sin = fma(q, fma(q, fma(q, fma(q, fma(q, _S5, _S4), _S3), _S2), _S1), ONE)
    return cos, angle * sin


@inlined
def heading(bits: Any) -> tuple[Any, Any]:
    """Uniformly random unit vector from random bits, by half its angle; its length is 1 to 1e-6."""
    cos, sin = cos_sin(F(I(bits)) * F(math.pi / 2.0**32))
    return fma(-TWO * sin, sin, ONE), TWO * sin * cos


@inlined
def angle_of(cos: Any, sin: Any) -> Any:
    """Angle of a unit vector, in [-pi, pi], to 3e-6; what is straight behind is to the left.

    The smaller coordinate is the sine of an angle of at most pi/4; which one it is, and the signs,
    say in which eighth of the circle the vector lies.
    """
    along, across = abs(cos), abs(sin)
    low = across if across < along else along
    q = low * low
    angle = low * fma(q, fma(q, fma(q, fma(q, fma(q, _A5, _A4), _A3), _A2), _A1), _A0)
    angle = angle if across < along else _QUARTER_TURN - angle
    angle = angle if cos >= ZERO else _HALF_TURN - angle
    return angle if sin >= -_BEHIND else -angle


@inlined
def half_turns(angle: Any) -> Any:
    """The same angle in [-pi, pi], for angles of some turns."""
    nearest = fma(angle, _PER_TURN, HALF if angle >= ZERO else -HALF)
    return fma(F(I(nearest)), -TWO * _HALF_TURN, angle)
