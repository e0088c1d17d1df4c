"""How simulated time follows the clock on the wall."""

from __future__ import annotations

import math

SPEEDS = (1.0, 5.0, 10.0, 50.0, math.inf)
"""Simulated seconds per second; infinity means as fast as possible."""

_LONGEST_FRAME = 0.25  # s: after a hang the swarm goes on, it does not catch up


def clock(seconds: float) -> str:
    """A time in minutes and seconds: `85:12`."""
    return "{}:{:02d}".format(*divmod(int(seconds), 60))


class Playback:
    """Decides how many control steps each frame of the display makes.

    Attributes:
        playing: False while paused.
        speed: One of `SPEEDS`.
    """

    def __init__(self, step_seconds: float) -> None:
        self.playing = False
        self.speed = 1.0
        self._step_seconds = step_seconds
        self._due = 0.0  # simulated seconds that the display is ahead of the last whole step

    @property
    def fraction(self) -> float:
        """How far the display is between the last step and the next, 0 to 1."""
        return 1.0 if math.isinf(self.speed) else min(self._due / self._step_seconds, 1.0)

    def restart(self) -> None:
        """Show the last whole step, nothing of the next."""
        self._due = 0.0

    def steps_due(self, elapsed: float) -> int | None:
        """Control steps to make after `elapsed` wall seconds; None: as many as time allows."""
        if not self.playing:
            return 0
        if math.isinf(self.speed):
            self._due = 0.0
            return None
        self._due += min(elapsed, _LONGEST_FRAME) * self.speed
        steps = int(self._due / self._step_seconds)
        self._due -= steps * self._step_seconds
        return steps
