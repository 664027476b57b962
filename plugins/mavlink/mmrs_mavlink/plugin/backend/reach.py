"""Whether a vehicle is heard, and for how long one that is not is listened to."""

from __future__ import annotations

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.steps.hearing import is_heard, listening
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import Fault


class Reach:
    """Knows how long ago a vehicle was heard."""

    def __init__(self, link: Link, clock: Clock) -> None:
        """Listen to the vehicle at the end of a link."""
        self._link, self._clock = link, clock
        self._lost: Fault | None = None
        self._until = 0.0

    @property
    def is_heard(self) -> bool:
        """Return whether it was heard lately."""
        return is_heard(self._link)

    def may_come_back(self, lost: Fault) -> bool:
        """Return whether it may still be heard again, for some time after a link was lost or last heard."""
        now = self._clock.now()
        if self._lost is not lost or self.is_heard:
            self._lost = lost
            self._until = now + listening(self._clock)
        return now < self._until
