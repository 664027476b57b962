"""The address of a vehicle: a new address must prove that the same vehicle sends from there.

A vehicle with a modem may change its address. Without the proof, a second vehicle with the same
system id, or an intruder, that sends when the robot's vehicle has fallen silent would be commanded in its
stead.
"""

from __future__ import annotations

from math import hypot
from typing import Any, NamedTuple

from mmrs_runtime.controllers.geodesy import distance
from mmrs_runtime.ports import Address

from ..program import Geographic, Local, Place
from .messages import tells_place

Message = Any

ROAMING_SECONDS = 3.0
"""Real seconds of silence after which a vehicle may speak from another address."""

STRAY_METRES, STRAY_SPEED = 10.0, 3.0
"""How far from where it should be by now a vehicle may turn up: metres, and metres per second of silence."""

HEARD_TWICE = 2


class Sign(NamedTuple):
    """Where a vehicle was, how fast, and its milliseconds since its start, at a second of the run."""

    place: Place
    speed: float
    milliseconds: float
    time: float


class Roaming:
    """Keeps the address of one vehicle.

    Attributes:
        sender: from where the vehicle speaks.
        twin: why there must be two vehicles; empty while there is one.
    """

    def __init__(self, late_milliseconds: float) -> None:
        """Take the first address that speaks; clocks may be so much late."""
        self.sender: Address | None = None
        self.twin = ""
        self._late = late_milliseconds
        self._spoke: float | None = None
        self._signs: dict[str, Sign] = {}
        self._strangers: dict[Address, int] = {}

    def accepts(
        self, message: Message, sender: Address | None, real_time: float, now: float, *, heartbeat: bool
    ) -> bool:
        """Return whether a message with the vehicle's ids is its own.

        Args:
            message: from the autopilot.
            sender: from where it came.
            real_time: monotonic seconds.
            now: second of the run.
            heartbeat: whether it is one.
        """
        sign = sign_in(message, now)
        if self._spoke is not None and sender != self.sender:
            silent = real_time - self._spoke >= ROAMING_SECONDS
            if not (silent and self._continues(message.get_type(), sign)):
                if heartbeat and sender is not None:
                    self._strange(sender)
                return False
        self.sender, self._spoke = sender, real_time
        if sign is not None:
            self._signs[message.get_type()] = sign
        return True

    def _continues(self, kind: str, sign: Sign | None) -> bool:
        """Return whether a sign from another address can be of the same vehicle, since the same start."""
        if not self._signs:
            # It has never told where it is: it has not moved yet, and is looked at before it does.
            return True
        before = self._signs.get(kind)
        if sign is None or before is None:
            return False
        passed = max(0.0, sign.time - before.time)
        older = sign.milliseconds - before.milliseconds
        there = STRAY_METRES + (before.speed + STRAY_SPEED) * passed
        return 0.0 < older <= 1000.0 * passed + self._late and distance(before.place, sign.place) <= there

    def _strange(self, sender: Address) -> None:
        self._strangers[sender] = self._strangers.get(sender, 0) + 1
        if self._strangers[sender] >= HEARD_TWICE:
            here = "another port" if self.sender is None else f"{self.sender[0]}:{self.sender[1]}"
            self.twin = f"it speaks from {here} and from {sender[0]}:{sender[1]}"


def sign_in(message: Message, now: float) -> Sign | None:
    """Return the position in a message; None if it holds none."""
    kind = message.get_type()
    if kind == "GLOBAL_POSITION_INT" and tells_place(message):
        place: Place = Geographic(message.lat * 1e-7, message.lon * 1e-7, message.relative_alt * 1e-3)
        return Sign(place, hypot(message.vx, message.vy, message.vz) * 0.01, message.time_boot_ms, now)
    if kind == "LOCAL_POSITION_NED":
        place = Local(message.x, message.y, -message.z)
        return Sign(place, hypot(message.vx, message.vy, message.vz), message.time_boot_ms, now)
    return None
