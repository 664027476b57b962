"""How far robots are with getting ready, with their programs, and with getting back to them."""

from __future__ import annotations

from enum import Enum


class Stage(Enum):
    """How far a robot is; one whose program has ended stays at work, with nothing left to do.

    Attributes:
        PREPARING: it has still to get ready.
        ABSENT: it did not get ready, and nobody knows whether it is the program's robot: it is left alone.
        AWAY: it is ready, and has still to be sent back to where its program was broken off.
        RECOVERING: it is on its way back there.
        WORKING: its program goes on.
        SUSPENDED: its program is broken off, until its battery was changed, or because it could not be
            taken up again.
    """

    PREPARING = "preparing"
    ABSENT = "absent"
    AWAY = "away"
    RECOVERING = "recovering"
    WORKING = "working"
    SUSPENDED = "suspended"
