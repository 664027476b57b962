"""The parts of a vehicle that share its CAN bus."""

from __future__ import annotations

import signal
import threading
from collections.abc import Sequence
from queue import SimpleQueue
from typing import Protocol

from auv_vessel.wire.frame import Frame


class Node(Protocol):
    """A part that receives every frame of the others, and sends its own when due.

    Nodes do not read clocks, wait or block: hosts call them, in real or in simulated time.

    Attributes:
        name: of the node, as in the bus's database.
        period: seconds from one tick to the next.
    """

    name: str
    period: float

    def hear(self, frame: Frame, now: float) -> None:
        """Take a frame of another node, in the order of the bus."""
        ...

    def tick(self, now: float) -> Sequence[Frame]:
        """Do what is due at that time, seconds; return what it has to say."""
        ...


def stopped_by_signals() -> threading.Event:
    """Return what SIGTERM and SIGINT set.

    A thread sets it: who waits for an event, or sets it, holds its lock now and then, and a signal that
    comes just then would wait for that lock without end.
    """
    stop = threading.Event()
    received: SimpleQueue[int] = SimpleQueue()

    def wait() -> None:
        received.get()
        stop.set()

    threading.Thread(target=wait, name="signals", daemon=True).start()
    for sign in (signal.SIGTERM, signal.SIGINT):
        signal.signal(sign, lambda number, _frame: received.put(number))
    return stop
