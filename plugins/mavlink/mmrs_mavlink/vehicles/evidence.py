"""Evidence that a vehicle obeys: neither its commands nor what wind or chance may do.

A mode counts when a heartbeat has shown it since. The direction of a vehicle is what its autopilot
reports as its target (POSITION_TARGET_GLOBAL_INT, POSITION_TARGET_LOCAL_NED), requested while an order
waits. Only for vehicles that never report it the motion decides: straight to the position, at a speed at
which nothing drifts.
"""

from __future__ import annotations

import time
from math import cos, hypot, radians

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import distance, offset

from ..links.link import Link
from ..profiles import modes
from ..program import Place
from ..services.commands import ask
from .telemetry import Telemetry

THERE = 1.0
"""Metres from a place within which a vehicle is there, or a target is that place."""

ADVANCE = 0.3
"""Metres by which set-points must have come nearer to a place, where they are streamed."""

BRISK, SLOWEST = 1.0, 0.3
"""Metres a second from which on what flies does not drift; and for what is slow, or not in the air."""

STRAIGHT = cos(radians(15.0))
ASK_SECONDS = 0.2
"""Real seconds between two questions."""

HEARTBEAT, GLOBAL, LOCAL = "HEARTBEAT", "POSITION_TARGET_GLOBAL_INT", "POSITION_TARGET_LOCAL_NED"


class LinkEvidence:
    """Looks at what a vehicle has told since an instant; nothing here waits."""

    def __init__(self, link: Link, telemetry: Telemetry, *, geographic: bool) -> None:
        """Discard all evidence so far."""
        self._link, self._telemetry = link, telemetry
        self._target = GLOBAL if geographic else LOCAL
        self._begun = link.clock.now()
        self._asked: dict[str, float] = {}
        self._first: float | None = None

    def in_mode(self, mode: str) -> bool:
        """Return whether a heartbeat has shown since that it is in a mode, in the runtime's words.

        Where it has no mode in which to surface, it holds instead.
        """
        wanted = mode if mode in self._link.profile.modes else modes.HOLD
        return self._beats() and self._word() == wanted

    def is_off(self) -> bool:
        """Return whether a heartbeat has shown since that it is disarmed."""
        return self._beats() and not self._telemetry.armed()

    def bound_for(self, place: Place, speed: float | None) -> bool:
        """Return whether the vehicle is steered, and goes to a position, or is there.

        Args:
            place: that was commanded.
            speed: commanded speed, metres per second; None: the vehicle's own.
        """
        if self._word() != modes.GUIDED:
            return False
        if self._link.clock.now() - self._link.silent_for() <= self._begun:
            return False
        if distance(self._telemetry.here(), place) <= THERE:
            return True
        self._ask(self._target)
        if self._reported_since(self._target):
            return self._aims_at(place)
        return self._hurries_to(place, speed)

    def _aims_at(self, place: Place) -> bool:
        aim = self._telemetry.aim()
        if aim is None:
            return False
        away = hypot(*offset(aim, place)[:2])
        if self._first is None:
            self._first = away
        steps = self._link.profile.autopilot.streams and away <= self._first - ADVANCE
        return away <= THERE or steps

    def _hurries_to(self, place: Place, speed: float | None) -> bool:
        way, velocity = offset(self._telemetry.here(), place), self._telemetry.velocity()
        pace = hypot(*velocity)
        usual = BRISK if self._link.profile.flies else SLOWEST
        needed = usual if speed is None else max(SLOWEST, min(usual, speed / 2.0))
        along = sum(p * q for p, q in zip(way, velocity, strict=True))
        return pace >= needed and along >= STRAIGHT * pace * hypot(*way)

    def _word(self) -> str:
        return self._link.profile.mode_name(self._telemetry.mode())

    def _beats(self) -> bool:
        """Return whether a heartbeat has come since; if not, ask for one."""
        if self._reported_since(HEARTBEAT):
            return True
        self._ask(HEARTBEAT)
        return False

    def _reported_since(self, kind: str) -> bool:
        return self._link.clock.now() - self._link.since(kind) > self._begun

    def _ask(self, kind: str) -> None:
        """Request a message, at most once in a while, without waiting for the acknowledgement."""
        now = time.monotonic()
        if now - self._asked.get(kind, 0.0) < ASK_SECONDS:
            return
        self._asked[kind] = now
        ask(self._link, mavlink.MAV_CMD_REQUEST_MESSAGE, getattr(mavlink, f"MAVLINK_MSG_ID_{kind}"))
