"""Where the camera stands so that the whole arena is in the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FIELD_OF_VIEW = math.radians(30.0)
"""Vertical; narrow, so that near and far robots are drawn at nearly the same size."""

ELEVATION = math.radians(52.0)
FORWARD = np.array((0.0, math.cos(ELEVATION), -math.sin(ELEVATION)))
"""The way that the camera looks."""

NEAREST = 0.2
"""Nothing nearer than this is drawn, m; the larger, the better are flat layers told apart."""

FARTHEST, NOTHING = 1000.0, 1.5
"""Nothing farther than this is drawn, m: usually, and so that only the backdrop is drawn."""

USUAL_ASPECT = 1.35
"""Width by height of the picture, where it is not known."""

_MARGIN = 1.06


@dataclass(frozen=True, eq=False)
class CameraPose:
    """A camera that looks north, with north up in the picture.

    Attributes:
        position: Shape (3,), metres.
        look_at: Shape (3,), metres.
    """

    position: npt.NDArray[np.float64]
    look_at: npt.NDArray[np.float64]

    def is_at(self, position: npt.NDArray[np.float64]) -> bool:
        """True if a camera there is this one, but for rounding on the way."""
        return bool(np.allclose(position, self.position, atol=0.01))


def framing(corners: npt.NDArray[np.float64], aspect: float = USUAL_ASPECT) -> CameraPose:
    """The nearest pose, seen obliquely from the south, with every corner in the picture.

    Args:
        corners: Points that must be seen, shape (n, 3), metres.
        aspect: Width of the picture divided by its height.
    """
    up = np.array((0.0, math.sin(ELEVATION), math.cos(ELEVATION)))
    vertical = math.tan(FIELD_OF_VIEW / 2) / _MARGIN
    horizontal = vertical * aspect
    middle = (corners[:, 0].min() + corners[:, 0].max()) / 2
    x, height, depth = corners[:, 0] - middle, corners @ up, corners @ FORWARD
    # A camera at (0, h, d) in the frame (east, up, forward) sees a point below the upper edge if
    # height - h <= vertical (depth - d), and so on: the four edges give h and the largest d.
    top = np.min(vertical * depth - height)
    bottom = np.min(vertical * depth + height)
    d = min((top + bottom) / (2 * vertical), np.min(depth - np.abs(x) / horizontal))
    h = (bottom - top) / 2
    position = h * up + d * FORWARD + np.array((middle, 0.0, 0.0))
    distance = float(np.mean(depth)) - d
    return CameraPose(position, position + distance * FORWARD)
