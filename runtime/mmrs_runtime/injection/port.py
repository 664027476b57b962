"""A port that loses, delays, doubles or damages pieces, as injected.

A piece is what is read or written at once: a datagram over UDP, any bytes received over TCP and from
serial devices.
"""

from __future__ import annotations

import heapq
import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from random import Random

from ..clock import Clock
from ..ports import NOTHING, Address, Port, Received
from .spec import Injection


class Line:
    """One direction of a link, and what becomes of the pieces that pass.

    Attributes:
        counts: by fault, how many pieces it concerned.
    """

    def __init__(self, faults: Sequence[Injection], clock: Clock, seed: str) -> None:
        """Pass pieces by the clock; equal seeds do the same to equal pieces."""
        self.counts: Counter[str] = Counter()
        self._faults = faults
        self._clock = clock
        self._random = Random(seed)

    def passing(self, piece: bytes) -> list[tuple[float, bytes]]:
        """Return what arrives of a piece: (second of the run, bytes), none, one or two of them."""
        now = self._clock.now()
        if any(fault.name.startswith("cut") and fault.acts(now) for fault in self._faults):
            self.counts["cut"] += 1
            return []
        if self._happens("loss"):
            return []
        if self._happens("corrupt"):
            piece = self._damaged(piece)
        copies = 2 if self._happens("duplicate") else 1
        return [(now + self._delay(), piece) for _ in range(copies)]

    def _happens(self, name: str) -> bool:
        happens = any(self._random.random() < fault.amount for fault in self._faults if fault.name == name)
        self.counts[name] += happens
        return happens

    def _damaged(self, piece: bytes) -> bytes:
        bit = self._random.randrange(8 * len(piece))
        damaged = bytearray(piece)
        damaged[bit // 8] ^= 1 << bit % 8
        return bytes(damaged)

    def _delay(self) -> float:
        delays = (
            fault.amount + self._random.uniform(-fault.spread, fault.spread)
            for fault in self._faults
            if fault.name == "delay"
        )
        return sum(delays)


class InjectedPort:
    """A port with a line in each direction in front of it."""

    def __init__(
        self,
        port: Port,
        clock: Clock,
        incoming: Line,
        outgoing: Line,
        report: Callable[[Mapping[str, int]], None],
    ) -> None:
        """Put the lines in front of an open port; `report` gets the counts when it is closed."""
        self._port = port
        self._clock = clock
        self._incoming, self._outgoing = incoming, outgoing
        self._report = report
        self._arriving = _Queue()
        self._leaving = _Queue()
        self._changed = threading.Condition()
        self._open = True
        self._sender = threading.Thread(target=self._send_late, name="late pieces", daemon=True)
        self._sender.start()

    def read(self, seconds: float) -> Received:
        """Return the next piece that arrives."""
        until = time.monotonic() + seconds
        while True:
            piece = self._arriving.due(self._clock.now())
            left = until - time.monotonic()
            if piece is not None or left <= 0.0:
                return piece or NOTHING
            wait = min(left, self._clock.real(self._arriving.next() - self._clock.now()))
            data, sender = self._port.read(wait)
            for when, copy in self._incoming.passing(data) if data else ():
                self._arriving.add(when, Received(copy, sender))

    def write(self, data: bytes, to: Address | None = None) -> object:
        """Send a piece, now or when its delay is over."""
        with self._changed:
            for when, copy in self._outgoing.passing(bytes(data)) if data else ():
                self._leaving.add(when, Received(copy, to))
            if self._leaving.next() <= self._clock.now():
                self._send_due()
            self._changed.notify_all()
        return None

    def close(self) -> None:
        """Close the port; what is still in transit is lost."""
        with self._changed:
            self._open = False
            self._changed.notify_all()
        self._sender.join()
        self._port.close()
        self._report(self._incoming.counts + self._outgoing.counts)

    def _send_late(self) -> None:
        with self._changed:
            while self._open:
                # A delayed piece that the port does not take is lost, as it would be on its way.
                with suppress(OSError):
                    self._send_due()
                wait = self._clock.real(self._leaving.next() - self._clock.now())
                self._changed.wait(min(wait, 60.0))

    def _send_due(self) -> None:
        while (piece := self._leaving.due(self._clock.now())) is not None:
            self._port.write(*piece)


class _Queue:
    """Pieces, with whom they come from or go to, in the order in which they are due."""

    def __init__(self) -> None:
        self._pieces: list[tuple[float, int, Received]] = []
        self._count = 0

    def add(self, when: float, piece: Received) -> None:
        self._count += 1
        heapq.heappush(self._pieces, (when, self._count, piece))

    def next(self) -> float:
        return self._pieces[0][0] if self._pieces else float("inf")

    def due(self, now: float) -> Received | None:
        return heapq.heappop(self._pieces)[2] if self.next() <= now else None
