"""How finely robots are drawn: as finely as the slowest browser that looks on can bear."""

from __future__ import annotations

from enum import IntEnum

MOST_IN_FULL = 1000
"""Robots that are drawn with all their parts if every browser is quick enough."""

_FEW = 100
"""Robots that do not slow a browser down."""

SLOW, QUICK = 0.25, 0.05
"""Seconds per frame from which on robots are drawn coarser, and up to which they may be finer."""

_SETTLING = 5.0  # s until measurements are of what is drawn now
_FIRST_PATIENCE = 4.0  # s for which all must be quick before robots are drawn finer
_LATER_PATIENCE = 60.0  # the same once that was too fine; doubles with each time
_LONGEST_PAUSE = 1.0


class Detail(IntEnum):
    """How robots are drawn, the finest first."""

    FULL = 0
    SIMPLE = 1
    POINTS = 2


class DetailKeeper:
    """Draws coarser at once where a browser is slow, and finer with patience.

    A browser that is asked too much may hang before it can tell; so a large swarm begins as points
    whenever somebody comes to look.

    Attributes:
        detail: How robots are to be drawn.
        frame: Seconds per frame of the slowest browser that looks on, to be kept up to date; None
            while none has told.
    """

    def __init__(self) -> None:
        self.detail = Detail.FULL
        self.frame: float | None = None
        self._robots = self._browsers = 0
        self._since = 0.0  # s for which nothing has spoken against finer robots
        self._patience = _FIRST_PATIENCE

    @property
    def finest(self) -> Detail:
        """The finest that suits so many robots."""
        return Detail.FULL if self._robots <= MOST_IN_FULL else Detail.SIMPLE

    @property
    def coarser_than_usual(self) -> bool:
        """True if that is because a browser is not quick."""
        return self.detail > self.finest and self.frame is not None and self.frame > QUICK

    @property
    def pause(self) -> float:
        """Seconds from one drawing to the next: more than a slow browser draws is but a burden."""
        if self.frame is None or self.frame <= QUICK or self.finest is Detail.FULL:
            return 0.0
        return min(self.frame, _LONGEST_PAUSE)

    def sync(self, elapsed: float, robots: int, browsers: int) -> None:
        """Choose the detail; called by the loop once a frame.

        Args:
            elapsed: Seconds since the last call.
            robots: That are drawn.
            browsers: That are connected.
        """
        frame, other, more = self.frame, robots != self._robots, browsers > self._browsers
        self._robots, self._browsers = robots, browsers
        if other or (more and self.finest is not Detail.FULL):
            self._patience = _FIRST_PATIENCE
            self._take(self.finest if self.finest is Detail.FULL else Detail.POINTS)
        self._since += elapsed
        if frame is None or self._since < _SETTLING:
            return
        if frame > SLOW and robots > _FEW and self.detail < Detail.POINTS:
            self._patience = max(_LATER_PATIENCE, 2.0 * self._patience)
            self._take(Detail(self.detail + 1))
        elif frame > QUICK:
            self._since = _SETTLING
        elif self.detail > self.finest and self._since >= _SETTLING + self._patience:
            self._take(Detail(self.detail - 1))

    def _take(self, detail: Detail) -> None:
        self.detail = detail
        self._since = 0.0
