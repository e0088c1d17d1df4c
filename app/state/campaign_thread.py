"""A campaign in the background: a thread that is started, stopped and listened to."""

from __future__ import annotations

import threading
import time
from pathlib import Path

from geswarm.analysis.reproduction import Campaign, CampaignError
from geswarm.ge import StoreError
from geswarm.sim import EvaluationStopped

from .evolution import Phase


class CampaignThread:
    """At most one campaign at a time, off the loop's thread.

    Attributes are written by the campaign's thread and read by the loop.

    Attributes:
        workers: Threads that simulate; leave one core to the arena.
        phase: What it is doing; it cannot be paused.
        error: Why it failed, else empty.
        directory: Of the present or last campaign.
        share: Of all its work that is done.
        doing: What is being done.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self.phase = Phase.IDLE
        self.error = ""
        self.directory: Path | None = None
        self.share = 0.0
        self.doing = ""
        self._began: tuple[float, float] | None = None
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def active(self) -> bool:
        """A campaign is under way."""
        return self.phase is Phase.RUNNING

    @property
    def seconds_left(self) -> float | None:
        """As long as it will take if it goes on as it did since it was started; None: unknown."""
        began, share = self._began, self.share
        if not self.active or began is None or share <= began[1]:
            return None
        return (1 - share) * (time.monotonic() - began[0]) / (share - began[1])

    def start(self, campaign: Campaign) -> None:
        """Begin or continue a campaign; one under way is stopped first."""
        self.stop()
        self._stop, self._began = threading.Event(), None
        self.error, self.directory = "", campaign.directory
        self.share, self.doing = 0.0, ""
        self.phase = Phase.RUNNING
        self._thread = threading.Thread(
            target=self._work, args=(campaign, self._stop), name="campaign", daemon=True
        )
        self._thread.start()

    def stop(self, timeout: float = 10.0) -> None:
        """End it; it can go on later."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout)

    def _work(self, campaign: Campaign, stop: threading.Event) -> None:
        try:
            campaign.run(self.workers, on_progress=self._hear, stop=stop.is_set)
            self.phase = Phase.FINISHED
        except EvaluationStopped:
            self.phase = Phase.STOPPED
        except (CampaignError, StoreError) as error:
            self.error = str(error)
            self.phase = Phase.FAILED
        except Exception as error:  # whatever it is: the arena goes on and the user is told
            self.error = f"{type(error).__name__}: {error}"
            self.phase = Phase.FAILED

    def _hear(self, share: float, doing: str) -> None:
        if self._began is None:
            self._began = time.monotonic(), share
        self.share, self.doing = share, doing
