"""Whoever wants to know that something may have changed is told, from whatever thread."""

from __future__ import annotations

import threading
from collections.abc import Callable

from .troubles import Net


class Changes:
    """Tells of changes, also those who wait for one."""

    def __init__(self, lock: threading.Condition, net: Net) -> None:
        """Tell nobody yet.

        Args:
            lock: guards what changes; signalled with every change.
            net: catches what those who are told raise.
        """
        self._lock, self._net = lock, net
        self._callbacks: list[Callable[[], None]] = []

    def on(self, callback: Callable[[], None]) -> None:
        """Have a function called when something may have changed; it must not block."""
        with self._lock:
            self._callbacks.append(callback)

    def wait(self, seconds: float) -> None:
        """Wait until something may have changed, but no longer than so many real seconds."""
        with self._lock:
            self._lock.wait(seconds)

    def tell(self) -> None:
        """Tell everybody; to be called without the lock."""
        with self._lock:
            self._lock.notify_all()
            callbacks = tuple(self._callbacks)
        for callback in callbacks:
            with self._net.under("telling of a change"):
                callback()
