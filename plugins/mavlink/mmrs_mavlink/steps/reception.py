"""Whether a vehicle is received, and how long to wait for one that is silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError

if TYPE_CHECKING:
    from ..links.link import Link

HEARD_SECONDS, LEAST_HEARD_SECONDS = 3.0, 1.0
"""Largest age of the last message of a reachable vehicle, of the run and real."""

LISTEN_SECONDS, LEAST_LISTEN_SECONDS = 30.0, 2.0
"""How long to wait for a vehicle whose link is lost, of the run and real, when no other robot works."""


class Reception:
    """Measures how long ago a vehicle was last received."""

    def __init__(self, link: Link | None, clock: Clock) -> None:
        """Listen to the vehicle at the end of a link; None: it is reached otherwise."""
        self._link, self._clock = link, clock
        self._lost: FaultError | None = None
        self._until = 0.0

    @property
    def is_received(self) -> bool:
        """Return whether a message arrived lately; one without a link is always reachable."""
        return self._link is None or is_received(self._link)

    @property
    def is_restored(self) -> bool:
        """Return whether a message arrived lately over a link that can be lost."""
        return self._link is not None and is_received(self._link)

    def may_come_back(self, lost: FaultError) -> bool:
        """Return whether the link may still be restored, for some time after it was lost or last received."""
        if self._link is None:
            return False
        now = self._clock.now()
        if self._lost is not lost or self.is_received:
            self._lost = lost
            self._until = now + listening(self._clock)
        return now < self._until


def is_received(link: Link) -> bool:
    """Return whether a vehicle was received lately."""
    return link.listening and link.silent_for() < lately(link.clock)


def lately(clock: Clock) -> float:
    """Return the largest age in seconds of a reachable vehicle's last message."""
    return clock.patience(HEARD_SECONDS, LEAST_HEARD_SECONDS)


def listening(clock: Clock) -> float:
    """Return for how many seconds a vehicle is listened for whose link is lost."""
    return clock.patience(LISTEN_SECONDS, LEAST_LISTEN_SECONDS)
