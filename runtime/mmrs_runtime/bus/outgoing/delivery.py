"""A notify on its way, as whoever sends it sees it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from .errands import Errand, Phase


@dataclass(frozen=True, slots=True)
class Delivery:
    """A notify on its way; see `mmrs_core.contributions.buses.Delivery`."""

    _errand: Errand
    _lock: threading.Condition
    _send: Callable[[int], None]
    _withdraw: Callable[[], None]

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until all have answered."""
        with self._lock:
            granted = self._errand.phase in (Phase.GRANTED, Phase.SENDING, Phase.DONE)
            return self._errand.lamport if granted else None

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        with self._lock:
            return self._errand.waiting

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to be done for it."""
        with self._lock:
            return self._errand.is_over

    @property
    def refusals(self) -> Mapping[str, str]:
        """Return why owners will never do it; empty where all is well."""
        with self._lock:
            return dict(self._errand.refusals)

    def send(self, lamport: int) -> None:
        """Have every owner apply it, after it was recorded with that logical time.

        Raises:
            ValueError: that time was not granted.
        """
        self._send(lamport)

    def withdraw(self) -> None:
        """Give it up; what was sent goes on until all have acknowledged."""
        self._withdraw()
