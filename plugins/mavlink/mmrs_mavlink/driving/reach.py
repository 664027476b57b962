"""Whether a vehicle's messages arrive, and how long to wait for one that is silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError

from ..steps.reception import is_received, listening

if TYPE_CHECKING:
    from ..links.link import Link


class Reach:
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
