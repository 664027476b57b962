"""Messages of one vehicle: the latest of each name, and collections of all."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from typing import Any

from mmrs_runtime.clock import Clock

LATE_FRAMES = 64
"""How many frames of the vehicle may have overtaken one that is late."""

OVERTAKEN_SECONDS, LEAST_OVERTAKEN_SECONDS = 1.0, 0.5
"""For how long, of the run and real at least: frames are counted to 255 only, and after a gap what is new
may look as if it were late."""

FRAMES = 256


class Numbering:
    """Counts the frames of one vehicle."""

    def __init__(self, clock: Clock) -> None:
        """Create without messages; `clock` is that of the run."""
        self._clock = clock
        self._newest, self._newest_at = -1, -inf

    def number(self, seq: int) -> int:
        """Return which of the vehicle's frames one is, by its number, which is counted to 255 only."""
        now = self._clock.now()
        recent = now - self._newest_at <= self._clock.patience(OVERTAKEN_SECONDS, LEAST_OVERTAKEN_SECONDS)
        behind = (self._newest - seq) % FRAMES
        if recent and behind <= LATE_FRAMES:
            return self._newest - behind
        self._newest, self._newest_at = self._newest + FRAMES - behind, now
        return self._newest


Message = Any

ANYBODY = 0
"""Stands for every component of the vehicle's system."""

OF_ALL = frozenset(
    {
        "CAMERA_FEEDBACK",
        "CAMERA_IMAGE_CAPTURED",
        "COLLISION",
        "DISTANCE_SENSOR",
        "NAMED_VALUE_FLOAT",
        "OBSTACLE_DISTANCE",
        "RADIO_STATUS",
    }
)
"""Messages that count as the vehicle's whichever of its components sends them."""


class Messages:
    """Keeps messages as they come, and knows which of them are news."""

    def __init__(self, lock: threading.Condition, clock: Clock) -> None:
        """Create without messages.

        Args:
            lock: guards everything here; held while messages are taken.
            clock: of the run.
        """
        self._lock, self._clock = lock, clock
        self._numbering = Numbering(clock)
        self._latest: dict[str, tuple[Message, float]] = {}
        self._orders: dict[str, int] = {}
        self._inboxes: list[tuple[frozenset[str], int, deque[Message]]] = []
        self._trails: list[tuple[str, deque[Message]]] = []

    def latest(self, kind: str) -> Message | None:
        """Return the last message of that name."""
        found = self._latest.get(kind)
        return found[0] if found else None

    def since(self, kind: str) -> float:
        """Return how long ago the last message of that name came, in seconds; inf if none did."""
        found = self._latest.get(kind)
        return self._clock.now() - found[1] if found else float("inf")

    def order(self, kind: str) -> int:
        """Return which of the vehicle's frames the last message of that name was; -1 before one came.

        Of two messages the one with the larger number was sent later, whichever has come first.
        """
        return self._orders.get(kind, -1)

    @contextmanager
    def inbox(self, kinds: frozenset[str], component: int) -> Iterator[deque[Message]]:
        """Collect every message of these names from now on that a component has sent."""
        entry = (kinds, component, deque[Message]())
        with self._lock:
            self._inboxes.append(entry)
        try:
            yield entry[2]
        finally:
            with self._lock:
                self._inboxes = [other for other in self._inboxes if other is not entry]

    @contextmanager
    def trail(self, kind: str) -> Iterator[deque[Message]]:
        """Collect every message of that name that is news, from now on, in the order they were sent in."""
        entry = (kind, deque[Message]())
        with self._lock:
            self._trails.append(entry)
        try:
            yield entry[1]
        finally:
            with self._lock:
                self._trails = [other for other in self._trails if other is not entry]

    def put(self, message: Message) -> None:
        """Take a message for the latest of its name; to be called with the lock."""
        self._latest[message.get_type()] = (message, self._clock.now())

    def take(self, message: Message, *, own: bool) -> None:
        """Take a message from the vehicle's system; to be called with the lock.

        Args:
            message: from any of its components.
            own: whether the autopilot has sent it.
        """
        kind = message.get_type()
        if (own and self._is_news(message)) or (kind in OF_ALL and not own):
            self.put(message)
            for wanted, collected in self._trails:
                if kind == wanted:
                    collected.append(message)
        for kinds, component, collected in self._inboxes:
            if kind in kinds and component in (ANYBODY, message.get_srcComponent()):
                collected.append(message)

    def _is_news(self, message: Message) -> bool:
        """Return whether no message of that name has come that the vehicle sent later.

        What messages of other names have overtaken is news all the same: where each frame takes as long
        as it likes, most are overtaken by some other.
        """
        kind, order = message.get_type(), self._numbering.number(message.get_seq())
        if order < self._orders.get(kind, -1):
            return False
        self._orders[kind] = order
        return True


def tells_place(message: Message) -> bool:
    """Return whether a GLOBAL_POSITION_INT or LOCAL_POSITION_NED holds the vehicle's position.

    ArduPilot sends 0 degrees north, 0 degrees east until it knows its position, with the right height.
    """
    return message.get_type() != "GLOBAL_POSITION_INT" or bool(message.lat or message.lon)
