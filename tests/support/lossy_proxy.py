"""A stretch of network in which datagrams are lost, doubled and late."""

from __future__ import annotations

import heapq
import random
import select
import socket
import threading
import time

LARGEST = 65_535
GLANCE_SECONDS = 0.02


class LossyProxy:
    """Passes UDP datagrams between whoever speaks to its port first, and an address; a context.

    Attributes:
        port: where to speak to.
        passed, lost, doubled: how many datagrams.
    """

    def __init__(
        self, to: tuple[str, int], *, loss: float = 0.0, double: float = 0.0, late: float = 0.0, seed: int = 0
    ) -> None:
        """Prepare it.

        Args:
            to: address of the other side.
            loss: part of the datagrams that is lost, either way.
            double: part that comes twice.
            late: seconds that they may be late at most, so that later ones overtake them.
            seed: of the chance.
        """
        self.passed = self.lost = self.doubled = 0
        self._to = to
        self._chance = (loss, double, late)
        self._random = random.Random(seed)
        self._near = _socket()
        self._far = _socket()
        self.port = self._near.getsockname()[1]
        self._from: tuple[str, int] | None = None
        self._waiting: list[tuple[float, int, bytes, bool]] = []
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="lossy proxy", daemon=True)

    def __enter__(self) -> LossyProxy:
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._ending.set()
        self._thread.join()
        self._near.close()
        self._far.close()

    def _run(self) -> None:
        while not self._ending.is_set():
            ready, _, _ = select.select([self._near, self._far], [], [], GLANCE_SECONDS)
            for each in ready:
                data, sender = each.recvfrom(LARGEST)
                if each is self._near:
                    self._from = sender
                self._take(data, outwards=each is self._near)
            self._pass_on()

    def _take(self, data: bytes, *, outwards: bool) -> None:
        loss, double, late = self._chance
        if self._random.random() < loss:
            self.lost += 1
            return
        copies = 2 if self._random.random() < double else 1
        self.doubled += copies - 1
        for _ in range(copies):
            self.passed += 1
            due = time.monotonic() + self._random.random() * late
            heapq.heappush(self._waiting, (due, self.passed, data, outwards))

    def _pass_on(self) -> None:
        while self._waiting and self._waiting[0][0] <= time.monotonic():
            _, _, data, outwards = heapq.heappop(self._waiting)
            if outwards:
                self._far.sendto(data, self._to)
            elif self._from is not None:
                self._near.sendto(data, self._from)


def _socket() -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", 0))
    return made
