"""A carrier of the bus that loses, delays or doubles messages, or is cut for a while, as injected."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from random import Random

from ..bus.carriers.carrier import Answered, Carrier, Station
from ..clock import Clock
from .spec import Injection

UNREAD = ""
"""An unreadable answer, which counts as none."""


class InjectedCarrier:
    """A carrier with faults in front of it; `cut` and `mend` are called when it is time."""

    def __init__(self, carrier: Carrier, faults: Sequence[Injection], clock: Clock, seed: str) -> None:
        """Put faults in front of a carrier that is not open yet; `seed` is of what is left to chance."""
        self._carrier = carrier
        self._faults = faults
        self._clock = clock
        self._random = Random(seed)
        self._gate: _Gate | None = None
        self._here: set[str] = set()
        self._lock = threading.RLock()
        self._cut = False

    def open(self, station: Station) -> None:
        """Begin to serve, and to notice who is there."""
        self._gate = _Gate(station, lambda: self._cut)
        self._carrier.open(self._gate)

    def ask(self, sender: str, owner: str, request: str, answered: Answered) -> None:
        """Send a request, as well as the faults let it through."""
        self._pass(lambda: self._carrier.ask(sender, owner, request, self._late(answered)))

    def appear(self, robot: str) -> None:
        """Announce that a robot of this process is reachable, unless the bus is cut."""
        with self._lock:
            self._here.add(robot)
            if not self._cut:
                self._carrier.appear(robot)

    def vanish(self, robot: str) -> None:
        """Announce that a robot of this process is unreachable."""
        with self._lock:
            self._here.discard(robot)
            self._carrier.vanish(robot)

    def publish(self, robot: str) -> None:
        """Publish to observers that the state of a robot's slots has changed, unless the bus is cut."""
        if not self._cut:
            self._carrier.publish(robot)

    def close(self) -> None:
        """Stop."""
        self._carrier.close()

    def cut(self) -> None:
        """Let nothing through: robots of this process and all others lose sight of each other."""
        with self._lock:
            self._cut = True
            for robot in sorted(self._here):
                self._carrier.vanish(robot)
        if self._gate is not None:
            self._gate.see(False)

    def mend(self) -> None:
        """Let everything through again."""
        with self._lock:
            self._cut = False
            for robot in sorted(self._here):
                self._carrier.appear(robot)
        if self._gate is not None:
            self._gate.see(True)

    def _late(self, answered: Answered) -> Answered:
        return lambda answer: self._pass(lambda: answered(answer))

    def _pass(self, message: Callable[[], None]) -> None:
        """Do what a message does: not at all, late, or twice."""
        if self._cut or self._happens("bus-loss"):
            return
        for _ in range(2 if self._happens("bus-duplicate") else 1):
            wait = self._clock.real(self._delay())
            if wait <= 0.0:
                message()
                continue
            timer = threading.Timer(wait, message)
            timer.daemon = True
            timer.start()

    def _happens(self, name: str) -> bool:
        with self._lock:
            return any(self._random.random() < fault.amount for fault in self._faults if fault.name == name)

    def _delay(self) -> float:
        with self._lock:
            return sum(
                fault.amount + self._random.uniform(-fault.spread, fault.spread)
                for fault in self._faults
                if fault.name == "bus-delay"
            )


class _Gate:
    """The process's end of the bus, as the carrier behind the faults sees it."""

    def __init__(self, station: Station, cut: Callable[[], bool]) -> None:
        self._station = station
        self._cut = cut
        self._there: set[str] = set()
        self._lock = threading.Lock()

    def serve(self, owner: str, sender: str, request: str) -> str:
        return UNREAD if self._cut() else self._station.serve(owner, sender, request)

    def noticed(self, robot: str, here: bool) -> None:
        with self._lock:
            (self._there.add if here else self._there.discard)(robot)
        if not self._cut():
            self._station.noticed(robot, here)

    def stranger(self, robot: str, here: bool) -> None:
        self._station.stranger(robot, here)

    def shown(self, robot: str) -> str:
        return self._station.shown(robot)

    def see(self, here: bool) -> None:
        with self._lock:
            there = sorted(self._there)
        for robot in there:
            self._station.noticed(robot, here)
