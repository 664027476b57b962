"""One thread that keeps any number of simulated vehicles going."""

from __future__ import annotations

import selectors
import threading
import time
from collections.abc import Callable, Sequence
from typing import Protocol

TICK_SECONDS = 0.05
SHORTEST_TICK = 0.01
LONGEST_STEP = 0.25
"""Real seconds that vehicles go on at most at once: a process that was held up does not make them leap."""


class Socket(Protocol):
    """What a selector can wait for."""

    def fileno(self) -> int:
        """Return its number."""
        ...


class Hosted(Protocol):
    """What a host keeps going."""

    speedup: float

    @property
    def radios(self) -> Sequence[Socket]:
        """Return where something may come."""
        ...

    def hear(self) -> None:
        """Answer what has come."""
        ...

    def go_on(self, real_seconds: float) -> None:
        """Let time pass."""
        ...


class Host:
    """Keeps vehicles going: what comes is answered at once, and time passes in ticks.

    Attributes:
        failure: what has ended this before its time; None: nothing has.
    """

    def __init__(self, vehicles: Sequence[Hosted]) -> None:
        """Be ready to keep these vehicles going."""
        self.failure: Exception | None = None
        self._vehicles = vehicles
        self._tick = max(SHORTEST_TICK, TICK_SECONDS / max((each.speedup for each in vehicles), default=1.0))
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated vehicles", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End; the vehicles stay as they are."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            self._keep_going()
        except Exception as error:
            self.failure = error

    def _keep_going(self) -> None:
        with selectors.DefaultSelector() as selector:
            for vehicle in self._vehicles:
                for radio in vehicle.radios:
                    selector.register(radio, selectors.EVENT_READ, vehicle.hear)
            last = time.monotonic()
            while not self._stopping.is_set():
                self._answer(selector, last + self._tick)
                now = time.monotonic()
                for vehicle in self._vehicles:
                    vehicle.go_on(min(now - last, LONGEST_STEP))
                last = now

    def _answer(self, selector: selectors.BaseSelector, until: float) -> None:
        while not self._stopping.is_set():
            left = until - time.monotonic()
            if left <= 0.0:
                return
            for key, _ in selector.select(left):
                hear: Callable[[], None] = key.data
                hear()
