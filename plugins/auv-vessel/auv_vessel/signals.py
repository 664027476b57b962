"""Ends a process in order when it is told to end."""

from __future__ import annotations

import signal
import threading
from queue import SimpleQueue


def stopped_by_signals() -> threading.Event:
    """Return what SIGTERM and SIGINT set.

    A thread sets it: who waits for an event, or sets it, holds its lock now and then, and a signal that
    comes just then would wait for that lock for ever.
    """
    stop = threading.Event()
    told: SimpleQueue[int] = SimpleQueue()

    def heed() -> None:
        told.get()
        stop.set()

    threading.Thread(target=heed, name="signals", daemon=True).start()
    for sign in (signal.SIGTERM, signal.SIGINT):
        signal.signal(sign, lambda number, _frame: told.put(number))
    return stop
