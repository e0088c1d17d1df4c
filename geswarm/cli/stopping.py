"""What long commands share: they stop cleanly, and write a line now and then."""

from __future__ import annotations

import math
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geswarm.sim import Scenario

STOPPED_STATUS = 130


def every(seconds: float) -> Callable[[], bool]:
    """A question that is answered yes at most once in so many seconds."""
    last = -math.inf

    def due() -> bool:
        nonlocal last
        now = time.monotonic()
        if now - last < seconds:
            return False
        last = now
        return True

    return due


@contextmanager
def stop_on_signals() -> Iterator[threading.Event]:
    """An event that Ctrl-C and SIGTERM set; a second Ctrl-C ends the program at once."""
    stop = threading.Event()

    def ask_to_stop(number: int, _frame: object) -> None:
        if stop.is_set() and number == signal.SIGINT:
            raise KeyboardInterrupt
        stop.set()

    with _on_signals(ask_to_stop):
        yield stop


def compile_first(last_words: str, *scenarios: Scenario, interactive: bool = False) -> None:
    """Compile the simulator unless that has been done; Ctrl-C and SIGTERM end the program there.

    They end it without ado, as the compiler loses or prints exceptions.

    Args:
        last_words: Written to stderr then.
        *scenarios: For which; none means `paper`.
        interactive: Whether a `World` is going to be run, too.
    """
    from geswarm.sim import is_compiled, warm_up

    def end(_number: int, _frame: object) -> None:
        with suppress(OSError):
            os.write(2, f"{last_words}\n".encode())
        os._exit(STOPPED_STATUS)

    for scenario in scenarios or (None,):
        if not is_compiled(scenario, interactive=interactive):
            with _on_signals(end):
                warm_up(scenario=scenario, interactive=interactive)


@contextmanager
def _on_signals(handle: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Handle Ctrl-C and SIGTERM in another way for a while."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number in before:
        signal.signal(number, handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
