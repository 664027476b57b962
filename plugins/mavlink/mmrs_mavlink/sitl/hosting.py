"""The thread that advances simulated vehicles."""

from __future__ import annotations

import selectors
import threading
import time
from collections.abc import Sequence
from typing import Protocol

TICK_SECONDS = 0.05
SHORTEST_TICK = 0.01
LONGEST_STEP = 0.25
"""Longest step in real seconds, so that vehicles do not jump when their process was suspended."""


class Socket(Protocol):
    """What a selector can wait for."""

    def fileno(self) -> int:
        """Return the number of the file."""
        ...


class Hosted(Protocol):
    """A vehicle that a host advances."""

    speedup: float

    @property
    def radios(self) -> Sequence[Socket]:
        """Return what the vehicle receives by."""
        ...

    def receive(self) -> None:
        """Process what has arrived."""
        ...

    def advance(self, real_seconds: float) -> None:
        """Simulate the time of so much real time."""
        ...


class Host:
    """Advances vehicles in ticks, and has them process messages as these arrive.

    Attributes:
        failure: the exception that has ended it; None: it has not failed.
    """

    def __init__(self, vehicles: Sequence[Hosted]) -> None:
        self.failure: Exception | None = None
        self._vehicles = vehicles
        fastest = max((each.speedup for each in vehicles), default=1.0)
        self._tick = max(SHORTEST_TICK, TICK_SECONDS / fastest)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated vehicles", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread; the vehicles keep their state."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            with selectors.DefaultSelector() as selector:
                for vehicle in self._vehicles:
                    for radio in vehicle.radios:
                        selector.register(radio, selectors.EVENT_READ, vehicle)
                self._simulate(selector)
        except Exception as error:
            self.failure = error

    def _simulate(self, selector: selectors.BaseSelector) -> None:
        last = time.monotonic()
        while not self._stopping.is_set():
            left = last + self._tick - time.monotonic()
            if left > 0.0:
                for key, _ in selector.select(left):
                    key.data.receive()
                continue
            now = time.monotonic()
            for vehicle in self._vehicles:
                vehicle.advance(min(now - last, LONGEST_STEP))
            last = now
