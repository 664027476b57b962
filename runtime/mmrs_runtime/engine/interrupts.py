"""Interrupts of a process that stop its robots."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from .orders import STOP, Orders


@contextmanager
def stopping(orders: Orders, robots: tuple[str, ...], say: Callable[[str], None]) -> Iterator[None]:
    """Stop the robots on the first interrupt; the second one ends the wait for them.

    A terminal that closes gives no order: robots continue. Outside the main thread, which alone receives
    signals, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    seen: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        seen.append(number)
        if len(seen) > 1:
            raise KeyboardInterrupt
        orders.give(STOP, robots, interrupt=True)
        say("stopping; interrupt again to end without waiting for robots, and those that pilots have")

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    if hasattr(signal, "SIGHUP"):
        before[signal.SIGHUP] = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
