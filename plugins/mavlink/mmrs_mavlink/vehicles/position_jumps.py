"""Position jumps: whether a vehicle's reported position can be its true one.

An estimator that loses or regains satellites may put the vehicle elsewhere from
one message to the next. One of the two positions is wrong, and it is unknown which.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

from mmrs_runtime.controllers.geodesy import offset

from ..links.link import Message
from ..links.roaming import Sign, sign_in

LEAP_METRES = 10.0
"""What an estimator may correct at once, sideways."""

MORE_SPEED = 3.0
"""Metres per second by which a vehicle may be faster between two messages than either of them tells."""

LATE_SECONDS = 5.0
"""Largest age of a message relative to the one before it; an older one belongs to another start."""


class PositionJumps:
    """Notices when a vehicle tells a place at which it cannot be by now; an observer of its link.

    Attributes:
        count: of jumps, while the motors could run.
        last: the last one, in words; empty before there is any.
    """

    def __init__(self, kind: str, component: Callable[[], int], armed: Callable[[], bool]) -> None:
        """Create without positions.

        Args:
            kind: of message with the position.
            component: gives that of the autopilot.
            armed: whether it may be armed; otherwise people may carry the vehicle.
        """
        self.count = 0
        self.last = ""
        self._kind, self._component, self._armed = kind, component, armed
        self._before: Sign | None = None

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Compare a position with the one reported before it."""
        if outgoing or message.get_type() != self._kind or message.get_srcComponent() != self._component():
            return
        sign, before = sign_in(message, 0.0), self._before
        if sign is None:
            return
        if before is not None:
            seconds = (sign.milliseconds - before.milliseconds) / 1000.0
            if -LATE_SECONDS < seconds <= 0.0:
                return
            if seconds > 0.0 and self._armed():
                self._compare(before, sign, seconds)
        self._before = sign

    def _compare(self, before: Sign, sign: Sign, seconds: float) -> None:
        north, east, _ = offset(before.place, sign.place)
        way = hypot(north, east)
        if way > LEAP_METRES + (max(before.speed, sign.speed) + MORE_SPEED) * seconds:
            self.count += 1
            self.last = f"its position has leapt by {way:.0f} m in {seconds:.2g} s"
