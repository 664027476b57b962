"""Callers of a server on this machine: few at a time, and none for long that says nothing of use."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from .clock import SIGNAL_SECONDS


class Callers:
    """Takes connections, and hangs up on those that do not show in time that they may speak.

    Whatever a caller sends, it counts as silent until it is served. A newcomer never waits for the
    silent: when there is no more room, the one that has been silent for longest goes.
    """

    def __init__(
        self,
        server: socket.socket,
        most: int,
        seconds: float,
        refusal: bytes = b"",
        *,
        tick: float = SIGNAL_SECONDS,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """Take callers of a socket that listens.

        Args:
            server: the socket.
            most: callers at a time.
            seconds: that a caller may be silent, however much of a line it sends meanwhile.
            refusal: sent to a caller for whom there is no room.
            tick: seconds between two checks for callers that were silent for too long.
            now: the clock.
        """
        server.settimeout(tick)
        self._server, self._most, self._seconds, self._refusal, self._now = (
            server,
            most,
            seconds,
            refusal,
            now,
        )
        self._silent: dict[socket.socket, float] = {}
        self._served: set[socket.socket] = set()
        self._lock = threading.Condition()

    def take(self) -> socket.socket | None:
        """Return the next caller; None if none came within a tick, or all that there is room for are served.

        Raises:
            OSError: the socket is closed, or the system has no more connections.
        """
        self.dismiss()
        try:
            caller, _ = self._server.accept()
        except TimeoutError:
            return None
        with self._lock:
            if len(self._served) >= self._most:
                self._refuse(caller)
                return None
            if len(self._served) + len(self._silent) >= self._most:
                self._dismiss_first()
            self._silent[caller] = self._now()
        return caller

    def dismiss(self) -> None:
        """Stop reading callers that were silent for too long: their lines end."""
        with self._lock:
            while self._silent and self._now() - next(iter(self._silent.values())) >= self._seconds:
                self._dismiss_first()

    @contextmanager
    def served(self, caller: socket.socket) -> Iterator[None]:
        """Count a caller as served, even one that was dismissed just now; its silence counts from the end."""
        with self._lock:
            self._silent.pop(caller, None)
            self._served.add(caller)
        try:
            yield
        finally:
            with self._lock:
                self._served.discard(caller)
                self._silent[caller] = self._now()
                self._lock.notify_all()

    def finish(self, seconds: float) -> None:
        """Wait until no caller is served any more, at most for that long."""
        with self._lock:
            self._lock.wait_for(lambda: not self._served, seconds)

    def leave(self, caller: socket.socket) -> None:
        """Forget a caller that has gone."""
        with self._lock:
            self._silent.pop(caller, None)

    def _refuse(self, caller: socket.socket) -> None:
        with caller, suppress(OSError):  # it has gone already
            caller.setblocking(False)
            caller.send(self._refusal)

    def _dismiss_first(self) -> None:
        first = next(iter(self._silent))
        del self._silent[first]
        with suppress(OSError):  # it has gone already
            first.shutdown(socket.SHUT_RD)
